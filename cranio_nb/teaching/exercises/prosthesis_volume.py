"""Exercises of lessons 05 and 06: the patch and its surface."""

from __future__ import annotations

import numpy as np
from scipy import ndimage
from skimage.measure import marching_cubes
from skimage.morphology import convex_hull_image

from .task import Exercise, different_pixels, largest_difference, small_head

_CORNERS = np.ones((3, 3), bool)  # pixels that touch at a corner belong together
_SIDES = ndimage.generate_binary_structure(2, 1)


def _curves():
    truths = [t for plane in (13, 17, 21) for t in small_head().slice_truth(plane)]
    return [(t.outer.curve, t.inner.curve) for t in truths if t.outer and t.inner]


def _area(outline):
    row, col = outline.T
    return abs(row @ np.roll(col, -1) - col @ np.roll(row, -1)) / 2


def _outline_error(answer, right):
    """Difference of the enclosed areas in mm2 (px of 1.75 mm)."""
    outline = np.asarray(answer, float)
    if outline.ndim != 2 or outline.shape[1] != 2:
        return float("inf")
    return abs(_area(outline) - _area(right)) * 1.75**2


def _regions():
    bone = small_head().bone
    return [(ndimage.binary_dilation(small_head().implant[p], iterations=2), bone[p]) for p in (13, 17, 21)]


def _dented():
    row, col = np.indices((90, 90)) - 45
    ring = (np.hypot(row, col) < 38) & (np.hypot(row, col) > 28)
    dent = ring & ~((row < -31) & (np.abs(col) < 9))
    speck = dent.copy()
    speck[82, 43:47] = False
    pits = (col >= 33) & (col < 35) & (row >= -6) & (row < 0) | (col >= 35) & (col < 37) & (row >= 0) & (row < 6)
    size = np.bincount(ndimage.label(convex_hull_image(dent) & ~dent)[0].ravel())
    return [(dent, int(np.sort(size[1:])[-2])), (speck, 10), (dent & ~pits, 20)]  # just enough; an island; a corner


def _lost(bone, min_pixels, touching=_CORNERS):
    labels, n = ndimage.label(convex_hull_image(bone) & ~bone, touching)
    sizes = np.bincount(labels.ravel(), minlength=n + 1)
    sizes[0] = 0
    keep = sizes >= min_pixels
    keep[sizes.argmax()] = False
    return keep[labels]


def _with_cavity(bone, min_pixels, touching=_CORNERS):
    labels, n = ndimage.label(convex_hull_image(bone) & ~bone, touching)
    keep = np.bincount(labels.ravel(), minlength=n + 1) >= min_pixels
    keep[0] = False
    return keep[labels]


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


def _voxel_places():
    index = np.array([[0.0, 0.0, 0.0], [10.0, 4.0, 2.0], [3.5, 90.0, 41.5]])
    return [(index, np.array(s)) for s in ((3.0, 1.75, 1.75), (2.5, 0.45, 0.45), (1.0, 2.0, 4.0))]


