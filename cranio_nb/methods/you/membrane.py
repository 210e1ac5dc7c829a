"""Closed polylines in space -> the triangle mesh of least area that spans each, and the wall that joins two.

Frame: any; lengths in its unit.

A membrane is a height h over the plane of its loop. Least area means

    minimise sum_T |T| sqrt(1 + |grad h|^2),    h given on the loop,

over the triangles T of the plane, with h linear on each. Every step solves the harmonic problem whose triangles weigh
|T| / sqrt(1 + |grad h|^2) with the last h; the first step, with |T| alone, is the harmonic membrane. Because sqrt is
concave the area falls with every step. A membrane over a plane cannot fold.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.sparse.linalg import spsolve
from scipy.spatial import Delaunay, QhullError, cKDTree
from skimage.measure import points_in_poly

from ...errors import InputRefused
from ...mesh import Mesh

_DIGITS = 6  # of places in the plane, mm: which triangles are Delaunay does not hinge on rounding
_CLEAR = 0.6  # steps between the loop and the first points inside: then the loop's own edges are Delaunay


@dataclass(frozen=True, eq=False)
class Loop:
    """A closed polyline, the last point joined to the first.

    Parameters
    ----------
    points : ndarray, shape (n, 3)
        Positions.
    stations : ndarray, shape (n,)
        Rising: how far along each point is, on a scale that two loops may share.
    turn : float
        How much the stations rise in one round.
    """

    points: NDArray[np.float64]
    stations: NDArray[np.float64]
    turn: float


@dataclass(frozen=True, eq=False)
class Membrane:
    """A surface across a loop.

    Parameters
    ----------
    mesh : Mesh
        Its first vertices are the points of the loop, in their order; normals look along `span_loop`'s normal.
    areas : tuple of float
        Area after the harmonic step and after each further one; never rises.
    converged : bool
        Whether the heights came to rest.
    """

    mesh: Mesh
    areas: tuple[float, ...]
    converged: bool


def resample_loop(loop: Loop, step: float, smooth: float) -> Loop:
    """The same loop with even steps, smoothed.

    Parameters
    ----------
    loop : Loop
    step : float
        Wanted distance between neighbouring points.
    smooth : float
        Standard deviation of the smoothing along the loop, a length; takes out the zigzag of a path on a mesh.

    Returns
    -------
    Loop
    """
    # even steps of arc length around the closed loop
    closed = np.concatenate([loop.points, loop.points[:1]])
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(closed, axis=0), axis=1))])
    n = max(round(float(along[-1]) / step), 8)
    at = np.arange(n) * along[-1] / n
    points = np.stack([np.interp(at, along, coordinate) for coordinate in closed.T], axis=1)
    # smoothed along the loop; sigma in points
    points = ndimage.gaussian_filter1d(points, smooth * n / along[-1], axis=0, mode="wrap")
    # stations at the new points, and the loop turned so that they rise from its first
    stations = np.interp(at, along, np.append(loop.stations, loop.stations[0] + loop.turn)) % loop.turn
    first = -int(np.argmin(stations))
    return Loop(np.roll(points, first, axis=0), np.roll(stations, first), loop.turn)


def span_loop(
    loop: NDArray[np.float64], normal: NDArray[np.float64], step: float, *, tol: float = 1e-3, max_iter: int = 30
) -> Membrane:
    """Membrane of least area across a loop.

    Parameters
    ----------
    loop : ndarray, shape (n, 3)
        Closed polyline, counter-clockwise seen against `normal`, its points about `step` apart.
    normal : ndarray, shape (3,)
        Unit vector; along it the loop must be seen without crossing itself.
    step : float
        Size of the triangles.
    tol : float
        Largest change of a height in a step at which it stops.
    max_iter : int
        Steps after the harmonic one.

    Returns
    -------
    Membrane

    Raises
    ------
    InputRefused
        ``TangledRim`` if the loop crosses itself seen along the normal.
    """
    # the loop in the frame of its plane, and the triangles inside it
    axes = plane_axes(loop, normal)
    flat_loop = (loop - loop.mean(axis=0)) @ axes.T
    flat, faces = _triangles(flat_loop[:, :2], step)
    # iteratively reweighted harmonic problems; the first has weights |T|
    gradients, sizes = _gradients(flat, faces)
    height, areas, converged = np.append(flat_loop[:, 2], np.zeros(len(flat) - len(loop))), [], False
    weight = sizes
    for _ in range(max_iter + 1):
        new = _harmonic(gradients, weight, height, len(loop))
        change, height = np.abs(new - height).max(), new
        # area = sum |T| sqrt(1 + |grad h|^2), and the next weights |T| / sqrt(...)
        stretch = np.sqrt(1 + sum((g @ height) ** 2 for g in gradients))
        areas.append(float(sizes @ stretch))
        weight = sizes / stretch
        if len(areas) > 1 and change <= tol:
            converged = True
            break
    # back to space; the loop keeps its exact points
    vertices = np.column_stack([flat, height]) @ axes + loop.mean(axis=0)
    return Membrane(Mesh(np.concatenate([loop, vertices[len(loop) :]]), faces), tuple(areas), converged)


def plane_axes(loop: NDArray[np.float64], normal: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows: right-handed unit axes of the plane across `normal`, the first towards the loop's first point.

    Parameters
    ----------
    loop : ndarray, shape (n, 3)
    normal : ndarray, shape (3,)
        Unit vector.

    Returns
    -------
    ndarray, shape (3, 3)
        Rows: two axes in the plane, and the normal.
    """
    first = loop[0] - loop.mean(axis=0)
    first = first - (first @ normal) * normal
    first = first / np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first), normal])


