"""Colours are told apart, and sides are the patient's."""

import itertools

import numpy as np
import pytest

from cranio_nb.drawing import palette

OKABE_ITO = ("BLACK", "ORANGE", "SKY", "GREEN", "YELLOW", "BLUE", "VERMILLION", "PURPLE")


def test_every_colour_is_six_digits():
    named = [getattr(palette, name) for name in dir(palette) if name.isupper() and not name.startswith("_")]
    colours = [value for value in named if isinstance(value, str)]  # sizes of writing are numbers
    assert len(colours) > 15
    for colour in colours:
        assert colour == "#{:02X}{:02X}{:02X}".format(*palette.rgb_of(colour))


def test_the_bright_ones_are_those_of_okabe_and_ito():
    values = [(0, 0, 0), (230, 159, 0), (86, 180, 233), (0, 158, 115)]
    values += [(240, 228, 66), (0, 114, 178), (213, 94, 0), (204, 121, 167)]
    assert [palette.rgb_of(getattr(palette, name)) for name in OKABE_ITO] == values


def lightness(colour):
    """CIE L* of a colour."""
    linear = np.where((c := palette.rgb_shares(colour)) <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4) @ (
        0.2126,
        0.7152,
        0.0722,
    )
    return 116 * np.cbrt(linear) - 16


@pytest.mark.parametrize("name", ["GREY", "MIDDLE_GREY", "OUTER", "INNER", "TRUTH_WORD", "TANGENT", "MEASURE"])
def test_letters_and_curves_are_seen_on_white(name):
    shown = lightness(getattr(palette, name))
    luminance = ((shown + 16) / 116) ** 3
    assert 1.05 / (luminance + 0.05) > 3  # the contrast that WCAG 2 asks of pictures


def test_shares_are_the_same_colour():
    for colour in (palette.BLUE, palette.BONE, palette.WHITE):
        np.testing.assert_allclose(255 * palette.rgb_shares(colour), palette.rgb_of(colour))


def test_sides_of_all_directions():
    ends = np.concatenate([np.eye(3), -np.eye(3)])
    assert [palette.side_letter(end) for end in ends] == list("LPSRAI")
    assert [palette.side_word(end) for end in ends] == ["left", "back", "top", "right", "front", "base"]
    for x, y in itertools.product((-0.5, 0.5), repeat=2):
        assert palette.side_letter((x, y, 3)) == "S"
