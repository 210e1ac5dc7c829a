"""The colours of all pictures, by name and by meaning, the sizes of their writing, the letters of the patient's sides.

The bright ones are those of Okabe and Ito 2008, told apart by the colour-blind. A colour has one meaning, and what it
means is told by a word, a line style or a shape as well. An arrow for a force has the colour of what exerts it. Only
where things of one kind are told apart (curves or methods compared, pieces of bone, kinds of slices) do the bright ones
serve in turn, each named beside.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

WHITE, BLACK, ORANGE, SKY, GREEN = "#FFFFFF", "#000000", "#E69F00", "#56B4E9", "#009E73"
YELLOW, BLUE, VERMILLION, PURPLE = "#F0E442", "#0072B2", "#D55E00", "#CC79A7"
GREY, MIDDLE_GREY, PALE = "#595959", "#6B6B6B", "#DADADA"

BONE = "#D8D2C4"
"""Bone in a slice."""
SKULL = "#EDE7D8"
"""Bone of a shaded surface."""
PATCH = SKY
TRUTH, TRUTH_WORD = PURPLE, "#8F3A6D"
"""What is known to be missing, and the darker tone in which words for it are written."""
PROSTHESIS = OUTER = BLUE
INNER = VERMILLION
TANGENT = GREEN
"""The way the bone was going at an end of the gap."""
START = ORANGE
"""What a shape is made from: the curve that a balloon starts from, dashed; guiding points; the control net."""
GUIDE = YELLOW
"""Lines over a CT that lead to a place."""
MEASURE = GREY
"""What is measured or only helps to see: chord, angles, lengths, frames."""
COUNTS = "#ACACAC"
"""Bars of a histogram."""
PRESSURE = BLACK
NO_VALUE = "#C9C9C9"
"""A surface beside one that is coloured by numbers."""

TITLE_PT, LABEL_PT, NOTE_PT = 12.0, 10.5, 9.0
"""Sizes of writing in a drawing 8 inches wide: names of its parts, what is written beside things, numbers at axes."""

_LETTERS = (("R", "L"), ("A", "P"), ("I", "S"))  # negative and positive end of x, y, z in LPS
_WORDS = (("right", "left"), ("front", "back"), ("base", "top"))


def rgb_of(colour: str) -> tuple[int, int, int]:
    """Red, green and blue of a colour.

    Parameters
    ----------
    colour : str
        "#RRGGBB".

    Returns
    -------
    tuple of int
        0 to 255 each.

    Examples
    --------
    >>> rgb_of("#0072B2")
    (0, 114, 178)
    """
    return int(colour[1:3], 16), int(colour[3:5], 16), int(colour[5:7], 16)


def rgb_shares(colour: str) -> NDArray[np.float64]:
    """Red, green and blue of a colour as shares of the most.

    Parameters
    ----------
    colour : str
        "#RRGGBB".

    Returns
    -------
    ndarray, shape (3,)
        0 to 1.

    Examples
    --------
    >>> rgb_shares("#FF0033").tolist()
    [1.0, 0.0, 0.2]
    """
    return np.array(rgb_of(colour)) / 255


def faded(colour: str) -> str:
    """A colour half-way to white, for what lies behind.

    Parameters
    ----------
    colour : str
        "#RRGGBB".

    Returns
    -------
    str

    Examples
    --------
    >>> faded("#0072B2")
    '#7FB8D8'
    """
    return "#{:02X}{:02X}{:02X}".format(*((part + 255) // 2 for part in rgb_of(colour)))


def side_letter(direction: ArrayLike) -> str:
    """Letter of the patient's side that a direction mainly leads to: L, R, A, P, S or I.

    Parameters
    ----------
    direction : array_like, shape (3,)
        World, LPS; any length.

    Returns
    -------
    str

    Examples
    --------
    >>> side_letter((0.9, 0.1, 0.3)), side_letter((0, -1, 0))
    ('L', 'A')
    """
    return _at_end_of(direction, _LETTERS)


def side_word(direction: ArrayLike) -> str:
    """Word for the patient's side that a direction mainly leads to.

    Parameters
    ----------
    direction : array_like, shape (3,)
        As for `side_letter`.

    Returns
    -------
    str
        "right", "left", "front", "back", "base" or "top".

    Examples
    --------
    >>> side_word((0, 0, 2)), side_word((0, 1, 0))
    ('top', 'back')
    """
    return _at_end_of(direction, _WORDS)


def _at_end_of(direction: ArrayLike, names: tuple[tuple[str, str], ...]) -> str:
    """The name at that end of the main axis to which a direction leads."""
    along = np.asarray(direction, float)
    axis = int(np.argmax(np.abs(along)))
    return names[axis][int(along[axis] > 0)]
