"""Bone out of HU: thresholds, artefacts, holes, on boxes whose answer can be counted and on phantoms."""

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.stages.segmentation import apply_threshold, drop_artefacts, fill_holes, segment
from cranio_nb.volume import Volume
from data_synth import phantom_case

AFFINE = np.array([[0, 0, 2.0, -60.0], [0, 2.0, 0, -75.0], [3.0, 0, 0, -900.0], [0, 0, 0, 1.0]])


@pytest.fixture
def shell():
    """A hollow box of bone, 2 voxels thick, on a grid of 30 x 60 x 60."""
    mask = np.zeros((30, 60, 60), bool)
    mask[4:26, 10:50, 10:50] = True
    mask[6:24, 12:48, 12:48] = False
    return mask


def ct_of(mask, hu=1200):
    return Volume(np.where(mask, hu, 40).astype(np.int16), AFFINE)


def test_the_shell_is_found_as_it_is(shell):
    bone = segment(ct_of(shell))
    np.testing.assert_array_equal(bone.voxels, shell)
    assert bone.voxels.dtype == bool
    np.testing.assert_array_equal(bone.affine, AFFINE)


def test_the_threshold_belongs_to_bone_and_so_does_the_upper_bound():
    hu = np.array([[[-1000, 399, 400, 401, 1000, 1001, 3071]]], np.int16)
    np.testing.assert_array_equal(apply_threshold(hu, 400)[0, 0], [0, 0, 1, 1, 1, 1, 1])
    np.testing.assert_array_equal(apply_threshold(hu, 400, 1000)[0, 0], [0, 0, 1, 1, 1, 0, 0])


def test_without_an_upper_bound_the_densest_bone_counts_and_with_one_it_does_not(shell):
    hu = np.where(shell, 1200, 40).astype(np.int16)
    hu[4:6, 10:50, 10:50] = 1800
    assert segment(Volume(hu, AFFINE)).voxels.sum() == shell.sum()
    assert not segment(Volume(hu, AFFINE), upper=1500).voxels[4:6].any()


def test_a_constant_added_to_hu_and_threshold_changes_no_bit(phantom):
    case = phantom("ragged", 1)
    for shift in (-300, 17, 250):
        shifted = Volume(case.hu.astype(np.int32) + shift, case.affine)
        bone = segment(shifted, threshold=400 + shift)
        assert bone.voxels.tobytes() == segment(Volume(case.hu, case.affine), threshold=400).voxels.tobytes()


def test_segmenting_a_segmentation_changes_nothing(phantom):
    for defect in ("unilateral", "multiple", "partial"):
        bone = segment(Volume(phantom(defect).hu, phantom(defect).affine))
        np.testing.assert_array_equal(segment(bone).voxels, bone.voxels)


def test_a_lower_threshold_never_loses_bone_above_it(phantom):
    case = phantom("unilateral")
    low, high = (segment(Volume(case.hu, case.affine), threshold=t).voxels for t in (300, 500))
    assert not (high & ~low).any()
    assert low.sum() > high.sum()


def test_the_phantoms_bone_is_found(phantom):
    case = phantom("unilateral")
    bone = segment(Volume(case.hu, case.affine)).voxels
    assert 2 * (bone & case.bone).sum() / (bone.sum() + case.bone.sum()) > 0.93
    assert not (bone & (case.hu < 400)).sum() > 0.02 * bone.sum()  # filled diploe only


def test_the_couch_is_dropped_and_the_skull_kept(phantom):
    with_couch = phantom_case("tiny", "unilateral", 0, couch=True)
    behind = with_couch.hu != phantom("unilateral").hu
    assert ((with_couch.hu >= 400) & behind).any()
    np.testing.assert_array_equal(
        segment(Volume(with_couch.hu, with_couch.affine)).voxels,
        segment(Volume(phantom("unilateral").hu, with_couch.affine)).voxels,
    )


def test_a_holder_larger_than_the_skulls_bone_does_not_take_its_place(shell):
    holder = np.zeros_like(shell)
    holder[:, 53:60, :] = True
    assert holder.sum() > shell.sum()
    np.testing.assert_array_equal(drop_artefacts(shell | holder), shell)


def test_islands_are_dropped_and_large_loose_pieces_kept(shell):
    piece, island = np.zeros_like(shell), np.zeros_like(shell)
    piece[12:18, 25:35, 25:35] = True  # a bone flap that touches nothing
    island[8:10, 20:22, 20:22] = True
    assert piece.sum() > 0.02 * shell.sum() > island.sum()
    np.testing.assert_array_equal(drop_artefacts(shell | piece | island), shell | piece)
    np.testing.assert_array_equal(drop_artefacts(shell | piece | island, min_part=1e-9), shell | piece | island)


