"""A picture never comes without words."""

import io

import numpy as np
import pytest
from PIL import Image

from cranio_nb.drawing import figures
from cranio_nb.drawing.described import bundle, described, encoded_jpeg, encoded_png
from cranio_nb.errors import InputRefused

RGB = np.random.default_rng(0).integers(0, 255, (40, 60, 3), np.uint8)


def pixels(data):
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


def test_png_keeps_every_pixel_and_jpeg_nearly():
    np.testing.assert_array_equal(pixels(encoded_png(RGB)), RGB)
    smooth = np.broadcast_to(np.linspace(0, 255, 60).astype(np.uint8)[None, :, None], (40, 60, 3)).copy()
    assert np.abs(pixels(encoded_jpeg(smooth)).astype(int) - smooth).max() < 6


@pytest.mark.parametrize("kind", ["pixels", "png", "figure"])
def test_any_picture_displays_itself_with_its_words(kind):
    picture = {"pixels": RGB, "png": encoded_png(RGB), "figure": figures.new_figure(60 / 110, 40 / 110)[0]}[kind]
    shown = described(picture, "A box of many colours.", "box")
    data, metadata = shown._repr_mimebundle_()
    assert pixels(data["image/png"]).shape == (40, 60, 3)
    assert metadata == {"image/png": {"alt": "A box of many colours.", "width": 60, "height": 40}}
    assert data["text/plain"] == repr(shown) == "box"


@pytest.mark.parametrize(("alt", "line"), [(" ", "line"), ("alt", ""), ("", "")])
def test_a_picture_without_words_is_refused(alt, line):
    with pytest.raises(InputRefused) as refusal:
        described(RGB, alt, line)
    assert refusal.value.code == "NoAlt"


def test_a_bundle_holds_the_picture_as_it_is():
    picture = encoded_png(RGB)
    assert bundle(picture, "alt", "line")[0] == {"image/png": picture, "text/plain": "line"}
