"""What the drawings are made of: a plane with one scale, arrows, measures, angles, words.

Frame: (x, y) to the right and up, in the unit of the plane.
"""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from PIL import Image

from ...curves import ChordFrame, Points
from ...drawing import figures
from ...drawing.described import Described, described
from ...drawing.figures import Axes, Figure
from ...drawing.palette import BLACK, BONE, LABEL_PT, MEASURE, NOTE_PT, WHITE, rgb_shares, side_letter

WIDTH_IN = 8.0
"""Width of every drawing, inches."""
_COLOURS = 256  # of a finished drawing
_NEARLY_WHITE = 248
_INSET_PX = 12.0  # of a side's letter from the edge
_PER_PX = 4  # samples of a slice for each of its pixels
_TICK_PT = 4.0  # half the width of the strokes at the ends of a measure


def sheet(height_in: float) -> Figure:
    """An empty drawing.

    Parameters
    ----------
    height_in : float
        Inches.

    Returns
    -------
    Figure

    Examples
    --------
    >>> sheet(2.0).get_size_inches().tolist()
    [8.0, 2.0]
    """
    figure, _ = figures.new_figure(WIDTH_IN, height_in)
    figure.clear()
    return figure


def finished(figure: Figure, alt: str, line: str) -> Described:
    """A drawing as a picture of few colours, which is a small file.

    Parameters
    ----------
    figure : Figure
    alt, line : str
        As for `described`.

    Returns
    -------
    Described
    """
    full = Image.open(io.BytesIO(figures.png(figure))).convert("RGB")
    stream = io.BytesIO()
    few_colours(full, _COLOURS).save(stream, format="PNG", optimize=True)
    return described(stream.getvalue(), alt, line)


def few_colours(full: Image.Image, n: int) -> Image.Image:
    """A picture in its most frequent colours; its ground stays white.

    Parameters
    ----------
    full : Image
        RGB.
    n : int
        How many colours.

    Returns
    -------
    Image
        With a table of colours.

    Examples
    --------
    >>> few_colours(Image.new("RGB", (4, 4), "#FFFFFF"), 8).convert("RGB").getpixel((0, 0))
    (255, 255, 255)
    """
    few = full.quantize(n, dither=Image.Dither.NONE)
    table = np.array(few.getpalette()).reshape(-1, 3)
    table[table.min(axis=1) >= _NEARLY_WHITE] = 255  # these are means of white and of edges that fade into it
    few.putpalette(table.ravel().tolist())
    return few


def plane(figure: Figure, box: tuple[float, float, float, float], low: ArrayLike, width: float) -> Axes:
    """A part of a drawing in which a unit is equally long both ways.

    Parameters
    ----------
    figure : Figure
    box : tuple of float
        Left, bottom, width and height of the part, as shares of the drawing.
    low : array_like, shape (2,)
        (x, y) in its lower left corner.
    width : float
        What its width shows, in units of the plane.

    Returns
    -------
    Axes
        Without frame and ticks.

    Examples
    --------
    >>> ax = plane(sheet(2.0), (0, 0, 1, 1), (0, 0), 80.0)
    >>> [float(limit) for limit in (*ax.get_xlim(), *ax.get_ylim())]
    [0.0, 80.0, 0.0, 20.0]
    """
    ax = figure.add_axes(box)
    ax.set_axis_off()
    wide, high = figure.get_size_inches() * box[2:]
    x, y = np.asarray(low, float).tolist()
    ax.set(xlim=(x, x + width), ylim=(y, y + width * high / wide))
    return ax


