"""The case: masks, holes, poses of head and planes, slices, seeds, refusals."""

from functools import cache

import numpy as np
import pytest
from scipy import ndimage

from data_synth import DefectSpec, Pose, face_case
from data_synth.files import write_case

made = cache(face_case)  # heads that several tests look at


def test_bone_and_implant_make_the_intact_skull():
    whole = face_case("tiny", 4)
    assert whole.defect == "intact" and not whole.implant.any()
    for holes in (1, 3, "bilateral"):
        case = made("tiny", 4, holes=holes)
        assert case.implant.any() and not (case.bone & case.implant).any()
        if isinstance(holes, str):
            np.testing.assert_array_equal(case.complete, whole.complete)


def test_holes_change_nothing_else():
    whole, case = (face_case("tiny", 4, holes=holes, noise=0.0, blur_mm=0.0) for holes in ("burr_hole", "unilateral"))
    changed = whole.hu != case.hu
    near = ndimage.binary_dilation(whole.implant | case.implant, np.ones((3, 3, 3)), iterations=2)
    assert not (changed & ~near).any()


@pytest.mark.parametrize("count", [1, 2, 3])
def test_as_many_pieces_are_missing_as_were_asked_for(count):
    case = face_case("tiny", count, holes=count, slice_mm=1.25)
    labels, found = ndimage.label(case.implant, np.ones((3, 3, 3)))
    large = np.bincount(labels.ravel())[1:] * case.voxel_volume > 30.0
    assert large.sum() == count == len(case.head.cutters), found


def test_a_hole_has_its_diameter():
    spec = DefectSpec((0.7, 0.3, 0.7), (50.0, 50.0), (1.0, 1.0), 0.0, 0.0, either_side=False, jitter=0.0)
    case = face_case("class", 1, holes=[spec])
    p = np.argwhere(case.implant) @ case.affine[:3, :3].T + case.affine[:3, 3] - case.head.centre
    across = p @ case.head.cutters[0].axes[:2].T
    np.testing.assert_allclose(np.ptp(across, axis=0), 50.0, atol=3.0)


def test_turning_head_and_planes_alike_changes_the_header_only():
    pose = Pose(-20.0, 15.0, 40.0)
    straight = made("tiny", 5, holes=1)
    oblique = face_case("tiny", 5, holes=1, pose=pose, planes=pose)
    np.testing.assert_array_equal(straight.bone, oblique.bone)
    assert np.abs(straight.hu.astype(int) - oblique.hu).max() <= 1 or (straight.hu != oblique.hu).mean() < 1e-4
    turn = pose.rotation()
    np.testing.assert_allclose(oblique.affine[:3, :3], turn @ straight.affine[:3, :3], atol=1e-9)


@pytest.mark.parametrize("pose", [Pose(30, 0, 0), Pose(-30, 30, 0), Pose(180, 0, 0), Pose(0, 90, 0), Pose(0, -30, 135)])
def test_the_braincase_is_whole_in_every_pose(pose):
    case, still = (made("tiny", 6, pose=p, slice_mm=2.5) for p in (pose, None))
    volumes = []
    for one in (case, still):
        p = np.argwhere(one.bone) @ one.affine[:3, :3].T + one.affine[:3, 3] - one.head.centre
        vault = np.linalg.norm(p - 75 * one.landmarks.up, axis=1) < 75
        volumes.append(vault.sum() * one.voxel_volume)
    assert volumes[0] == pytest.approx(volumes[1], rel=0.01)


@pytest.mark.parametrize("slice_mm", [0.5, 5.0])
def test_slices_have_the_thickness_asked_for_and_show_the_same_bone(slice_mm):
    case, usual = face_case("tiny", 1, slice_mm=slice_mm), made("tiny", 1)
    np.testing.assert_allclose(np.linalg.norm(case.affine[:3, :3], axis=0), [slice_mm, 1.75, 1.75])
    volumes = [(one.bone.sum() * one.voxel_volume) for one in (case, usual)]
    assert volumes[0] == pytest.approx(volumes[1], rel=0.05)


def test_the_whole_head_reaches_to_chin_and_neck():
    short, long = (face_case("tiny", 0, reach=reach) for reach in ("vault", "neck"))
    assert long.bone.shape[0] > short.bone.shape[0] + 15
    index = np.linalg.solve(long.affine[:3, :3], long.landmarks.chin - long.affine[:3, 3])
    assert (index > 0).all() and (index < long.bone.shape).all()


def test_same_seed_same_bytes_other_seed_other_head():
    first, again, other = made("tiny", 4, holes=1), face_case("tiny", 4, holes=1), made("tiny", 5, holes=1)
    for name in ("hu", "bone", "implant", "affine"):
        assert getattr(first, name).tobytes() == getattr(again, name).tobytes()
    assert first.bone.shape != other.bone.shape or (first.complete != other.complete).any()


def test_a_case_can_be_written(tmp_path):
    write_case(tmp_path / "case", face_case("tiny", 1, holes="round", pose=Pose(10, 5, 3)))
    assert (tmp_path / "case" / "truth.json").exists()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"size": "huge"}, "no size named 'huge'"),
        ({"reach": "feet"}, "cannot reach over 'feet'"),
        ({"slice_mm": 0.2}, "0.5 to 5 mm"),
        ({"slice_mm": float("nan")}, "0.5 to 5 mm"),
        ({"holes": 4}, "1 to 3 holes"),
        ({"holes": "ear"}, "no defect named 'ear'"),
        ({"diameters_mm": (30.0,)}, "1 to 3 holes"),
    ],
)
def test_wrong_requests_are_refused(options, words):
    with pytest.raises(ValueError, match=words):
        face_case(**({"size": "tiny"} | options))
