"""Stage 5, surface reconstruction: a patch of voxels comes in -> a closed triangle mesh goes out.

Frame: `Volume` in voxel (plane, row, col), meshes in world mm (LPS). Source: VISAPP 2011, section 2; marching cubes.

Marching cubes turns voxels into stairs. The true surface may pass anywhere between the last voxel inside and the first
one outside, so every vertex may move by half a voxel without contradicting the data. Within that freedom the surface
is made as smooth as it can be: first it is placed between the voxels by signed distances, which joins slices that lie
far apart, then it is relaxed towards least bending.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import islice

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse
from scipy.spatial import cKDTree
from skimage.measure import marching_cubes

from ..errors import InputRefused
from ..geometry.self_intersection import crossings
from ..mesh import Mesh
from ..volume import Volume

_HALF_VOXEL = 0.5
_GRADIENT_STEP = 0.4  # below 1 / (largest eigenvalue of the bending energy), which is about 2.25 for marching cubes
_VOLUME_STEPS = 2
_UNTANGLE_STEPS = 8
_SLIVER = 1e-3  # area of a face, in voxels, below which it counts as collapsed


@dataclass(frozen=True)
class Deviation:
    """How far the vertices of a surface moved.

    Parameters
    ----------
    mean_mm, max_mm : float
        Mean and largest distance, mm.
    """

    mean_mm: float
    max_mm: float


@dataclass(frozen=True, eq=False)
class Stairs:
    """The surface of a patch as marching cubes gives it, and what smoothing begins with, whatever its steps.

    Parameters
    ----------
    part : Volume
        The patch in its own box.
    inside : ndarray of bool, shape (P, R, C)
        The same with a border of one voxel.
    raw : ndarray, shape (V, 3)
        Vertices midway between voxels, index coordinates of `inside`.
    faces : ndarray of int, shape (F, 3)
    """

    part: Volume
    inside: NDArray[np.bool_]
    raw: NDArray[np.float64]
    faces: NDArray[np.intp]

    @property
    def mesh(self) -> Mesh:
        """The stairs themselves.

        Returns
        -------
        Mesh
            World mm.
        """
        return self.mesh_at(self.raw)

    def mesh_at(self, vertices: NDArray[np.float64]) -> Mesh:
        """The same faces with their vertices elsewhere.

        Parameters
        ----------
        vertices : ndarray, shape (V, 3)
            Index coordinates of `inside`.

        Returns
        -------
        Mesh
            World mm, of positive volume.
        """
        mesh = Mesh(self.part.to_world(vertices - 1), self.faces)
        return mesh if mesh.volume > 0 else Mesh(mesh.vertices, self.faces[:, ::-1].copy())

    @cached_property
    def start(self) -> NDArray[np.float64]:
        """Each vertex on its edge between two voxels where the signed distance, linear along the edge, is zero.

        Returns
        -------
        ndarray, shape (V, 3)
            Index coordinates of `inside`.
        """
        field = _distance_field(self.inside, self.part)
        low, high = np.floor(self.raw).astype(int), np.ceil(self.raw).astype(int)
        here, there = field[tuple(low.T)], field[tuple(high.T)]
        return low + (high - low) * (here / (here - there))[:, None]

    @cached_property
    def thin(self) -> NDArray[np.bool_]:
        """Whether each vertex is where the surface could pass through itself.

        Returns
        -------
        ndarray of bool, shape (V,)
        """
        return _thin(self.inside)[tuple(np.rint(self.raw).astype(int).T)]


def extract_surface(patch: Volume, *, smooth: bool = True, n_steps: int = 24) -> Mesh:
    """Extract the closed surface of a patch.

    Parameters
    ----------
    patch : Volume
        Bool mask (P, R, C). Any affine; a patch that touches the border of its grid is closed there.
    smooth : bool
        False gives plain marching cubes with its stairs: vertices midway between the voxels.
        True moves every vertex by at most half a voxel along each axis, keeping the faces and the volume.
    n_steps : int
        Steps of the relaxation.

    Returns
    -------
    Mesh
        Watertight, edge- and vertex-manifold, wound so that its volume is positive.

    Raises
    ------
    InputRefused
        If the patch is empty (EmptyPatch).

    Notes
    -----
    Marching cubes after Lorensen and Cline 1987: with the level between 0 and 1 it gives a closed manifold for any
    binary volume, where Lewiner's variant does not. The bounded smoothing is in the spirit of Gibson's constrained
    elastic surface nets (1998, doi 10.1007/BFb0056277).

    Examples
    --------
    One voxel gives an octahedron with corners half a voxel from its centre: volume 1 / 6.

    >>> one = Volume(np.ones((1, 1, 1), bool), np.eye(4))
    >>> mesh = extract_surface(one, smooth=False)
    >>> len(mesh.faces), round(float(mesh.volume), 6)
    (8, 0.166667)
    """
    stairs = find_stairs(patch)
    return smoothed(stairs, next(islice(relaxations(stairs), n_steps, None))) if smooth else stairs.mesh


def find_stairs(patch: Volume) -> Stairs:
    """March cubes over a patch.

    Parameters
    ----------
    patch : Volume
        Bool mask.

    Returns
    -------
    Stairs

    Raises
    ------
    InputRefused
        If the patch is empty (EmptyPatch).
    """
    # the patch in its own box, with a border so that the surface closes
    box = patch.box()
    if not patch.voxels[box].size:
        raise InputRefused("EmptyPatch", "The patch has no voxels; a surface needs at least one.")
    part = patch.crop(box)
    inside = np.pad(part.voxels.astype(bool), 1)
    vertices, faces, _, _ = marching_cubes(np.where(inside, np.float32(1), np.float32(-1)), 0.0, method="lorensen")
    return Stairs(part, inside, vertices.astype(float), faces.astype(np.intp))


def relaxations(stairs: Stairs) -> Iterator[NDArray[np.float64]]:
    """Places of the vertices before the first step of the relaxation and after each, without end.

    Parameters
    ----------
    stairs : Stairs

    Yields
    ------
    ndarray, shape (V, 3)
        Index coordinates of the padded patch.
    """
    raw, x = stairs.raw, stairs.start
    # the bending energy |x - mean of neighbours|^2, by projected gradient with Nesterov's momentum
    # (Beck and Teboulle 2009, doi 10.1137/080716542)
    bend = _umbrella(len(raw), stairs.faces)
    back = bend.T.tocsr()
    ahead = x
    t = 1.0  # Nesterov's sequence: the weight of the momentum is (t - 1) / t_new
    while True:
        yield x
        # a step down the gradient, back into the boxes of half a voxel
        new = np.clip(ahead - _GRADIENT_STEP * (back @ (bend @ ahead)), raw - _HALF_VOXEL, raw + _HALF_VOXEL)
        # and ahead by the momentum
        t_new = (1 + np.sqrt(1 + 4 * t * t)) / 2
        ahead = new + (t - 1) / t_new * (new - x)
        x, t = new, t_new


def smoothed(stairs: Stairs, relaxed: NDArray[np.float64]) -> Mesh:
    """The solid of a relaxation: of the same volume as the stairs, and without crossings.

    Parameters
    ----------
    stairs : Stairs
    relaxed : ndarray, shape (V, 3)
        From `relaxations`.

    Returns
    -------
    Mesh
        World mm.
    """
    # where the patch is thin the relaxed surface may cross itself: there vertices go back to where nothing crosses
    x, start, faces = _keep_volume(relaxed, stairs.raw, stairs.faces, stairs.part), stairs.start, stairs.faces
    watched = faces[stairs.thin[faces].any(axis=1)]
    for _ in range(_UNTANGLE_STEPS):
        # bad faces and all faces that share a vertex with them
        part = Mesh(x, watched)
        bad = np.union1d(crossings(part), np.flatnonzero(part.areas < _SLIVER))
        if not len(bad):
            return stairs.mesh_at(x)
        tangled = np.zeros(len(x), bool)
        tangled[watched[bad]] = True
        tangled[watched[tangled[watched].any(axis=1)]] = True  # and their neighbours
        x[tangled] = start[tangled]
    return stairs.mesh_at(start)


def measure_deviation(raw: Mesh, smooth: Mesh) -> Deviation:
    """Measure how far smoothing moved the vertices of a surface.

    Parameters
    ----------
    raw, smooth : Mesh
        Surfaces of one patch from `extract_surface` without and with smoothing: vertex belongs to vertex.

    Returns
    -------
    Deviation
        Mean and largest distance between them, mm.

    Examples
    --------
    >>> raw = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    >>> moved = Mesh(raw.vertices + np.array([[0, 0, 0], [0, 0, 0], [0, 3, 4]]), raw.faces)
    >>> measure_deviation(raw, moved)
    Deviation(mean_mm=1.66..., max_mm=5.0)
    """
    moved = np.linalg.norm(smooth.vertices - raw.vertices, axis=1)
    return Deviation(float(moved.mean()), float(moved.max()))


def _distance_field(inside: NDArray[np.bool_], grid: Volume) -> NDArray[np.float64]:
    """Signed distance in mm to the nearest voxel of the other kind, at the voxels next to the surface; else +-1."""
    # only voxels next to the surface decide where it passes
    inner = inside & ~ndimage.binary_erosion(inside)
    outer = ~inside & ndimage.binary_dilation(inside)
    place_in, place_out = grid.to_world(np.argwhere(inner)), grid.to_world(np.argwhere(outer))
    field = np.where(inside, 1.0, -1.0)
    field[inner] = cKDTree(place_out).query(place_in, workers=2)[0]
    field[outer] = -cKDTree(place_in).query(place_out, workers=2)[0]
    return field


def _umbrella(n_vertices: int, faces: NDArray[np.intp]) -> sparse.csr_array:
    """Umbrella operator: each vertex minus the mean of its neighbours, shape (V, V)."""
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])  # each edge both ways: closed mesh
    links = sparse.csr_array((np.ones(len(ends)), (ends[:, 0], ends[:, 1])), shape=(n_vertices, n_vertices))
    return (sparse.eye_array(n_vertices) - sparse.diags_array(1 / links.sum(axis=1)) @ links).tocsr()


def _keep_volume(x: NDArray, raw: NDArray, faces: NDArray[np.intp], grid: Volume) -> NDArray[np.float64]:
    """Move the surface evenly along its normals until it holds the raw volume again, within half a voxel of `raw`."""
    wanted = Mesh(grid.to_world(raw), faces).volume
    for _ in range(_VOLUME_STEPS):
        mesh = Mesh(grid.to_world(x), faces)
        # the volume grows by the lift times the area along the normals
        area = _vertex_areas(mesh)
        normal = area / np.linalg.norm(area, axis=1, keepdims=True).clip(1e-12)
        lift = (wanted - mesh.volume) / max(np.einsum("vd,vd->", area, normal), 1e-12)
        x = np.clip(grid.to_voxel(mesh.vertices + lift * normal), raw - _HALF_VOXEL, raw + _HALF_VOXEL)
    return x


def _vertex_areas(mesh: Mesh) -> NDArray[np.float64]:
    """A third of the area vectors of the faces around each vertex, shape (V, 3)."""
    corners, shares = mesh.faces.ravel(), np.repeat(mesh.area_vectors / 3, 3, axis=0)
    return np.stack([np.bincount(corners, share, len(mesh.vertices)) for share in shares.T], axis=1)


def _thin(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Neighbourhood of the places where the patch or the space around it is less than two voxels wide.

    Only there can the surface pass through itself within the boxes of half a voxel.
    """
    # what a cube of 2 voxels does not fit into, in the patch and in the space around it
    wide = np.pad(inside, 2)
    fits, fits_outside = (_with_cubes(_corners_of_cubes(mask)) for mask in (wide, ~wide))
    near = (wide ^ fits | ~wide ^ fits_outside)[2:-2, 2:-2, 2:-2]
    for _ in range(4):  # two voxels further to all sides
        near = _with_cubes(near)
    return near[2:-2, 2:-2, 2:-2]


def _corners_of_cubes(mask: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Where cubes of 2 voxels that fit into a mask have their first corner, one shorter along each axis."""
    for axis in range(mask.ndim):
        along = np.moveaxis(mask, axis, 0)
        mask = np.moveaxis(along[:-1] & along[1:], 0, axis)
    return mask


def _with_cubes(corners: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The voxels of cubes of 2 voxels with these first corners, one longer along each axis."""
    for axis in range(corners.ndim):
        along = np.moveaxis(np.pad(corners, [(0, int(k == axis)) for k in range(corners.ndim)]), axis, 0)
        along[1:] |= along[:-1].copy()
        corners = np.moveaxis(along, 0, axis)
    return corners
