"""The outermost bone along rays, and whether a hole's missing bone lies inside the image."""

from dataclasses import replace

import numpy as np
import pytest

from cranio_nb.vault.opening_search import survey_openings
from cranio_nb.vault.orientation import head_axes
from cranio_nb.vault.outermost_bone import measure_outermost_bone, measured_again, open_rays, room_in_image, vertex_rays
from cranio_nb.volume import Volume
from data_synth import phantom_case

SIDES = {"left": (2, -1), "right": (2, 0), "front": (1, 0), "back": (1, -1), "top": (0, -1)}
"""The image's end at each side of the head: axis, and first or last."""


def measured(bone, axes):
    return measure_outermost_bone(bone, vertex_rays(bone, axes))


def test_the_outermost_bone_is_the_outer_skull(phantom, skull):
    case, found = phantom("unilateral"), measured(skull("unilateral"), head_axes(skull("unilateral")))
    np.testing.assert_allclose(np.linalg.norm(found.grid.directions, axis=-1), 1, atol=1e-12)
    known = np.isfinite(found.radius) & found.within(60)
    p = found.grid.points(found.radius)[known] - case.head.centre
    away = np.linalg.norm(p, axis=1)
    off = away - case.head.outer_radius(p / away[:, None])
    assert abs(np.median(off)) < 1.5 and np.percentile(np.abs(off), 95) < 3.0  # a voxel


def cropped(bone, missing, side, share):
    """The bone in an image that ends where this share of the missing bone is left outside, and no less."""
    axis, end = SIDES[side]
    held = missing.sum(axis=tuple({0, 1, 2} - {axis}))
    held = held if end == 0 else held[::-1]
    n_off = int(np.searchsorted(np.cumsum(held), share * held.sum())) + 1
    box = [slice(None)] * 3
    box[axis] = slice(n_off, None) if end == 0 else slice(None, -n_off)
    assert 1 - missing[tuple(box)].sum() / missing.sum() >= share
    return bone.crop(tuple(box))


@pytest.fixture(scope="module")
def towards():
    """A phantom with its hole at each side of the head; a hole at the right is one at the left, mirrored."""
    cases = {"front": phantom_case("class", "frontal", 2), "back": phantom_case("class", "occipital", 3)}
    cases |= {"top": phantom_case("class", "vertex", 1), "right": phantom_case("class", "unilateral", 1)}
    right = cases["right"]
    mirrored = {name: getattr(right, name)[:, :, ::-1].copy() for name in ("bone", "implant", "hu")}
    return cases | {"left": replace(right, **mirrored)}


@pytest.mark.parametrize("share", [0.02, 0.05, 0.17, 0.5])
@pytest.mark.parametrize("side", SIDES)
def test_missing_bone_outside_the_image_is_noticed(side, share, towards):
    case = towards[side]
    found = survey_openings(cropped(Volume(case.bone, case.affine), case.implant, side, share))
    assert found and not found[0].whole


@pytest.mark.parametrize("side", SIDES)
def test_missing_bone_that_the_image_holds_with_a_scalps_width_is_whole(side, towards):
    case = towards[side]
    axis, end = SIDES[side]
    spacing = Volume(case.bone, case.affine).spacing[axis]
    hit = np.flatnonzero((case.bone | case.implant).any(axis=tuple({0, 1, 2} - {axis})))
    n_air = int(np.ceil(5.0 / spacing))
    box = [slice(None)] * 3
    box[axis] = slice(hit[0] - n_air, None) if end == 0 else slice(None, hit[-1] + 1 + n_air)
    (one,) = survey_openings(Volume(case.bone, case.affine).crop(tuple(box)))
    assert one.whole and one.verdict.kind == "cut"


def test_a_ball_with_a_hole_lies_in_its_image_until_the_missing_cap_leaves_it():
    """On a ball the surface across the hole is known: the image must hold the radius, and not much more."""
    at = np.stack(np.meshgrid(*[np.arange(-90, 91.0)] * 3, indexing="ij"), axis=-1)
    away = np.linalg.norm(at, axis=-1)
    cap = at[..., 2] > np.cos(np.radians(20)) * away
    ball = Volume(
        (away < 76) & (away > 70) & ~cap, np.array([[0, 0, 1, 0], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1.0]])
    )
    room_mm = []
    for n_cols in (166, 168, 172, 176):  # the ball ends with column 90 + 76
        part = ball.crop((slice(None), slice(None), slice(n_cols)))
        outermost = measured(part, np.eye(3))
        (rays,) = (r for r in open_rays(outermost, 8.0) if outermost.grid.directions[r].mean(axis=0)[0] > 0.9)
        room_mm.append(room_in_image(outermost, rays))
    # the cap reaches 76 mm from the middle; rays end half a voxel beyond the last column and take steps of 0.75 mm
    np.testing.assert_allclose(room_mm, np.array([166, 168, 172, 176]) - 90.5 - 76, atol=1.25)


def test_in_less_bone_the_rays_are_what_they_are_when_all_are_followed(skull):
    bone = skull("unilateral")
    grid = vertex_rays(bone, np.eye(3))
    # every third plane and a tenth of the rest is gone: rays go on, to deeper bone or out of the head
    less = bone.voxels & ~(np.arange(bone.shape[0]) % 3 == 0)[:, None, None]
    less &= np.random.default_rng(0).random(bone.shape) < 0.9
    part = bone.with_voxels(less)
    again, anew = measured_again(measure_outermost_bone(bone, grid), part), measure_outermost_bone(part, grid)
    np.testing.assert_array_equal(again.radius, anew.radius)
    np.testing.assert_array_equal(again.seen, anew.seen)
    assert (again.radius < measure_outermost_bone(bone, grid).radius).sum() > 100
