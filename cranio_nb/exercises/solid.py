"""Exercises of lessons 05 to 07 and 10: the patch, its surface, its distance from the truth, the paper's tables."""

from __future__ import annotations

import numpy as np
from scipy import ndimage
from scipy.spatial import cKDTree
from skimage.measure import marching_cubes
from skimage.morphology import convex_hull_image

from .task import Exercise, different_pixels, largest_difference, small_head


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
    bay = dent & ~((col > 33) & (np.abs(row) < 5))
    return [(dent, 10), (speck, 10), (bay, 10)]


def _lost(bone, min_pixels):
    labels, n = ndimage.label(convex_hull_image(bone) & ~bone)
    sizes = np.bincount(labels.ravel(), minlength=n + 1)
    sizes[0] = 0
    keep = sizes >= min_pixels
    keep[sizes.argmax()] = False
    return keep[labels]


def _with_islands(bone, min_pixels):
    return _lost(bone, 1)


def _with_cavity(bone, min_pixels):
    labels, n = ndimage.label(convex_hull_image(bone) & ~bone)
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
    return meshes


def _parts_of_volume(vertices, faces):
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c))


def _voxel_places():
    index = np.array([[0.0, 0.0, 0.0], [10.0, 4.0, 2.0], [3.5, 90.0, 41.5]])
    return [(index, np.array(s)) for s in ((3.0, 1.75, 1.75), (2.5, 0.45, 0.45), (1.0, 2.0, 4.0))]


def _clouds():
    grid = np.stack(np.meshgrid(np.arange(20.0), np.arange(20.0), [0.0]), axis=-1).reshape(-1, 3)
    bump = grid.copy()
    bump[::25, 2] += 6.0
    part = grid[grid[:, 0] < 12]
    return [(grid, grid + np.array([0.0, 0.0, 1.5])), (bump, grid), (part, grid)]


def _both_ways(a, b):
    return np.concatenate([cKDTree(b).query(a)[0], cKDTree(a).query(b)[0]])


def _planes():
    points = np.array([[50.0, 0.0, 10.0], [-20.0, 33.0, 4.0], [2.0, -70.0, 30.0]])
    lean = np.array([0.96, 0.28, 0.0])
    return [
        (points, np.array([1.0, 0.0, 0.0]), np.zeros(3)),
        (points, np.array([1.0, 0.0, 0.0]), np.array([2.3, 0.0, 0.0])),
        (points, lean, np.array([2.3, -6.1, 40.0])),
    ]


def _mirrored(points, normal, origin):
    return points - 2 * ((points - origin) @ normal)[:, None] * normal


def _records():
    def entry(plane, status, theta0, n_iter):
        return {"plane": plane, "status": status, "theta0": theta0, "n_iter": n_iter}

    slices = [
        entry(20, "hull", [0.0, 0.0], [0, 0]),
        entry(21, "balloon", [8.5, 12.0], [44, 61]),
        entry(22, "balloon", [14.0, 17.5], [90, 75]),
        entry(23, "balloon", [21.0, 28.0], [131, 140]),
    ]
    return [(slices, "theta0", 0), (slices, "theta0", 1), (slices, "n_iter", 0)]


def _range(slices, key, side):
    values = [s[key][side] for s in slices if s["status"] == "balloon"]
    return min(values), max(values)


