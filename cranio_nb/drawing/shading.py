"""Triangle meshes -> a shaded picture, seen from far away: a small software renderer on arrays.

Frames: meshes in world mm (LPS); pictures in (row, col) pixels of equal size. Orthographic, so a length in mm is the
same everywhere in a picture and a scale bar holds for all of it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from ..mesh import Mesh

_MARGIN_MM = 1.0  # left free around what is drawn
_OUTLINE_MM = 2.5  # a jump in depth from which an outline is drawn
_MOST_STEPS = 400  # samples along the longest edge of a face


@dataclass(frozen=True, eq=False)
class Frame:
    """What a picture shows: its axes and the part of the view that lies in it.

    Parameters
    ----------
    axes : ndarray, shape (3, 3)
        Of the view, as `view_axes` gives them.
    corner : ndarray, shape (2,)
        Upper left corner along the axes of the view, mm.
    shape : tuple of int
        Height and width, px.
    px_mm : float
        Size of a pixel.
    """

    axes: NDArray[np.float64]
    corner: NDArray[np.float64]
    shape: tuple[int, int]
    px_mm: float

    def holds(self, mesh: Mesh) -> bool:
        """Whether a mesh is seen whole.

        Parameters
        ----------
        mesh : Mesh
            World mm.

        Returns
        -------
        bool
        """
        at = (mesh.vertices @ self.axes[:2].T - self.corner) / self.px_mm
        return bool((at >= 0).all() and (at < self.shape[::-1]).all())


@dataclass(frozen=True, eq=False)
class Picture:
    """A rendered view.

    Parameters
    ----------
    rgb : ndarray, shape (H, W, 3)
        0 to 1; white where there is nothing.
    depth : ndarray, shape (H, W)
        mm towards the viewer; -inf where there is nothing.
    frame : Frame
        What it shows.
    """

    rgb: NDArray[np.float32]
    depth: NDArray[np.float32]
    frame: Frame

    def pixel_of(self, point: ArrayLike) -> NDArray[np.float64]:
        """Where a place of the world is seen.

        Parameters
        ----------
        point : array_like, shape (3,)
            World mm.

        Returns
        -------
        ndarray, shape (2,)
            Fractional pixels to the right and down.
        """
        frame = self.frame
        return (frame.axes[:2] @ np.asarray(point, float) - frame.corner) / frame.px_mm - 0.5


@dataclass(frozen=True, eq=False)
class Solid:
    """Something to draw: a mesh and the colour of each of its vertices.

    Parameters
    ----------
    mesh : Mesh
        World mm, normals outward.
    colours : ndarray, shape (V, 3) or (3,)
        RGB, 0 to 1.
    """

    mesh: Mesh
    colours: NDArray[np.float64]


def view_axes(towards: ArrayLike) -> NDArray[np.float64]:
    """Axes of a picture seen by a viewer in direction `towards`.

    Parameters
    ----------
    towards : array_like, shape (3,)
        From the head to the viewer, LPS; any length.

    Returns
    -------
    ndarray, shape (3, 3)
        Rows: unit vectors to the right, down and towards the viewer. The head's top is up; seen from right above,
        the face is up.

    Examples
    --------
    >>> (view_axes((0, -1, 0)) + 0.0).tolist()  # from the front: the patient's left is to the right
    [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, -1.0, 0.0]]
    """
    # right-handed with d towards the viewer: right = up x d, down = right x d
    d = np.asarray(towards, float)
    d = d / np.linalg.norm(d)
    right = np.cross(up_in_view(d), d)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(right, d), d])


def up_in_view(towards: NDArray[np.float64]) -> NDArray[np.float64]:
    """The direction that is up in a picture: the top of the head; from right above or below, the face.

    Parameters
    ----------
    towards : ndarray, shape (3,)
        Unit vector from the head to the viewer, LPS.

    Returns
    -------
    ndarray, shape (3,)
        Unit vector, LPS.

    Examples
    --------
    >>> up_in_view(np.array([0.0, 0.0, 1.0])).tolist()
    [0.0, -1.0, 0.0]
    """
    return np.array([0.0, 0.0, 1.0]) if abs(towards[2]) < 0.95 else np.array([0.0, -1.0, 0.0])


def frame_around(
    meshes: Sequence[Mesh], axes: NDArray[np.float64], *, px_mm: float, margin_mm: float = _MARGIN_MM
) -> Frame:
    """The frame in which meshes are seen whole.

    Parameters
    ----------
    meshes : sequence of Mesh
        World mm; one vertex at least.
    axes : ndarray, shape (3, 3)
        Of the view, as `view_axes` gives them.
    px_mm : float
        Size of a pixel.
    margin_mm : float
        Left free around them.

    Returns
    -------
    Frame
    """
    across = np.concatenate([mesh.vertices for mesh in meshes]) @ axes.T
    low, high = across[:, :2].min(axis=0) - margin_mm, across[:, :2].max(axis=0) + margin_mm
    width, height = np.ceil((high - low) / px_mm).astype(int)
    return Frame(axes, low, (int(height), int(width)), px_mm)


def draw_solid(solid: Solid, frame: Frame, *, shaded: bool = True) -> Picture:
    """Draw one solid with a depth buffer and light from the upper left.

    Parameters
    ----------
    solid : Solid
    frame : Frame
        That holds it.
    shaded : bool
        False keeps the colours as they are, where they mean numbers.

    Returns
    -------
    Picture
        Without outlines.
    """
    # in the frame of the view (right, down, towards the viewer), from mm to pixels
    mesh = solid.mesh
    vertices = mesh.vertices @ frame.axes.T
    at = np.column_stack([(vertices[:, :2] - frame.corner) / frame.px_mm, vertices[:, 2]])
    face, weight, depth = _scan(at, mesh.faces, *frame.shape)
    # colours and normals between the corners of the face that is seen
    hit = face >= 0
    corners, share = mesh.faces[face[hit]], weight[hit]
    colours = np.broadcast_to(solid.colours, mesh.vertices.shape)
    colour = np.einsum("nc,ncd->nd", share, colours[corners])
    if shaded:
        normals = mesh.vertex_normals @ frame.axes.T
        colour = _lit(colour, np.einsum("nc,ncd->nd", share, normals[corners]))
    rgb = np.ones((*frame.shape, 3), np.float32)
    rgb[hit] = colour
    return Picture(rgb, depth, frame)


def nearest_of(pictures: Sequence[Picture], *, outlined: bool = True) -> Picture:
    """The nearest of several solids in each pixel.

    Parameters
    ----------
    pictures : sequence of Picture
        One of each solid, all in one frame.
    outlined : bool
        Darken rims and silhouettes.

    Returns
    -------
    Picture
    """
    first, *others = pictures
    rgb, depth = first.rgb, first.depth
    for other in others:
        rgb = np.where((other.depth > depth)[..., None], other.rgb, rgb)
        depth = np.maximum(other.depth, depth)
    return Picture(_outlined(rgb, depth) if outlined else rgb, depth, first.frame)


def render(solids: Sequence[Solid], towards: ArrayLike, *, px_mm: float = 0.5, shaded: bool = True) -> Picture:
    """Draw solids with a depth buffer and light from the upper left.

    Parameters
    ----------
    solids : sequence of Solid
    towards : array_like, shape (3,)
        From the head to the viewer, LPS.
    px_mm : float
        Size of a pixel.
    shaded : bool
        False keeps the colours as they are, where they mean numbers.

    Returns
    -------
    Picture

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [10, 0, 0], [0, 0, 10], [10, 0, 10]]), np.array([[0, 1, 2], [1, 3, 2]]))
    >>> picture = render([Solid(square, np.array([1.0, 0, 0]))], (0, -1, 0), px_mm=1.0, shaded=False)
    >>> picture.rgb.shape, picture.rgb[0, 0].tolist(), picture.rgb[6, 6].tolist()
    ((12, 12, 3), [1.0, 1.0, 1.0], [1.0, 0.0, 0.0])
    """
    frame = frame_around([solid.mesh for solid in solids], view_axes(towards), px_mm=px_mm)
    return nearest_of([draw_solid(solid, frame, shaded=shaded) for solid in solids], outlined=shaded)


def _scan(
    at: NDArray, faces: NDArray[np.intp], height: int, width: int
) -> tuple[NDArray[np.int32], NDArray[np.float32], NDArray[np.float32]]:
    """Face seen in each pixel (-1 for none), weights of its three corners there, and depth.

    Each face that looks at the viewer is sampled at least once per pixel; the nearest sample of a pixel wins.
    """
    # faces turned away are left out; axes and corners lie first, so that all sums run along the faces
    axes = np.ascontiguousarray(at.T, np.float32)
    x, y, _ = places = np.stack([axis[faces.T] for axis in axes])
    seen = np.flatnonzero((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]) < 0)  # rows run down
    corners = places.take(seen, axis=2)
    # steps of less than a pixel along the longest edge
    edges = corners[:2, [1, 2, 2]] - corners[:2, [0, 0, 1]]
    longest = np.sqrt((edges[0] ** 2 + edges[1] ** 2).max(axis=0, initial=0))
    n_steps = np.clip(np.ceil(1.2 * longest), 1, _MOST_STEPS).astype(int)
    # faces with equally many steps are sampled at once
    face = np.full(height * width, -1, np.int32)
    weight = np.zeros((height * width, 3), np.float32)
    depth = np.full(height * width, -np.inf, np.float32)
    for n in np.unique(n_steps):
        some = np.flatnonzero(n_steps == n)
        share = _shares(int(n))
        # sums of products written out: faster than einsum here, and the same on every machine, as those of BLAS are not
        a, b, c = corners.take(some, axis=2).transpose(1, 0, 2)[..., None]
        x, y, z = (share[:, 0] * a + share[:, 1] * b + share[:, 2] * c).reshape(3, -1)
        index = y.astype(np.int32) * width + x.astype(np.int32)
        np.maximum.at(depth, index, z)
        won = np.flatnonzero(z == depth[index])
        face[index[won]] = seen[some[won // len(share)]]
        weight[index[won]] = share[won % len(share)]
    shape = (height, width)
    return face.reshape(shape), weight.reshape(*shape, 3), depth.reshape(shape)


def _shares(n: int) -> NDArray[np.float32]:
    """Weights of the three corners at evenly spread places of a triangle, shape (K, 3)."""
    # barycentric lattice: i + j + k = n
    i, j = np.mgrid[0 : n + 1, 0 : n + 1]
    keep = i + j <= n
    shares = np.stack([i[keep], j[keep], n - i[keep] - j[keep]], axis=1) / n
    return shares.astype(np.float32)


def _lit(colour: NDArray, normal: NDArray) -> NDArray:
    """Lambert shading in the frame of the view (right, down, towards the viewer): a key light and a head light."""
    # light = ambient + key light + head light, each by the cosine of its angle with the normal
    key = np.array([-0.45, -0.6, 0.66])
    unit = normal / np.linalg.norm(normal, axis=1, keepdims=True).clip(1e-12)
    light = 0.28 + 0.5 * np.clip(unit @ key, 0, 1) + 0.3 * np.clip(unit[:, 2], 0, 1)
    return np.clip(colour * light[:, None], 0.0, 1.0)


def _outlined(rgb: NDArray[np.float32], depth: NDArray[np.float32]) -> NDArray[np.float32]:
    """Darken pixels that lie behind a nearer one: rims and silhouettes."""
    # how much nearer the nearest neighbour is; the background counts as far behind
    seen = np.where(np.isfinite(depth), depth, np.float32(-1e4))
    behind = np.clip((ndimage.maximum_filter(seen, 3) - seen - _OUTLINE_MM) / 4, 0, 1)
    behind[~np.isfinite(depth)] = np.clip(behind[~np.isfinite(depth)], 0, 0.75)
    return (rgb * (1 - 0.6 * behind[..., None])).astype(np.float32)