SOLID = {
    "5.1": Exercise(
        _curves,
        lambda outer, inner: np.concatenate([outer, inner[::-1]]),
        _outline_error,
        "mm2",
        0.01,
        "an array (n, 2) of (row, col)",
        (
            (
                lambda o, i: np.concatenate([o, i]),
                "The outline crosses itself like a bow tie: walk back along the inner curve.",
            ),
            (lambda o, i: o, "This closes the outer curve by its chord; the inner curve is missing."),
            (lambda o, i: i, "This closes the inner curve by its chord; the outer curve is missing."),
        ),
        (
            "Walk along the outer curve, then back along the inner one.",
            "inner[::-1] is the inner curve from its end.",
            "np.concatenate([outer, inner[::-1]])",
        ),
        "an outline that goes round once.",
    ),
    "5.2": Exercise(
        _regions,
        lambda region, bone: region & ~bone,
        different_pixels,
        "pixels",
        0.0,
        "a mask like the ones given",
        (
            (lambda r, b: r, "Bone is still in it: a prosthesis cannot be where the bone is."),
            (
                lambda r, b: r ^ b,
                "This also holds the whole rest of the skull: it is either, not the one without the other.",
            ),
            (lambda r, b: r & b, "This is just the part that must go."),
            (lambda r, b: r | b, "This is the repaired slice; the patch is what is new in it."),
        ),
        ("What is in the region and not in the bone?", "~bone is everything that is not bone.", "region & ~bone"),
        "nothing is designed where bone is.",
    ),
    "5.3": Exercise(
        _dented,
        _lost,
        different_pixels,
        "pixels",
        0.0,
        "a mask like the one given",
        (
            (_with_cavity, "The brain's place is in it: drop the biggest region too."),
            (lambda b, m: _with_cavity(b, m, _SIDES), "The brain's place is in it: drop the biggest region too."),
            (lambda b, m: _lost(b, 1), "Small islands are left: drop regions under min_pixels."),
            (
                lambda b, m: _lost(b, m, _SIDES),
                "Pixels that touch at a corner belong together: ndimage.label(..., np.ones((3, 3))).",
            ),
            (lambda b, m: _lost(b, m + 1), "A region of just min_pixels stays: >=, not >."),
            (
                lambda b, m: _lost(b, m + 1, _SIDES),
                "A region of just min_pixels stays (>=), and pixels that touch at a corner belong together.",
            ),
            (
                lambda b, m: convex_hull_image(b) & ~b,
                "This is the whole difference: the biggest region and the islands must go.",
            ),
            (
                lambda b, m: ndimage.binary_fill_holes(b) & ~b,
                "Filling holes finds the cavity, not the dent: use the convex hull.",
            ),
        ),
        (
            "convex_hull_image(bone) & ~bone, then label with np.ones((3, 3)).",
            "Count each label; 0 is background.",
            "keep = sizes >= min_pixels; keep[sizes.argmax()] = False; keep[labels]",
        ),
        "only the dent is left (the paper's Fig. 6d).",
    ),
    "6.1": Exercise(
        _meshes,
        lambda v, f: _parts_of_volume(v, f).sum() / 6,
        lambda a, b: largest_difference(a, b) / abs(float(b)),
        "of the volume",
        1e-6,
        "one number",
        (
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
        ),
        (
            "Each face and the origin make a tetrahedron.",
            "Its volume is a . (b x c) / 6, with its sign.",
            "np.einsum('ij,ij->', a, np.cross(b, c)) / 6",
        ),
        "the volume without counting a voxel.",
    ),
    "6.2": Exercise(
        _voxel_places,
        lambda index, spacing: index * spacing,
        largest_difference,
        "mm",
        1e-9,
        "an array like the one given",
        (
            (lambda i, s: i, "These are still voxels: 23 of them are not 23 mm."),
            (lambda i, s: i * s[::-1], "The spacing goes with (plane, row, col); do not turn it round."),
            (lambda i, s: i[:, ::-1] * s, "The columns of the index are turned round: keep (plane, row, col)."),
            (lambda i, s: (i * s)[:, ::-1], "These are mm, but with their columns turned round: keep the axes given."),
            (lambda i, s: (i + 0.5) * s, "Half a voxel off: index 0 is the centre of a voxel, and its place is 0 mm."),
            (lambda i, s: (i - 0.5) * s, "Half a voxel off: index 0 is the centre of a voxel, and its place is 0 mm."),
            (lambda i, s: i / s, "Divided where it should multiply: mm = voxels x mm per voxel."),
            (lambda i, s: i * s.mean(), "One mean spacing squashes the head: each axis has its own."),
        ),
        ("How many mm is one step along each axis?", "numpy multiplies row by row.", "index * spacing"),
        "the head has its true proportions.",
    ),
}
"""Lessons 05 and 06."""
