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
from skimage.measure import marching_cubes

from ..geometry.slice_distance import plane_distances
from ..grid import move_affine
from ..mesh import Mesh
from ..volume import Volume

_COARSE = 1.3  # mm: voxels of the skull drawn as surroundings
_MARGIN = 1.0  # mm left free around what is drawn
_OUTLINE = 2.5  # mm: a jump in depth from which an outline is drawn


@dataclass(frozen=True, eq=False)
class Picture:
    """A rendered view.

    Parameters
    ----------
    rgb : ndarray, shape (H, W, 3)
        0 to 1; white where there is nothing.
    depth : ndarray, shape (H, W)
        mm towards the viewer; -inf where there is nothing.
    px : float
        Size of a pixel in mm.
    """

    rgb: NDArray[np.float32]
    depth: NDArray[np.float32]
    px: float


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
    """
    d = np.asarray(towards, float)
    d = d / np.linalg.norm(d)
    up = np.array([0.0, 0.0, 1.0]) if abs(d[2]) < 0.95 else np.array([0.0, -1.0, 0.0])
    right = np.cross(up, d)
    right /= np.linalg.norm(right)
    return np.array([right, np.cross(right, d), d])


def skull_surface(bone: Volume, floor: float = -np.inf) -> Mesh:
    """Coarse, smooth surface of the bone above a height, for surroundings in pictures (never for measures).

    Parameters
    ----------
    bone : Volume
        Bool mask.
    floor : float
        World z in mm below which bone is left out: the face does not belong in a picture of the vault.

    Returns
    -------
    Mesh
        Empty where there is no bone.
    """
    part = _above(bone, floor)
    if not part.voxels.any():
        return Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
    field = _field(part)
    padded = np.pad(field.voxels, 1, constant_values=-1)
    vertices, faces, _, _ = marching_cubes(padded, 0.0, method="lorensen")
    mesh = Mesh(field.to_world(vertices - 1), faces.astype(np.intp))
    return mesh if mesh.volume > 0 else Mesh(mesh.vertices, mesh.faces[:, ::-1].copy())


def _above(bone: Volume, floor: float) -> Volume:
    """The box of the bone, cut off at a height; planes of the package's volumes rise to the top of the head."""
    box = ndimage.find_objects(bone.voxels.view(np.uint8))
    if not box:
        return bone
    planes, rows, cols = box[0]
    middle = [(s.start + s.stop) / 2 for s in (rows, cols)]
    heights = bone.to_world([[k, *middle] for k in range(planes.start, planes.stop)])[:, 2]
    low = planes.start + int(np.count_nonzero(heights < floor))
    return bone.crop((slice(low, planes.stop), rows, cols))