def word(ax: Axes, at: ArrayLike, text: str, *, colour: str = BLACK, size: float = LABEL_PT, **style: Any) -> None:
    """Write beside something, on a pale ground so that lines do not run through the letters.

    Parameters
    ----------
    ax : Axes
    at : array_like, shape (2,)
    text : str
    colour : str
    size : float
        One of the sizes of `palette`.
    **style
        As for ``Axes.text``.
    """
    x, y = np.asarray(at, float)
    ground = {"fc": WHITE, "ec": "none", "alpha": 0.85, "pad": 0.8}
    ax.text(x, y, text, {"color": colour, "fontsize": size, "ha": "center", "va": "center", "bbox": ground} | style)


def pointer(ax: Axes, at: ArrayLike, to: ArrayLike, text: str, *, colour: str = BLACK) -> None:
    """A word with a thin line to what it names.

    Parameters
    ----------
    ax : Axes
    at, to : array_like, shape (2,)
        Where the word stands, and what it names.
    text : str
    colour : str
        Of the word.
    """
    line = {"arrowstyle": "-", "color": MEASURE, "lw": 0.8, "shrinkA": 6, "shrinkB": 2}
    ax.annotate("", xy=tuple(np.asarray(to)), xytext=tuple(np.asarray(at)), arrowprops=line)
    word(ax, at, text, colour=colour)


def arrow(ax: Axes, tail: ArrayLike, tip: ArrayLike, colour: str, *, width: float = 1.8, hollow: bool = False) -> None:
    """An arrow from one place to another; none where it would have no length.

    Parameters
    ----------
    ax : Axes
    tail, tip : array_like, shape (2,)
    colour : str
    width : float
        Of its shaft, points.
    hollow : bool
        Whether its head is white inside.
    """
    tail, tip = np.asarray(tail, float), np.asarray(tip, float)
    # a head never longer than the arrow
    long = float(np.hypot(*(ax.transData.transform(tip) - ax.transData.transform(tail)))) * 72 / ax.figure.dpi
    if long < 0.5:
        return
    head = {"arrowstyle": f"-|>,head_length={min(0.5, 0.075 * long):.3f},head_width={min(0.22, 0.045 * long):.3f}"}
    face = {"ec": colour, "fc": WHITE if hollow else colour, "lw": width, "shrinkA": 0, "shrinkB": 0}
    ax.annotate(
        "", xy=tuple(tip), xytext=tuple(tail), arrowprops=head | face | {"mutation_scale": 14}, annotation_clip=False
    )


