"""The map on which the thin plate is bent: which place of the head lies where on it.

Frames: map (v, u), drawn in degrees from its middle with u to the right and v up, as seen from outside; the head in the
world (mm, LPS).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage
from skimage.measure import find_contours

from ...drawing.described import Described
from ...drawing.figures import Axes, Figure
from ...drawing.palette import BLACK, MEASURE, NOTE_PT, PATCH, WHITE, faded
from ...methods.thin_plate import bend
from ...vault.ray_grid import Array, RadiusMap, RayGrid, filled_from_nearest
from ...volume import Volume
from . import marks
from .head import draw_head

_HEIGHT_IN = 4.1
_HALF = 0.5  # of the drawing, for the head
_RINGS_DEG = (15, 30, 45)
_SPOKES = 12
_PLACES = ((30.0, 60.0), (45.0, 150.0), (30.0, 240.0), (45.0, 330.0))  # marked: degrees from the middle, and around it
_MAP_SHARE = 0.405  # of the drawing's width
_TURNED = np.array([0.0, -0.45, -0.15])  # how far the viewer stands off the middle direction, LPS
_TOWARDS_VIEWER = 0.12  # cosine from which a place of the head is on the side that is seen


def plate_map(bone: Volume, radius_map: RadiusMap) -> Described:
    """Draw the rings and spokes of a map on the skull, and on the map itself.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    radius_map : RadiusMap
        Of the opening.

    Returns
    -------
    Described
    """
    # across the hole the plate itself
    plate = bend(radius_map.outer, radius_map.hole, radius_map.step_mm)
    radius = ndimage.gaussian_filter(np.where(radius_map.hole, plate, filled_from_nearest(radius_map.outer)), 3.0)
    figure = marks.sheet(_HEIGHT_IN)
    _draw_head(figure, bone, radius_map, radius)
    _draw_map(figure, radius_map)
    alt = (
        "Left: a skull with a hole, and rings and spokes drawn on it around the hole. Right: the map of its radii, on "
        "which the same rings are circles and the same spokes straight; four numbers mark the same places."
    )
    numbers = ", ".join(f"{polar:.0f}" for polar, _ in _PLACES)
    return marks.finished(
        figure, alt, f"rings {_RINGS_DEG[0]} degrees apart; places 1 to 4 lie {numbers} degrees from the middle"
    )


def on_surface(grid: RayGrid, radius: Array, polar_deg: ArrayLike, around_deg: ArrayLike) -> NDArray[np.float64]:
    """Places of the head by their angles on the map.

    Parameters
    ----------
    grid : RayGrid
    radius : ndarray, shape (n, n)
        Of the surface, known everywhere, mm.
    polar_deg, around_deg : array_like, shape (m,)
        Angle from the middle ray, and around it from u towards v, degrees.

    Returns
    -------
    ndarray, shape (m, 3)
        World mm.
    """
    polar, around = np.radians(np.broadcast_arrays(polar_deg, around_deg))
    towards = (
        np.column_stack([np.sin(polar) * np.cos(around), np.sin(polar) * np.sin(around), np.cos(polar)]) @ grid.axes
    )
    length = ndimage.map_coordinates(radius, grid.locate(towards), order=1, mode="nearest")
    return grid.centre + length[:, None] * towards


def _lines() -> list[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Rings, then spokes, each as angles from the middle and around it, degrees."""
    turn = np.arange(0.0, 361.0, 2.0)
    out = np.arange(0.0, _RINGS_DEG[-1] + 1.0, 1.0)
    rings = [(np.full(turn.shape, float(ring)), turn) for ring in _RINGS_DEG]
    return rings + [(out, np.full(out.shape, spoke)) for spoke in np.linspace(0, 360, _SPOKES, endpoint=False)]


