"""The stored drawings of README and docs are those that the code of today draws from what it computes today."""

import importlib.util
import io
import json
import re
from pathlib import Path

import nbformat
import numpy as np
import pytest
from PIL import Image

from cranio_nb.drawing.palette import OUTER, rgb_of
from cranio_nb.teaching import diagrams
from cranio_nb.teaching.diagrams.film import inflate_from_chord

ROOT = Path(__file__).parents[1]
IMG = ROOT / "docs" / "img"
AGAIN = "run `python docs/make_pictures.py` with the names of these files"


@pytest.fixture(scope="module")
def drawn_by():
    """Digest of the code that draws."""
    spec = importlib.util.spec_from_file_location("make_pictures", ROOT / "docs" / "make_pictures.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.drawn_by()


def stored(name):
    """A stored drawing."""
    return Image.open(io.BytesIO((IMG / name).read_bytes()))


def facts(name):
    """What a stored drawing says of itself."""
    info = stored(name).info
    return json.loads(info["comment"] if name.endswith(".gif") else info["Description"])


def stored_picture(lesson, start):
    """Line and pixels of the first picture of a stored lesson whose line begins so."""
    notebook = nbformat.read(ROOT / "notebooks" / f"{lesson}.ipynb", 4)
    data = [output.data for cell in notebook.cells for output in cell.get("outputs", ()) if "data" in output]
    shown = next(d for d in data if "image/png" in d and d["text/plain"].startswith(start))
    return shown["text/plain"], shown["image/png"]


@pytest.mark.parametrize("name", ["pipeline.png", "legend.png", "balloon.gif"])
def test_a_drawing_is_as_its_code_draws_it(name, drawn_by):
    assert facts(name)["drawn_by"] == drawn_by, AGAIN


def test_the_pipeline_shows_what_lesson_00_computes():
    assert facts("pipeline.png")["line"] == stored_picture("00_tour", "gap ")[0], AGAIN


def test_the_legend_is_pixel_for_pixel_what_is_drawn_today():
    pictures = Image.open(io.BytesIO(diagrams.legend().png)), stored("legend.png")
    wanted, kept = (np.asarray(picture.convert("RGB"), float) for picture in pictures)
    assert wanted.shape == kept.shape and np.abs(wanted - kept).mean() < 2.0, AGAIN  # another font draws otherwise


class TestFilm:
    film = stored("balloon.gif")

    def test_it_is_small_loops_and_holds_all_its_steps(self):
        told = facts("balloon.gif")
        assert (IMG / "balloon.gif").stat().st_size <= 600_000 and self.film.info["loop"] == 0
        assert self.film.n_frames == len(told["steps"])

    def test_its_gap_is_that_of_lesson_04(self):
        told = facts("balloon.gif")
        length, theta0, theta1 = map(float, re.findall(r"\d+\.\d", stored_picture("04_deformable_model", "L ")[0]))
        assert (told["length_px"], *np.degrees(told["theta_rad"])) == pytest.approx((length, theta0, theta1), abs=0.06)

    def test_its_curve_lies_where_the_balloon_is_at_each_step(self):
        told = facts("balloon.gif")
        length = told["length_px"]
        made = inflate_from_chord(length, told["theta_rad"])
        assert made.shown == told["steps"], AGAIN
        for frame in (0, len(made.shown) // 2, len(made.shown) - 1):
            self.film.seek(frame)
            pixels = np.asarray(self.film.convert("RGB"), float)
            curve = made.curves[made.shown[frame]]
            middles = ((curve[1:] + curve[:-1]) / 2)[4:-5]  # between snaxels, away from the arrows
            scale = pixels.shape[1] / (1.4 * length)
            cols, rows = (
                (middles[:, 0] + 0.2 * length) * scale,
                pixels.shape[0] - (middles[:, 1] + 0.22 * length) * scale,
            )
            near = [pixels[int(r) - 2 : int(r) + 3, int(c)] for r, c in zip(rows, cols, strict=True)]
            off = [np.abs(column - rgb_of(OUTER)).max(axis=1).min() for column in near]
            assert max(off) < 40, frame