def measure(ax: Axes, start: ArrayLike, end: ArrayLike, text: str = "", *, at: ArrayLike | None = None) -> None:
    """A length: a line with strokes at its ends, and its value.

    Parameters
    ----------
    ax : Axes
    start, end : array_like, shape (2,)
    text : str
    at : array_like, shape (2,), optional
        Where the value stands; in the middle of the line by default.
    """
    start, end = np.asarray(start, float), np.asarray(end, float)
    style = {"arrowstyle": f"|-|,widthA={_TICK_PT},widthB={_TICK_PT}", "mutation_scale": 1.0}
    line = {"color": MEASURE, "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
    ax.annotate("", xy=tuple(end), xytext=tuple(start), arrowprops=style | line)
    if text:
        word(ax, (start + end) / 2 if at is None else at, text, bbox={"fc": WHITE, "ec": "none", "pad": 2.0})


def arc(centre: ArrayLike, radius: float, first_rad: float, last_rad: float) -> NDArray[np.float64]:
    """Points along an arc.

    Parameters
    ----------
    centre : array_like, shape (2,)
    radius : float
    first_rad, last_rad : float
        Angles of its ends from the x axis towards the y axis, radians.

    Returns
    -------
    ndarray, shape (n, 2)

    Examples
    --------
    >>> arc((1, 0), 2.0, 0.0, np.pi / 2)[[0, -1]].round(9).tolist()
    [[3.0, 0.0], [1.0, 2.0]]
    """
    turn = np.linspace(first_rad, last_rad, 49)
    return np.asarray(centre, float) + radius * np.column_stack([np.cos(turn), np.sin(turn)])


def angle(ax: Axes, centre: ArrayLike, radius: float, to_rad: float, colour: str) -> None:
    """An angle above the x axis, as an arc that ends in an arrow.

    Parameters
    ----------
    ax : Axes
    centre : array_like, shape (2,)
    radius : float
    to_rad : float
        Radians.
    colour : str
    """
    points = arc(centre, radius, 0.0, to_rad)
    ax.plot(*points.T, color=colour, lw=1.4)
    arrow(ax, points[-6], points[-1], colour, width=1.0)


def bone_behind(ax: Axes, bone: NDArray[np.bool_], frame: ChordFrame) -> None:
    """The bone of a slice, turned into a chord frame, over all of a plane.

    Parameters
    ----------
    ax : Axes
        Its unit is the px of the slice: (along, out).
    bone : ndarray of bool, shape (R, C)
    frame : ChordFrame
    """
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    n_cols, n_rows = (round((high - low) * _PER_PX) for low, high in ((left, right), (bottom, top)))
    # middles of the samples, rows from the top
    x = left + (np.arange(n_cols) + 0.5) / n_cols * (right - left)
    y = top - (np.arange(n_rows) + 0.5) / n_rows * (top - bottom)
    at = np.rint(frame.to_slice(np.stack(np.meshgrid(x, y), axis=-1))).astype(np.intp)
    inside = ((at >= 0) & (at < bone.shape)).all(axis=-1)
    rgba = np.zeros((n_rows, n_cols, 4))
    rgba[inside] = np.where(bone[tuple(at[inside].T)][:, None], [*rgb_shares(BONE), 1.0], 0.0)
    ax.imshow(rgba, extent=(left, right, bottom, top), interpolation="nearest", aspect="auto", zorder=0)


def chord_sides(frame: ChordFrame) -> NDArray[np.float64]:
    """Where the axes of a chord frame lead in the patient, for slices whose rows run back and columns left.

    Parameters
    ----------
    frame : ChordFrame

    Returns
    -------
    ndarray, shape (2, 3)
        `along`, and against `out`: to the right and down in a drawing; LPS.
    """
    along, out = frame.axes
    return np.array([[along[1], along[0], 0.0], [-out[1], -out[0], 0.0]])


def sides(ax: Axes, right_down: NDArray[np.float64]) -> None:
    """The letters of the patient's sides at the edges of a plane: right, left, above and below.

    Parameters
    ----------
    ax : Axes
    right_down : ndarray, shape (2, 3)
        World directions (LPS) to the right and down.
    """
    right, down = right_down
    width, height = ax.get_window_extent().size
    across, up = float(_INSET_PX / width), float(_INSET_PX / height)
    places = ((1 - across, 0.5, right), (across, 0.5, -right), (0.5, 1 - up, -down), (0.5, up, down))
    for x, y, direction in places:
        word(ax, (x, y), side_letter(direction), colour=MEASURE, transform=ax.transAxes, weight="bold")


def scale(ax: Axes, length: float, text: str) -> None:
    """A scale bar in the lower left corner of a plane.

    Parameters
    ----------
    ax : Axes
    length : float
        In units of the plane.
    text : str
    """
    (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
    x, y = left + 0.02 * (right - left), bottom + 0.04 * (top - bottom)
    ax.plot([x, x + length], [y, y], color=BLACK, lw=3, solid_capstyle="butt")
    word(ax, (x + length / 2, y + 0.012 * abs(right - left) * np.sign(top - bottom)), text, size=NOTE_PT, va="bottom")


def polyline(ax: Axes, points: Points, colour: str, **style: Any) -> None:
    """A curve through points.

    Parameters
    ----------
    ax : Axes
    points : ndarray, shape (n, 2)
    colour : str
    **style
        As for ``Axes.plot``.
    """
    line: dict[str, Any] = {"color": colour, "lw": 2.2, "solid_capstyle": "round"} | style
    ax.plot(*points.T, **line)