def test_the_smallest_part_kept_is_a_fraction_of_the_skull(shell):
    piece = np.zeros_like(shell)
    piece[12:18, 25:35, 25:35] = True
    share = piece.sum() / shell.sum()
    assert drop_artefacts(shell | piece, min_part=0.999 * share)[piece].all()
    assert not drop_artefacts(shell | piece, min_part=1.001 * share)[piece].any()


@pytest.mark.parametrize(("area", "filled"), [(11, False), (12, True), (13, True)])
def test_a_hole_of_a_slice_is_filled_up_to_its_area(area, filled):
    mask = np.ones((3, 20, 20), bool)
    mask[1, 5:8, 5:9] = False  # 12 px
    assert fill_holes(mask, max_hole_px=area)[1, 5:8, 5:9].all() == filled


def test_max_hole_is_in_square_millimetres(shell):
    solid = shell.copy()
    solid[4:6, 20:23, 20:25] = False  # 15 px of 4 mm2 in the floor of the box
    assert segment(ct_of(solid), max_hole_mm2=60.0).voxels[4:6, 20:23, 20:25].all()
    assert not segment(ct_of(solid), max_hole_mm2=59.9).voxels[4:6, 20:23, 20:25].any()


def test_the_diploe_is_filled_and_the_cavity_is_not(shell):
    wall = shell.copy()
    wall[:, 10:50, 10:16] |= wall[:, 10:50, 10:11]  # a thicker side wall with a spongy middle
    spongy = np.zeros_like(shell)
    spongy[10:20, 20:24, 12:14] = True
    wall[10:20, 18:26, 10:16] = True
    bone = segment(ct_of(wall & ~spongy)).voxels
    assert bone[spongy].all()
    assert not bone[10, 30, 30]
    np.testing.assert_array_equal(bone, wall)


def test_a_notch_at_the_edge_of_the_image_is_not_a_hole():
    mask = np.ones((1, 10, 10), bool)
    mask[0, 0:2, 4:6] = False
    np.testing.assert_array_equal(fill_holes(mask, max_hole_px=100), mask)


def test_a_hole_that_only_a_diagonal_closes_is_a_hole():
    mask = np.zeros((1, 5, 5), bool)
    mask[0, [1, 2, 2, 3], [2, 1, 3, 2]] = True
    assert fill_holes(mask, max_hole_px=1)[0, 2, 2]


def test_holes_are_those_of_single_slices():
    mask = np.ones((3, 9, 9), bool)
    mask[:, 4, 4] = False  # a canal through all slices is open above and below, but closed in each slice
    assert fill_holes(mask, max_hole_px=1).all()


def test_turning_the_slices_by_90_degrees_turns_the_answer(phantom):
    case = phantom("ragged", 1)
    bone = segment(Volume(case.hu, case.affine)).voxels
    turned = Volume(np.rot90(case.hu, axes=(1, 2)), case.affine)
    np.testing.assert_array_equal(segment(turned).voxels, np.rot90(bone, axes=(1, 2)))


def test_without_bone_it_says_so(shell):
    with pytest.raises(InputRefused, match="400 HU") as refused:
        segment(ct_of(shell, hu=399))
    assert refused.value.code == "NoBone"


def test_the_ct_is_not_modified(phantom):
    case = phantom("unilateral")  # its arrays are read-only
    before = case.hu.copy()
    bone = segment(Volume(case.hu, case.affine))
    np.testing.assert_array_equal(case.hu, before)
    mask = np.array(bone.voxels)
    segment(Volume(mask, case.affine)).voxels[:] = False
    np.testing.assert_array_equal(mask, bone.voxels)


def test_a_holder_beyond_air_is_no_skull_and_a_piece_in_the_scalp_is():
    z, y, x = (np.indices((60, 80, 80)) - np.array([30, 40, 40])[:, None, None, None]) * 2.0
    r = np.sqrt(x**2 + y**2 + z**2)
    hu = np.where(r < 52, 40, -1000).astype(np.int16)
    skull = (np.abs(r - 42) < 3) & ~((y > 0) & (np.hypot(x, z) < 15))
    piece = (np.abs(r - 49) < 2) & (y < 0) & (np.hypot(x, z) < 25)
    holder = (np.abs(r - 60) < 3) & (y > 10) & (np.abs(z) < 20)
    hu[skull | piece | holder] = 900
    found = segment(Volume(hu, np.diag([2.0, 2.0, 2.0, 1.0]))).voxels
    assert found[skull].all() and found[piece].all() and not found[holder].any()
