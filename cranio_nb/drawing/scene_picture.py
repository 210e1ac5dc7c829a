"""Meshes of a scene -> its picture, without OpenGL: names of the parts, a length, a colour scale.

Frame: world mm (LPS); the picture in (x, y) px.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh
from .canvas import Canvas, round_length
from .figures import colour_scale
from .palette import GREY, rgb_shares
from .pixels import RGB
from .shading import Solid, render, view_axes

WIDTH, HEIGHT = 640, 480
"""Size of a picture, px, without the colour scale."""
_BAR_HEIGHT, _BAR_LENGTH = 56, 280  # px, of the colour scale
_LEAST_TOP = 1e-3
_N_TONES = 5  # of the scale beside a name


@dataclass(frozen=True, eq=False)
class Part:
    """A mesh of a scene.

    Parameters
    ----------
    mesh : Mesh
        World mm.
    colour : str
        "#RRGGBB".
    label : str
        Its name; may be empty.
    values : ndarray, shape (V,), or None
        Numbers at its vertices that give its colour instead.
    """

    mesh: Mesh
    colour: str
    label: str
    values: NDArray | None


def top_of_scale(parts: Sequence[Part]) -> float | None:
    """Number at the upper end of a scene's colour scale.

    Parameters
    ----------
    parts : sequence of Part

    Returns
    -------
    float or None
        The 99th percentile of all values; None without values.
    """
    values = [part.values for part in parts if part.values is not None]
    return max(float(np.percentile(np.concatenate(values), 99)), _LEAST_TOP) if values else None


def named_colours(parts: Sequence[Part]) -> list[tuple[tuple[str, ...], str]]:
    """The colours of the named parts of a scene, beside their names.

    Parameters
    ----------
    parts : sequence of Part

    Returns
    -------
    list of (colours, name)
        One colour, or those of the scale from its lower to its upper end where numbers give the colour.

    Examples
    --------
    >>> flat = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    >>> named_colours([Part(flat, "#0072B2", "skull", None), Part(flat, "#0072B2", "distance", np.arange(3.0))])
    [(('#0072B2',), 'skull'), (('#00224E', '#434E6C', '#7D7C78', '#BCAE6C', '#FEE838'), 'distance')]
    """
    scale = np.rint(colour_scale(1.0).to_rgba(np.linspace(0.0, 1.0, _N_TONES)) * 255).astype(int)[:, :3]
    tones = tuple("#{:02X}{:02X}{:02X}".format(*tone) for tone in scale.tolist())
    return [((part.colour,) if part.values is None else tones, part.label) for part in parts if part.label]


def draw_parts(parts: Sequence[Part], towards: NDArray[np.float64], *, unit: str = "mm") -> RGB:
    """Draw the parts of a scene.

    Parameters
    ----------
    parts : sequence of Part
    towards : ndarray, shape (3,)
        From the scene to the viewer, LPS.
    unit : str
        Of the values.

    Returns
    -------
    ndarray of uint8, shape (H, W, 3)

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [9, 0, 0], [0, 0, 9], [9, 0, 9]]), np.array([[0, 1, 2], [1, 3, 2]]))
    >>> draw_parts([Part(square, "#0072B2", "square", None)], np.array([0.0, -1.0, 0.0])).shape
    (529, 640, 3)
    """
    # the surfaces, as large as just fits
    top, px_mm = top_of_scale(parts), _pixel_mm(parts, towards)
    solids = [Solid(part.mesh, _vertex_colours(part, top)) for part in parts]
    seen = (255 * render(solids, towards, px_mm=px_mm).rgb).astype(np.uint8)
    tall, wide = seen.shape[:2]
    width = max(WIDTH, wide + 20)
    canvas = Canvas(width, tall + 40 + (_BAR_HEIGHT if top else 0))
    canvas.place(seen, (width - wide) / 2, 10)
    canvas.sides((0, 0, width, tall + 20), *view_axes(towards)[:2])
    # names, a length, and what the colours mean
    named = named_colours(parts)
    if named:
        canvas.legend(6, 6, [(tones, "area", name) for tones, name in named])
    length = round_length(0.2 * wide * px_mm)
    canvas.scale_bar(14, tall + 28, length / px_mm, f"{length:g} mm")
    if top:
        _draw_colour_bar(canvas, (width / 2 - _BAR_LENGTH / 2, tall + 44), top, unit)
    return canvas.array()


def _pixel_mm(parts: Sequence[Part], towards: NDArray[np.float64]) -> float:
    """Size of a pixel at which the scene just fits its picture."""
    # extent across the line of sight, within the picture less its margins
    flat = np.concatenate([part.mesh.vertices for part in parts]) @ view_axes(towards)[:2].T
    return float((np.ptp(flat, axis=0) / (WIDTH - 40, HEIGHT - 80)).max())


def _draw_colour_bar(canvas: Canvas, at: tuple[float, float], top: float, unit: str) -> None:
    """Draw the colour scale with its ends and its middle; the upper end stands for all that is more."""
    ramp = colour_scale(top).to_rgba(np.linspace(0, top, _BAR_LENGTH), bytes=True)[:, :3]
    canvas.place(np.broadcast_to(ramp, (14, _BAR_LENGTH, 3)).copy(), *at)
    for share, sign, anchor in ((0.0, "", "la"), (0.5, "", "ma"), (1.0, "\N{GREATER-THAN OR EQUAL TO} ", "ra")):
        text = f"{sign}{share * top:.2g} {unit}"
        canvas.text(at[0] + _BAR_LENGTH * share, at[1] + 19, text, size=12, colour=GREY, anchor=anchor)


def _vertex_colours(part: Part, top: float | None) -> NDArray[np.float64]:
    """RGB, 0 to 1, shape (3,) or (V, 3)."""
    if part.values is None or top is None:
        return rgb_shares(part.colour)
    return colour_scale(top).to_rgba(np.asarray(part.values, float))[:, :3]