def _arcs():
    return [(50.0, 75.0), (20.0, 75.0), (90.0, 80.0)]


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
            (_with_islands, "Small islands are left: drop regions under min_pixels."),
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
            "convex_hull_image(bone) & ~bone, then label.",
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
            (lambda v, f: _parts_of_volume(v, f).sum() / 3, "Twice too much: a tetrahedron is a sixth of its box."),
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
            (lambda i, s: i / s, "Divided where it should multiply: mm = voxels x mm per voxel."),
            (lambda i, s: i * s.mean(), "One mean spacing squashes the head: each axis has its own."),
        ),
        ("How many mm is one step along each axis?", "numpy multiplies row by row.", "index * spacing"),
        "the head has its true proportions.",
    ),
    "7.1": Exercise(
        _clouds,
        lambda a, b: np.percentile(_both_ways(a, b), 95),
        largest_difference,
        "mm",
        1e-6,
        "one number",
        (
            (
                lambda a, b: np.percentile(cKDTree(b).query(a)[0], 95),
                "One way only: what is missing in a is not seen. Look from b as well.",
            ),
            (lambda a, b: _both_ways(a, b).max(), "This is the largest distance; HD95 leaves the worst 5 percent out."),
            (lambda a, b: _both_ways(a, b).mean(), "This is the mean distance (ASSD), not the 95th percentile."),
            (
                lambda a, b: np.percentile(np.linalg.norm(a[:, None] - b[None], axis=-1), 95),
                "This takes every pair of points; wanted is the distance to the nearest one.",
            ),
        ),
        (
            "cKDTree(b).query(a)[0] are the distances from a to b.",
            "Take both ways and join them.",
            "np.percentile(np.concatenate([...]), 95)",
        ),
        "missing parts count as much as extra ones.",
    ),
    "7.2": Exercise(
        _planes,
        _mirrored,
        largest_difference,
        "mm",
        1e-6,
        "an array like the points",
        (
            (lambda p, n, o: p - ((p - o) @ n)[:, None] * n, "The points stop on the plane: go twice as far."),
            (
                lambda p, n, o: p - 2 * (p @ n)[:, None] * n,
                "The plane does not pass through 0, 0, 0: measure from the origin given.",
            ),
            (lambda p, n, o: p * [-1, 1, 1], "This mirrors at x = 0; the head stands aside and leans."),
            (lambda p, n, o: 2 * o - p, "This is a point reflection: only the part along the normal may change sign."),
        ),
        (
            "How far is a point from the plane? (points - origin) @ normal.",
            "Go back twice that far along the normal.",
            "points - 2 * distance[:, None] * normal",
        ),
        "the sound side has crossed the plane.",
    ),
    "10.1": Exercise(
        _records,
        _range,
        largest_difference,
        "",
        1e-9,
        "two numbers: smallest and largest",
        (
            (
                lambda s, k, i: (min(x[k][i] for x in s), max(x[k][i] for x in s)),
                "Slices filled by the hull have no balloon: leave them out.",
            ),
            (lambda s, k, i: _range(s, k, 1 - i), "Outer is side 0, inner is side 1."),
            (lambda s, k, i: _range(s, k, i)[::-1], "The smallest comes first."),
            (
                lambda s, k, i: (np.mean([x[k][i] for x in s[1:]]),) * 2,
                "This is the mean; the paper's tables give smallest and largest.",
            ),
        ),
        (
            "Which slices have a balloon? Look at their status.",
            "Take s[key][side] of those.",
            "min(values), max(values)",
        ),
        "a row of Tables 1 and 2.",
    ),
    "10.2": Exercise(
        _arcs,
        lambda chord, radius: np.degrees(np.arcsin(chord / 2 / radius)),
        largest_difference,
        "degrees",
        1e-6,
        "one number",
        (
            (lambda c, r: np.arcsin(c / 2 / r), "This is in radians; the paper's tables are in degrees."),
            (
                lambda c, r: np.degrees(np.arcsin(min(c / r, 1))),
                "Half the chord belongs to the right angle: chord / 2.",
            ),
            (
                lambda c, r: np.degrees(np.arctan(c / 2 / r)),
                "The radius is the long side of the right angle's triangle: a sine, not a tangent.",
            ),
            (
                lambda c, r: np.degrees(2 * np.arcsin(c / 2 / r)),
                "This is the angle at the centre; the tangent leans by half of it.",
            ),
        ),
        (
            "Draw the radius to one end and to the middle of the chord.",
            "sin theta = (chord / 2) / radius.",
            "np.degrees(np.arcsin(chord / 2 / radius))",
        ),
        "angles say how wide a gap was.",
    ),
}
"""Lessons 05 to 07 and 10."""
