"""The braincase: gradients, thickness, symmetry, gaps of a posed head."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth import Pose, face_case
from data_synth.face.braincase import braincase
from data_synth.truth import gaps_in_slice

TEMPLE, BROW = np.array([0.99, -0.14, 0.12]), np.array([0.0, -1.0, 0.06])


@pytest.fixture(scope="module")
def directions():
    d = np.random.default_rng(0).standard_normal((1500, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def skull(seed, **options):
    return braincase(np.random.default_rng(seed), np.zeros(3), np.eye(3), **options)


def test_gradients_match_finite_differences(directions):
    head, step = skull(2), 1e-5
    p = directions * 80.0

    def levels(q):
        depth, thickness = head.surfaces(q)
        return -depth, thickness - depth

    for surface, gradient in enumerate(head.gradients(p)):
        for axis, unit in enumerate(np.eye(3)):
            difference = (levels(p + step * unit)[surface] - levels(p - step * unit)[surface]) / (2 * step)
            np.testing.assert_allclose(gradient[:, axis], difference, atol=1e-6)
    np.testing.assert_allclose(head.slope(p), np.linalg.norm(head.gradients(p)[0], axis=1))


@pytest.mark.parametrize("seed", range(8))
def test_thickness_is_that_of_a_skull(seed, directions):
    head = skull(seed)
    vault = head.bone_thickness(directions[directions[:, 2] > 0.5])
    assert 4.5 < vault.min() and 5.5 < np.median(vault) < 8.0
    assert 1.7 < head.bone_thickness(TEMPLE / np.linalg.norm(TEMPLE)) < 3.6
    assert head.bone_thickness(BROW / np.linalg.norm(BROW)) > 9.0
    assert head.bone_thickness(directions).min() > 1.2


def test_without_asymmetry_left_mirrors_right(directions):
    same, other = skull(4, asymmetry=0.0), skull(4)
    mirror = directions * [-1, 1, 1]
    np.testing.assert_allclose(same.outer_radius(directions), same.outer_radius(mirror), rtol=1e-12)
    np.testing.assert_allclose(same.bone_thickness(directions), same.bone_thickness(mirror), rtol=1e-12)
    assert np.abs(other.outer_radius(directions) - other.outer_radius(mirror)).max() > 0.5


def test_sutures_meet_at_bregma_and_lambda():
    head = skull(0)
    for point in ([0.0, -19.5, 92.0], [0.0, 78.0, 48.0]):
        around = np.array(point) + np.random.default_rng(0).uniform(-4, 4, (400, 3))
        assert head.suture_distance(around).min() < 0.3
    assert head.suture_distance(np.array([[40.0, -70.0, 40.0]])) > 10  # none in the forehead


@pytest.mark.parametrize("pose", [Pose(), Pose(nod_deg=20, turn_deg=40), Pose(nod_deg=180)])
def test_gaps_of_a_posed_head_lie_on_its_surfaces(pose):
    case = face_case("tiny", 1, holes="unilateral", pose=pose)
    planes = np.flatnonzero(case.implant.any((1, 2)))
    truths = case.slice_truth(int(planes[len(planes) // 2]))
    assert truths
    for truth in truths:
        index = np.column_stack([np.full(101, truth.plane), truth.outer.curve])
        p = (index @ case.affine[:3, :3].T + case.affine[:3, 3] - case.head.centre) @ case.head.rotation
        np.testing.assert_allclose(case.head.surfaces(p)[0], 0, atol=1e-7)


def test_steep_planes_have_no_gaps():
    case = face_case("tiny", 1, holes="unilateral", pose=Pose(roll_deg=90))
    assert all(case.slice_truth(plane) == () for plane in range(case.bone.shape[0]))
    upright = replace(case.head, rotation=np.eye(3))
    assert any(gaps_in_slice(upright, case.affine, plane) for plane in range(case.bone.shape[0]))
