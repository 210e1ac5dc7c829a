"""Exercises of lesson 06: the volume of a mesh, its size in mm."""

from __future__ import annotations

import numpy as np
from scipy.spatial import ConvexHull
from skimage.measure import marching_cubes

from .task import Answer, Exercise, largest_difference


def _meshes():
    steps = np.indices((18, 18, 18)) - 8.5
    ball = np.linalg.norm(steps, axis=0) < 6
    meshes = []
    for spacing, shift in (((1.0, 1.0, 1.0), 0.0), ((3.0, 1.75, 1.75), 40.0), ((2.5, 0.45, 0.45), -200.0)):
        vertices, faces, _, _ = marching_cubes(ball.astype(np.float32), 0.5, spacing=spacing, method="lorensen")
        volume = np.einsum("ij,ij->", vertices[faces[:, 0]], np.cross(vertices[faces[:, 1]], vertices[faces[:, 2]]))
        meshes.append((vertices.astype(float) + shift, faces if volume > 0 else faces[:, ::-1].copy()))
    (*_, (vertices, faces)) = meshes
    return [*meshes[:2], (vertices, faces[:, ::-1].copy())]  # the last one inside out: a negative volume


def _parts_of_volume(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c))


def _normals(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.cross(b - a, c - a)


def _voxel_places():
    index = np.array([[0.5, 1.0, 2.0], [10.0, 4.0, 3.0], [3.5, 90.0, 41.5]])
    return [(index, np.array(s)) for s in ((3.0, 1.75, 1.75), (2.5, 0.45, 0.45), (1.0, 2.0, 4.0))]


EXERCISES: dict[str, Exercise] = {
    "6.1": Exercise(
        cases=_meshes,
        right=lambda v, f: _parts_of_volume(v, f).sum() / 6,
        answer=Answer(
            "one number",
            unit="of the volume",
            tolerance=1e-6,
            error=lambda a, b: largest_difference(a, b) / abs(float(b)),
            shows=(np.asarray, "mm3"),
        ),
        mistakes=(
            (lambda v, f: _parts_of_volume(v, f).sum(), "Six times too big: a tetrahedron is a sixth of its box."),
            (lambda v, f: _parts_of_volume(v, f).sum() / 3, "Twice too much: a tetrahedron is a sixth of its box."),
            (
                lambda v, f: abs(_parts_of_volume(v, f).sum()) / 6,
                "No abs: a mesh turned inside out has a negative volume, and that is how one finds out.",
            ),
            (
                lambda v, f: np.abs(_parts_of_volume(v, f)).sum() / 6,
                "Keep the signs: faces seen from behind take away.",
            ),
            (
                lambda v, f: -_parts_of_volume(v, f).sum() / 6,
                "The sign is wrong: a and (b x c), in the order of the face.",
            ),
            (lambda v, f: np.prod(np.ptp(v, axis=0)), "This is the box around the mesh."),
            (lambda v, f: _parts_of_volume(v, f) / 6, "These are the single tetrahedra: add them up."),
            (lambda v, f: np.linalg.norm(_normals(v, f), axis=1).sum() / 2, "This is the area of the surface."),
            (
                lambda v, f: _parts_of_volume(v, f).sum() / 2,
                "Three times too much: a tetrahedron is a sixth of its box.",
            ),
            (
                lambda v, f: np.prod(v[f], axis=1).sum() / 6,
                "This multiplies number by number: the volume is a . (b x c), with np.cross.",
            ),
            (lambda v, f: ConvexHull(v).volume, "The volume of the hull: it has no sign, and a head is not convex."),
            (
                lambda v, f: (v[f[:, 0]] @ np.cross(v[f[:, 1]], v[f[:, 2]]).T).sum() / 6,
                "`@` takes every face with every other: multiply row by row, (a * ...).sum().",
            ),
            (
                lambda v, f: (v[f[0]] * np.cross(v[f[1]], v[f[2]])).sum() / 6,
                "faces[0] is the first face; the first corners of all faces are faces[:, 0].",
            ),
        ),
        hints=(
            "Each face and the origin make a tetrahedron.",
            "Its volume is a . (b x c) / 6, with its sign.",
            "np.cross takes all faces at once; multiply by a, add up everything, divide once.",
        ),
        praise="the volume without counting a voxel.",
    ),
    "6.2": Exercise(
        cases=_voxel_places,
        right=lambda index, spacing: index * spacing,
        answer=Answer("an array like the one given", unit="mm", tolerance=1e-9),
        mistakes=(
            (lambda i, s: i, "These are still voxels: 23 of them are not 23 mm."),
            (lambda i, s: i * s[::-1], "The spacing goes with (plane, row, col); do not turn it round."),
            (lambda i, s: i[:, ::-1] * s, "The columns of the index are turned round: keep (plane, row, col)."),
            (lambda i, s: (i * s)[:, ::-1], "These are mm, but with their columns turned round: keep the axes given."),
            (lambda i, s: (i + 0.5) * s, "Half a voxel off: index 0 is the centre of a voxel, and its place is 0 mm."),
            (lambda i, s: (i - 0.5) * s, "Half a voxel off: index 0 is the centre of a voxel, and its place is 0 mm."),
            (lambda i, s: i / s, "Divided where it should multiply: mm = voxels x mm per voxel."),
            (lambda i, s: i * s.mean(), "One mean spacing squashes the head: each axis has its own."),
            (lambda i, s: i + s, "A spacing is mm per voxel: multiply, do not add."),
            (
                lambda i, s: i * s[:, None],
                "The spacings go along the rows of the array here; one belongs to each column.",
            ),
            (lambda i, s: i * s[0], "The first spacing is used for all axes: each axis has its own."),
            (lambda i, s: (i - i.min(axis=0)) * s, "These count from the first position: index 0 lies at 0 mm."),
            (lambda i, s: (i + 1) * s, "A voxel off: index 0 lies at 0 mm."),
            (lambda i, s: (i - 1) * s, "A voxel off: index 0 lies at 0 mm."),
            (
                lambda i, s: np.round(i) * s,
                "Rounded: vertices lie between voxels, and that is what makes a surface smooth.",
            ),
            (lambda i, s: (i * s).sum(axis=1), "The three axes are added up: a position has three numbers."),
            (
                lambda i, s: np.linalg.norm(i * s, axis=1),
                "These are distances from 0, 0, 0: a position has three numbers.",
            ),
            (lambda i, s: i * np.prod(s), "np.prod is the volume of a voxel: each axis has its own spacing."),
            *(
                (lambda i, s, one=one: i * one(s), "One spacing for all axes: each has its own.")
                for one in (np.max, np.min, np.median, lambda s: s[1], lambda s: s[2], lambda s: np.cbrt(np.prod(s)))
            ),
            *(
                (
                    lambda i, s, order=order: i * s[order],
                    "Spacings are exchanged: they go with (plane, row, col), as they come.",
                )
                for order in ([0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1])
            ),
            (lambda i, s: i * np.linalg.norm(s), "This is the diagonal of a voxel: each axis has its own spacing."),
            (lambda i, s: i * s**2, "The spacing comes in once: mm = voxels x mm per voxel."),
            (lambda i, s: i + 0.5 * s, "A spacing is mm per voxel: multiply, do not add."),
        ),
        hints=(
            "How many mm is one step along each axis?",
            "Three numbers in a row, three spacings: which belong together?",
            "numpy multiplies an array (n, 3) by one of (3,) row by row.",
        ),
        praise="the head has its true proportions.",
    ),
}
"""The exercises of lesson 06, by number."""
