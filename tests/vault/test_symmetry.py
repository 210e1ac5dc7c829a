"""The symmetry plane of heads that are symmetric in closed form: cut, turned, moved, on coarse and flat voxels."""

import json
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.vault import symmetry
from cranio_nb.vault.orientation import head_centre
from cranio_nb.volume import Volume
from data_synth import phantom_case, scan
from data_synth.head import SHAPE_TERMS, THICKNESS_TERMS

DEFECTS = ("unilateral", "large", "bilateral", "multiple", "frontal", "vertex", "occipital", "near_base", "partial")

STRAIGHT = (0, 0, 0)


def even(coefficients, terms):
    """Without the odd powers of x, in which left and right differ."""
    return np.where(np.array(terms)[:, 0] % 2, 0.0, coefficients)


def symmetric(head):
    """The same head with its right half like its left; its plane is x = centre."""
    return replace(head, shape=even(head.shape, SHAPE_TERMS), thickness=even(head.thickness, THICKNESS_TERMS))


def turn(yaw, roll, nod):
    """Rotation about z, y and x by degrees."""
    (cz, sz), (cy, sy), (cx, sx) = ((np.cos(a), np.sin(a)) for a in np.radians([yaw, roll, nod]))
    about_z = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    about_y = np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
    return about_z @ about_y @ np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])


@cache
def scanned(defect, degrees):
    """A symmetric head on a grid turned about its centre: bone and the head."""
    case = cut_phantom(defect)
    head, affine, rotation = symmetric(case.head), case.affine.copy(), turn(*degrees)
    if any(degrees):
        affine[:3, :3] = rotation @ affine[:3, :3]
        affine[:3, 3] = rotation @ (affine[:3, 3] - head.centre) + head.centre
    return Volume(scan(head, affine, case.bone.shape)[1], affine), head


@cache
def cut_phantom(defect):
    return phantom_case("tiny", defect, 0)


@cache  # of the very same volume
def found(bone):
    return symmetry.find_symmetry_plane(bone, head_centre(bone))


def check_is_mid_plane(plane, head, mm=0.2, degrees=0.2):
    assert abs((head.centre - plane.point) @ plane.normal) < mm
    assert np.linalg.norm(np.cross(plane.normal, [1, 0, 0])) < np.sin(np.radians(degrees))


@pytest.mark.parametrize("rotation", [STRAIGHT, (12, -7, 5), (-25, 15, 10)])
@pytest.mark.parametrize("defect", DEFECTS)
def test_the_plane_of_a_symmetric_head_is_its_mid_plane_whatever_is_missing(defect, rotation):
    bone, head = scanned(defect, rotation)
    plane = found(bone)
    check_is_mid_plane(plane, head)
    assert plane.converged and plane.residual_mm < 0.25
    column = bone.affine[:3, 2] / np.linalg.norm(bone.affine[:3, 2])
    assert plane.angle_rad == pytest.approx(np.arccos(min(1.0, column[0])), abs=np.radians(0.2))
    middle = bone.to_world((np.array(bone.shape) - 1) / 2)
    assert plane.offset_mm == pytest.approx((head.centre - middle)[0], abs=0.3)


@pytest.mark.parametrize("defect", DEFECTS)
def test_it_moves_with_the_header(defect):
    """To the last digits: no edge, pair or step on the way hinges on how a turned header is rounded."""
    bone, _ = scanned(defect, STRAIGHT)
    here = found(bone)
    for rotation in [(24, -17, 40), (90, 0, 0), (0, 0, 45)]:
        move = np.eye(4)
        move[:3, :3], move[:3, 3] = turn(*rotation), (311.0, -47.5, 905.0)
        there = found(Volume(bone.voxels, move @ bone.affine))
        np.testing.assert_allclose(there.normal, move[:3, :3] @ here.normal, atol=1e-8)
        np.testing.assert_allclose(there.point, move[:3, :3] @ here.point + move[:3, 3], atol=1e-6)
        assert (there.angle_rad, there.offset_mm, there.residual_mm) == pytest.approx(
            (here.angle_rad, here.offset_mm, here.residual_mm)
        )