def _field(part: Volume) -> Volume:
    """Smooth field on voxels of about 1.3 mm, positive in bone: slice outlines are joined by signed distances."""
    block = np.maximum(1, np.rint(_COARSE / part.spacing)).astype(int)
    padded = np.pad(part.voxels, [(0, int(-n % b)) for n, b in zip(part.shape, block, strict=True)])
    p, r, c = (n // b for n, b in zip(padded.shape, block, strict=True))
    share = padded.reshape(p, block[0], r, block[1], c, block[2]).mean(axis=(1, 3, 5), dtype=np.float32)
    coarse = Volume(share, move_affine(part.affine, (block - 1) / 2, block))
    split = max(1, round(float(coarse.spacing[0]) / _COARSE))
    field = share - np.float32(0.4)
    if split > 1:
        distances = plane_distances(share > 0.4, 8.0).astype(np.float32)
        field = ndimage.zoom(distances, (((p - 1) * split + 1) / p, 1, 1), order=1)
    sigma = (0.7, 0.7, 0.7) if split == 1 else (0.8 * split, 1.3, 1.3)
    return Volume(ndimage.gaussian_filter(field, sigma), move_affine(coarse.affine, (0, 0, 0), (1 / split, 1, 1)))


def render(solids: Sequence[Solid], towards: ArrayLike, *, px: float = 0.5, shaded: bool = True) -> Picture:
    """Draw solids with a depth buffer and light from the upper left.

    Parameters
    ----------
    solids : sequence of Solid
    towards : array_like, shape (3,)
        From the head to the viewer, LPS.
    px : float
        Size of a pixel, mm.
    shaded : bool
        False keeps the colours as they are, where they stand for numbers.

    Returns
    -------
    Picture
    """
    axes = view_axes(towards)
    vertices = np.concatenate([s.mesh.vertices for s in solids]) @ axes.T
    starts = np.cumsum([0, *[len(s.mesh.vertices) for s in solids]])
    faces = np.concatenate([s.mesh.faces + at for s, at in zip(solids, starts[:-1], strict=True)])
    colours = np.concatenate([np.broadcast_to(s.colours, s.mesh.vertices.shape) for s in solids])
    low = vertices[:, :2].min(axis=0) - _MARGIN
    width, height = np.ceil((vertices[:, :2].max(axis=0) + _MARGIN - low) / px).astype(int)
    at = np.column_stack([(vertices[:, :2] - low) / px, vertices[:, 2]])
    face, weight, depth = _scan(at, faces, int(height), int(width))
    hit = face >= 0
    corners, share = faces[face[hit]], weight[hit][..., None]
    colour = (share * colours[corners]).sum(axis=1)
    if shaded:
        normals = np.concatenate([s.mesh.vertex_normals for s in solids]) @ axes.T
        colour = _lit(colour, (share * normals[corners]).sum(axis=1))
    rgb = np.ones((height, width, 3), np.float32)
    rgb[hit] = colour
    return Picture(_outlined(rgb, depth) if shaded else rgb, depth, px)


def _scan(
    at: NDArray, faces: NDArray[np.intp], height: int, width: int
) -> tuple[NDArray[np.int32], NDArray[np.float32], NDArray[np.float32]]:
    """Face seen in each pixel (-1 for none), weights of its three corners there, and depth.

    Each face that looks at the viewer is sampled at least once per pixel; the nearest sample of a pixel wins.
    """
    corners = at[faces].astype(np.float32)
    edge1, edge2 = corners[:, 1, :2] - corners[:, 0, :2], corners[:, 2, :2] - corners[:, 0, :2]
    front = edge1[:, 0] * edge2[:, 1] - edge1[:, 1] * edge2[:, 0] < 0  # rows run down
    longest = np.sqrt(np.maximum(np.maximum((edge1**2).sum(1), (edge2**2).sum(1)), ((edge1 - edge2) ** 2).sum(1)))
    n_steps = np.where(front, np.clip(np.ceil(1.2 * longest), 1, 400).astype(int), 0)
    face = np.full(height * width, -1, np.int32)
    weight = np.zeros((height * width, 3), np.float32)
    depth = np.full(height * width, -np.inf, np.float32)
    for n in np.unique(n_steps[front]):
        some = np.flatnonzero(n_steps == n)
        share = _shares(int(n))
        sample = np.einsum("kc,fcd->fkd", share, corners[some]).reshape(-1, 3)
        index = sample[:, 1].astype(np.int32) * width + sample[:, 0].astype(np.int32)
        np.maximum.at(depth, index, sample[:, 2])
        won = np.flatnonzero(sample[:, 2] == depth[index])
        face[index[won]] = some[won // len(share)]
        weight[index[won]] = share[won % len(share)]
    shape = (height, width)
    return face.reshape(shape), weight.reshape(*shape, 3), depth.reshape(shape)


def _shares(n: int) -> NDArray[np.float32]:
    """Weights of the three corners at evenly spread places of a triangle, shape (K, 3)."""
    i, j = np.mgrid[0 : n + 1, 0 : n + 1]
    keep = i + j <= n
    shares = np.stack([i[keep], j[keep], n - i[keep] - j[keep]], axis=1) / n
    return shares.astype(np.float32)


def _lit(colour: NDArray, normal: NDArray) -> NDArray:
    """Lambert shading in the frame of the view (right, down, towards the viewer): a key light and a head light."""
    key = np.array([-0.45, -0.6, 0.66])
    unit = normal / np.linalg.norm(normal, axis=1, keepdims=True).clip(1e-12)
    light = 0.28 + 0.5 * np.clip(unit @ key, 0, 1) + 0.3 * np.clip(unit[:, 2], 0, 1)
    return np.clip(colour * light[:, None], 0.0, 1.0)


def _outlined(rgb: NDArray[np.float32], depth: NDArray[np.float32]) -> NDArray[np.float32]:
    """Darken pixels that lie behind a nearer one: rims and silhouettes."""
    seen = np.where(np.isfinite(depth), depth, np.float32(-1e4))
    behind = np.clip((ndimage.maximum_filter(seen, 3) - seen - _OUTLINE) / 4, 0, 1)
    behind[~np.isfinite(depth)] = np.clip(behind[~np.isfinite(depth)], 0, 0.75)
    return (rgb * (1 - 0.6 * behind[..., None])).astype(np.float32)
