"""Surfaces -> shaded views and distance maps (the paper's Figure 9), with the patient's sides and a scale bar."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...mesh import Mesh
from ..palette import NO_VALUE, PROSTHESIS, SKULL, rgb_shares
from ..shading import Picture, Solid, draw_solid, frame_around, nearest_of, view_axes
from .axes import colour_scale, name_sides, ring_place, scale_bar, show_pixels

if TYPE_CHECKING:
    from .axes import Axes, Figure

SIDES = {
    "from the left": (1.0, 0.0, 0.0),
    "from the right": (-1.0, 0.0, 0.0),
    "from the front": (0.0, -1.0, 0.0),
    "from the back": (0.0, 1.0, 0.0),
    "from above": (0.0, 0.0, 1.0),
}
"""Directions from the head to the viewer, LPS."""
_RIM_PX = 14  # left free around a view
_ROOM_MM = 3.0  # around a skull, for a prosthesis that stands out of it
_LIFT_MM = 0.05  # of a coloured side before the same faces of the whole


def views_of(directions: Sequence[ArrayLike]) -> dict[str, NDArray[np.float64]]:
    """Three directions to look from: facing the largest opening, and two sides that show the openings.

    Parameters
    ----------
    directions : sequence of array_like, shape (3,)
        From the head's centre to each opening, LPS, the largest first.

    Returns
    -------
    dict of str to ndarray, shape (3,)
        Name of the view -> direction from the head to the viewer, LPS.

    Examples
    --------
    >>> list(views_of([(0.9, 0.1, 0.4)]))
    ['facing the opening', 'from the left', 'from above']
    """
    # how well an opening is seen: cosine between its direction and the line of sight
    towards = np.array(directions, float)
    views, seen = {"facing the opening": towards[0]}, towards @ towards[0]
    for _ in range(2):
        rest = {name: towards @ side for name, side in SIDES.items() if name not in views}
        # first the side that shows what is not yet seen well, then the one that shows most
        best = max(
            rest, key=lambda name: (np.clip(rest[name] - seen, 0, None).sum(), np.clip(rest[name], 0, None).sum())
        )
        views[best], seen = np.array(SIDES[best]), np.maximum(seen, rest[best])
    return views


@dataclass(frozen=True, eq=False)
class SkullView:
    """A skull as it is seen from one side, drawn once for all prostheses that are shown in it.

    Parameters
    ----------
    skull : Mesh
        World mm; may be empty.
    towards : ndarray, shape (3,)
        From the head to the viewer, LPS.
    px_mm : float
        Size of a pixel.
    picture : Picture or None
        The skull with room for a prosthesis around it; None for an empty skull.
    """

    skull: Mesh
    towards: NDArray[np.float64]
    px_mm: float
    picture: Picture | None


def skull_view(skull: Mesh, towards: ArrayLike, *, px_mm: float = 0.6) -> SkullView:
    """Draw a skull, to show prostheses in it.

    Parameters
    ----------
    skull : Mesh
        World mm; may be empty.
    towards : array_like, shape (3,)
        From the head to the viewer, LPS.
    px_mm : float
        Size of a pixel.

    Returns
    -------
    SkullView
    """
    side = np.asarray(towards, float)
    if not len(skull.faces):
        return SkullView(skull, side, px_mm, None)
    frame = frame_around([skull], view_axes(side), px_mm=px_mm, margin_mm=_ROOM_MM)
    return SkullView(skull, side, px_mm, draw_solid(Solid(skull, rgb_shares(SKULL)), frame))


def view_figure(view: SkullView, prosthesis: Mesh) -> Figure:
    """Skull and prosthesis, shaded.

    Parameters
    ----------
    view : SkullView
    prosthesis : Mesh
        World mm; may be empty where there is a skull.

    Returns
    -------
    Figure

    Examples
    --------
    >>> corners = np.array([[0.0, 0, 0], [50, 0, 0], [0, 0, 50], [50, 0, 50]])
    >>> skull = Mesh(corners, np.array([[0, 1, 2], [1, 3, 2]]))
    >>> figure = view_figure(skull_view(skull, (0, -1, 0)), Mesh(corners / 2 - [0, 1, 0], skull.faces))
    >>> [text.get_text() for text in figure.axes[0].texts]
    ['L', 'R', 'S', 'I', '50 mm']
    """
    plate, seen = Solid(prosthesis, rgb_shares(PROSTHESIS)), view.picture
    if seen is not None and seen.frame.holds(prosthesis):
        picture = nearest_of([seen, draw_solid(plate, seen.frame)])
    else:  # there is no skull, or the prosthesis stands out of it farther than there is room
        solids = [Solid(view.skull, rgb_shares(SKULL)), plate] if len(view.skull.faces) else [plate]
        frame = frame_around([solid.mesh for solid in solids], view_axes(view.towards), px_mm=view.px_mm)
        picture = nearest_of([draw_solid(solid, frame) for solid in solids])
    figure, ax = _with_rim(picture)
    name_sides(ax, view_axes(view.towards))
    scale_bar(ax, 50.0 / view.px_mm, "50 mm")
    return figure


def distance_figure(
    whole: Mesh, surface: Mesh, distances: NDArray, towards: ArrayLike, *, top_mm: float, px_mm: float = 0.2
) -> Figure:
    """One side of a prosthesis, coloured by the distance of its nodes from the true surface; the rest is grey.

    A ring is drawn around the node that is farthest away.

    Parameters
    ----------
    whole, surface : Mesh
        The prosthesis, and its side as an open surface.
    distances : ndarray, shape (V,)
        mm, of the vertices of `surface`.
    towards : array_like, shape (3,)
        From the surface to the viewer, LPS.
    top_mm : float
        Distance at the upper end of the colour scale.
    px_mm : float
        Size of a pixel.

    Returns
    -------
    Figure
    """
    # the side lies on the same faces as the whole: moved a little to the viewer, it is what is seen
    near = np.asarray(towards, float) / np.linalg.norm(towards) * _LIFT_MM
    coloured = Solid(Mesh(surface.vertices + near, surface.faces), colour_scale(top_mm).to_rgba(distances)[:, :3])
    solids = [Solid(whole, rgb_shares(NO_VALUE)), coloured]
    frame = frame_around([solid.mesh for solid in solids], view_axes(towards), px_mm=px_mm)
    picture = nearest_of([draw_solid(solid, frame, shaded=False) for solid in solids], outlined=False)
    figure, ax = _with_rim(picture)
    x, y = picture.pixel_of(surface.vertices[np.argmax(distances)]) + _RIM_PX
    ring_place(ax, x, y)
    name_sides(ax, frame.axes)
    scale_bar(ax, 20.0 / px_mm, "20 mm")
    return figure


def _with_rim(picture: Picture) -> tuple[Figure, Axes]:
    """A rendered picture with a border for letters and scale."""
    return show_pixels(np.pad(picture.rgb, ((_RIM_PX, 2 * _RIM_PX), (_RIM_PX, _RIM_PX), (0, 0)), constant_values=1))