def join_loops(outer: Loop, inner: Loop) -> NDArray[np.intp]:
    """Triangles between two loops that share their stations.

    Vertices count through the outer loop's points, then the inner one's. Both loops run counter-clockwise seen from
    the outer side; normals point away from what the loops enclose.

    Parameters
    ----------
    outer, inner : Loop
        Of n and m points.

    Returns
    -------
    ndarray of int, shape (n + m, 3)
        Faces.
    """
    # both loops merged by station: each step along either makes one triangle
    n, m = len(outer.points), len(inner.points)
    is_outer = np.arange(n + m) < n
    order = np.argsort(np.concatenate([outer.stations, inner.stations]), kind="stable")
    # last point passed on each loop at every step
    o, i = ((np.cumsum(one[order]) - 1) for one in (is_outer, ~is_outer))
    # a step on one loop joins its edge to the point waiting on the other
    step_out = np.stack([o, o - 1, n + i % m], axis=1)
    step_in = np.stack([n + (i - 1) % m, n + i % m, o], axis=1)
    faces = np.where(is_outer[order][:, None], step_out, step_in)
    return np.where(faces < 0, faces + n, faces)


def join_membranes(outer: Membrane, inner: Membrane, outer_rim: Loop, inner_rim: Loop) -> Mesh:
    """Closed mesh of two membranes and the wall between their rims.

    Parameters
    ----------
    outer, inner : Membrane
    outer_rim, inner_rim : Loop

    Returns
    -------
    Mesh
    """
    # vertices: the outer membrane's, then the inner one's, whose first m are its rim
    n, rim, m = len(outer_rim.points), len(outer.mesh.vertices), len(inner_rim.points)
    side = join_loops(outer_rim, inner_rim)
    side = np.where(side < n, side, side - n + rim)
    # the inner membrane is turned over: its outside is towards the brain
    faces = np.concatenate([outer.mesh.faces, side, inner.mesh.faces[:, ::-1] + rim])
    assert side.max() < rim + m
    return Mesh(np.concatenate([outer.mesh.vertices, inner.mesh.vertices]), faces)