def rim_angles(radius_map: RadiusMap) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The outline of the hole of a map.

    Parameters
    ----------
    radius_map : RadiusMap

    Returns
    -------
    polar_deg, around_deg : ndarray, shape (m,)
        As `on_surface` takes them.
    """
    soft = ndimage.gaussian_filter(radius_map.hole.astype(float), 2.0)
    outline = max(find_contours(soft, 0.5), key=len)
    v, u = (outline - (radius_map.grid.n - 1) / 2).T * np.degrees(radius_map.grid.step_rad)
    return np.hypot(u, v), np.degrees(np.arctan2(v, u))


def _draw_head(figure: Figure, bone: Volume, radius_map: RadiusMap, radius: Array) -> None:
    """The skull with the lines of the map on it."""
    grid = radius_map.grid
    head = draw_head(figure, (0, 0, _HALF, 1), bone, grid.axes[2] + _TURNED)

    def placed(polar: ArrayLike, around: ArrayLike) -> NDArray[np.float64]:
        """Where places are drawn; nan for those on the far side."""
        points = on_surface(grid, radius, polar, around)
        away = points - grid.centre
        hidden = away @ head.picture.frame.axes[2] < _TOWARDS_VIEWER * np.linalg.norm(away, axis=1)
        return np.where(hidden[:, None], np.nan, head.place(points))

    head.ax.fill(*placed(*rim_angles(radius_map)).T, fc=faded(PATCH), ec=BLACK, lw=1.6)
    for line in _lines():
        marks.polyline(head.ax, placed(*line), MEASURE, lw=1.1)
    _number_places(head.ax, placed(*np.transpose(_PLACES)))


def _draw_map(figure: Figure, radius_map: RadiusMap) -> None:
    """The map of the outer radius, with the same lines."""
    grid = radius_map.grid
    half = (grid.n / 2) * np.degrees(grid.step_rad)
    high = _MAP_SHARE * marks.WIDTH_IN / _HEIGHT_IN
    ax = figure.add_axes((_HALF + 0.015, 0.06, _MAP_SHARE, high))
    beside = np.where(radius_map.hole, np.nan, radius_map.outer)
    shown = ax.imshow(beside, cmap="cividis", origin="lower", extent=(-half, half, -half, half))
    polar, around = rim_angles(radius_map)
    ax.fill(*on_map(polar, around).T, fc=faded(PATCH), ec=BLACK, lw=1.6)
    for line in _lines():
        marks.polyline(ax, on_map(*line), WHITE, lw=1.0)
    _number_places(ax, on_map(*np.transpose(_PLACES)))
    for ring in _RINGS_DEG:
        marks.word(ax, (0, -ring), f"{ring}\N{DEGREE SIGN}", size=NOTE_PT)
    ax.set(xlim=(-half, half), ylim=(-half, half), xticks=(), yticks=())
    bar = figure.colorbar(shown, cax=figure.add_axes((_HALF + _MAP_SHARE + 0.03, 0.06, 0.014, high)))
    bar.ax.tick_params(labelsize=NOTE_PT, pad=2)
    bar.ax.set_title("outer radius\n(mm)", fontsize=NOTE_PT, pad=4)
    marks.sides(ax, np.stack([grid.axes[0], -grid.axes[1]]))


def on_map(polar_deg: ArrayLike, around_deg: ArrayLike) -> NDArray[np.float64]:
    """Where places lie on the drawn map: their angle from the middle is kept.

    Parameters
    ----------
    polar_deg, around_deg : array_like, shape (m,)
        As `on_surface` takes them.

    Returns
    -------
    ndarray, shape (m, 2)
        Degrees to the right and up.

    Examples
    --------
    >>> on_map([30.0], [90.0]).round(9).tolist()
    [[0.0, 30.0]]
    """
    polar, around = np.broadcast_arrays(np.asarray(polar_deg, float), np.radians(around_deg))
    return np.column_stack([polar * np.cos(around), polar * np.sin(around)])


def _number_places(ax: Axes, at: NDArray[np.float64]) -> None:
    """Write 1, 2, ... at places."""
    ax.plot(*at.T, ls="none", marker="o", ms=15, mfc=WHITE, mec=BLACK, mew=1.4)
    for number, (x, y) in enumerate(at, 1):
        if np.isfinite(x):
            ax.text(x, y, str(number), fontsize=NOTE_PT, weight="bold", ha="center", va="center_baseline")