@pytest.mark.parametrize("axes", [(2,), (1,), (1, 2)])
def test_it_stays_when_the_grid_counts_the_other_way(axes):
    """The same world stored with its columns to the right, its rows to the front, or both."""
    bone, head = scanned("large", (8, -5, 0))
    affine = bone.affine.copy()
    for axis in axes:
        affine[:3, 3] += affine[:3, axis] * (bone.shape[axis] - 1)
        affine[:3, axis] *= -1
    plane = found(Volume(np.flip(bone.voxels, axes).copy(), affine))
    check_is_mid_plane(plane, head)
    assert plane.normal @ affine[:3, 2] > 0


def test_a_tilted_gantry_changes_nothing():
    case = phantom_case("tiny", "round", 0, tilt_deg=15.0)
    head = symmetric(case.head)
    check_is_mid_plane(found(Volume(scan(head, case.affine, case.bone.shape)[1], case.affine)), head)


def test_the_mirror_image_of_a_skull_has_the_mirrored_plane():
    """A skull that is not symmetric, and its mirror image in the grid's middle."""
    case = cut_phantom("unilateral")
    bone = Volume(case.bone, case.affine)
    here, there = found(bone), found(Volume(bone.voxels[:, :, ::-1].copy(), bone.affine))
    assert there.offset_mm == pytest.approx(-here.offset_mm, abs=0.05)
    assert there.angle_rad == pytest.approx(here.angle_rad, abs=np.radians(0.05))
    assert there.residual_mm == pytest.approx(here.residual_mm, abs=0.02)


def test_an_asymmetric_head_has_a_larger_residual():
    case = cut_phantom("unilateral")
    symmetric_one, _ = scanned("unilateral", STRAIGHT)
    assert found(Volume(case.bone, case.affine)).residual_mm > 1.5 * found(symmetric_one).residual_mm


def test_reflecting_twice_changes_nothing_and_volumes_go_along():
    bone, _ = scanned("round", STRAIGHT)
    plane = found(bone)
    points = np.random.default_rng(5).normal(size=(50, 3)) * 80
    image = plane.mirror(points)
    np.testing.assert_allclose(plane.mirror(image), points, atol=1e-9)
    np.testing.assert_allclose(plane.distance(image), -plane.distance(points), atol=1e-9)
    np.testing.assert_allclose(points @ plane.matrix[:3, :3].T + plane.matrix[:3, 3], image, atol=1e-9)
    corners = np.array([[0, 0, 0], [5, 7, 11]])
    np.testing.assert_allclose(plane.mirrored(bone).to_world(corners), plane.mirror(bone.to_world(corners)), atol=1e-9)
    assert np.linalg.norm(plane.normal) == pytest.approx(1)


def test_the_record_is_json_in_degrees():
    plane = found(scanned("round", (12, -7, 5))[0])
    record = json.loads(json.dumps(plane.record(), allow_nan=False))
    assert record["angle_deg"] == pytest.approx(np.degrees(plane.angle_rad)) and record["converged"] is True


def test_half_a_skull_has_no_plane():
    bone, head = scanned("round", STRAIGHT)
    half = bone.voxels.copy()
    half[:, :, : int(bone.to_voxel(head.centre)[2])] = False
    with pytest.raises(InputRefused) as refused:
        symmetry.find_symmetry_plane(bone.with_voxels(half), head.centre)
    assert refused.value.code == "NoSymmetry"


def test_a_real_skull_keeps_its_plane_when_it_is_cut(real_data):
    from cranio_nb.readers import read_ct
    from data_synth import cut_case

    whole = read_ct(real_data / "skullfix/complete/025.nrrd", mask=True)[0]
    case = cut_case(whole.voxels, whole.affine, "large", 25, is_mask=True)
    centre = head_centre(whole)
    before, after = (
        symmetry.find_symmetry_plane(whole, centre),
        symmetry.find_symmetry_plane(Volume(case.bone, case.affine), centre),
    )
    assert abs(after.distance(before.point)) < 0.5
    assert np.linalg.norm(np.cross(before.normal, after.normal)) < np.radians(0.5)