def _triangles(loop: NDArray, step: float) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """Points in the plane, those of the loop first, and the triangles inside the loop, counter-clockwise."""
    # a lattice of equilateral triangles over the loop's box
    loop = np.round(loop, _DIGITS)
    low, high = loop.min(axis=0), loop.max(axis=0)
    rows = np.arange(low[1], high[1], step * np.sqrt(0.75))
    cols = np.arange(low[0], high[0], step)
    x = cols + np.where(np.arange(len(rows)) % 2, step / 2, 0.0)[:, None]
    lattice = np.stack([x, np.broadcast_to(rows[:, None], x.shape)], axis=-1).reshape(-1, 2)
    # lattice points inside the loop, but none so near that the loop's edges would not be Delaunay
    dense = np.concatenate([loop, (loop + np.roll(loop, -1, axis=0)) / 2])
    inner = lattice[points_in_poly(lattice, loop)]
    flat = np.concatenate([loop, inner[cKDTree(dense).query(inner)[0] > _CLEAR * step]])
    # triangles of a hole in the loop's outline are dropped, the others wound counter-clockwise
    try:
        faces = Delaunay(flat).simplices.astype(np.intp)
    except QhullError:  # all points on one line
        raise _tangled() from None
    faces = faces[points_in_poly(flat[faces].mean(axis=1), loop)]
    turned = _sizes(flat[faces]) < 0
    faces[turned] = faces[turned][:, ::-1]
    if not _bounded_by(faces, len(loop)):
        raise _tangled()
    return flat, faces


def _tangled() -> InputRefused:
    """The refusal of a rim that no surface can span."""
    message = "The rim of the hole crosses itself, pinches the hole or encloses nothing."
    return InputRefused("TangledRim", message, "Give guiding points by hand.")


def _bounded_by(faces: NDArray[np.intp], n: int) -> bool:
    """Whether the open edges of a mesh are those of the loop 0, 1, ... n - 1, and no others."""
    # an edge of one triangle only is open
    edges = np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    kinds, count = np.unique(edges, axis=0, return_counts=True)
    wanted = np.sort(np.stack([np.arange(n), (np.arange(n) + 1) % n], axis=1), axis=1)
    return np.array_equal(kinds[count == 1], wanted[np.lexsort(wanted.T[::-1])])


def _gradients(flat: NDArray, faces: NDArray[np.intp]) -> tuple[list[sparse.csr_array], NDArray[np.float64]]:
    """Derivatives along both axes of the plane on each triangle, shape (F, V) each, and the triangles' sizes."""
    # on a triangle grad h = sum_k h_k (edge opposite to k, turned by 90 deg) / (2 |T|)
    corners = flat[faces]
    opposite = np.roll(corners, -2, axis=1) - np.roll(corners, -1, axis=1)
    sizes = _sizes(corners)
    rows = np.repeat(np.arange(len(faces)), 3)
    parts = (-opposite[..., 1] / (2 * sizes[:, None]), opposite[..., 0] / (2 * sizes[:, None]))
    shape = (len(faces), len(flat))
    return [sparse.csr_array((part.ravel(), (rows, faces.ravel())), shape=shape) for part in parts], sizes


def _sizes(corners: NDArray) -> NDArray[np.float64]:
    """Size of triangles in the plane, shape (F, 3, 2) -> (F,); positive counter-clockwise."""
    (bx, by), (cx, cy) = ((corners[:, k] - corners[:, 0]).T for k in (1, 2))
    return (bx * cy - by * cx) / 2


def _harmonic(gradients: list[sparse.csr_array], weight: NDArray, height: NDArray, n_fixed: int) -> NDArray[np.float64]:
    """Heights of least sum of weight |grad h|^2, the first `n_fixed` kept."""
    # energy = sum_T w_T |grad h|^2, a quadratic form in the heights
    scale = sparse.diags_array(weight)
    energy = sum(g.T @ scale @ g for g in gradients).tocsr()
    # its zero slope in the free heights, with those of the loop given
    inner = slice(n_fixed, None)
    new = height.copy()
    if len(height) > n_fixed:
        new[inner] = spsolve(energy[inner, inner].tocsc(), -energy[inner, :n_fixed] @ height[:n_fixed])
    return new
