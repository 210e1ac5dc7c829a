"""Virtual craniectomy: on a phantom whose vault is known, and on real skulls."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from data_synth import cut_case, phantom_case, scan
from data_synth.files import read_scan


@pytest.fixture(scope="module")
def intact():
    """A whole head on the tiny grid: HU, bone, affine."""
    case = phantom_case("tiny", "unilateral", 6)
    hu, bone, _ = scan(replace(case.head, cutters=()), case.affine, case.bone.shape)
    return hu, bone, case.affine


@pytest.mark.parametrize("defect", ["unilateral", "frontal", "vertex", "near_base", "multiple", "large", "partial"])
def test_mask_parts_add_up_and_the_input_is_untouched(intact, defect):
    _, bone, affine = intact
    before = bone.copy()
    case = cut_case(bone, affine, defect, 1, is_mask=True)
    np.testing.assert_array_equal(bone, before)
    assert case.hu is None and case.head is None
    assert case.implant.any()
    assert not (case.bone & case.implant).any()
    np.testing.assert_array_equal(case.complete, bone)


def test_nothing_is_cut_outside_the_cone(intact):
    _, bone, affine = intact
    case = cut_case(bone, affine, "round", 2, is_mask=True, diameter=40.0)
    p = np.argwhere(case.implant) @ affine[:3, :3].T + affine[:3, 3] - np.array(case.parameters["centre"])
    towards = p.mean(0) / np.linalg.norm(p.mean(0))
    along = p @ towards
    across = np.linalg.norm(p - along[:, None] * towards, axis=1)
    assert along.min() > 40  # nothing on the other side of the head
    assert across.max() < 20 + 2 + 3.5  # radius, bevel, one voxel
    assert across.max() > 16


def test_a_ct_changes_only_at_the_cut(intact):
    hu, _, affine = intact
    case = cut_case(hu, affine, "parietal", 3, is_mask=False)
    solid = hu >= 400
    np.testing.assert_array_equal(case.complete, solid)
    changed = np.argwhere(case.hu != hu)
    missing = np.argwhere(case.implant)
    assert (changed.min(0) >= missing.min(0) - 2).all() and (changed.max(0) <= missing.max(0) + 2).all()
    assert (case.hu <= hu)[case.implant].all()


def test_the_hole_of_a_ct_holds_noisy_soft_tissue(intact):
    hu, _, affine = intact
    case = cut_case(hu, affine, "round", 3, is_mask=False, diameter=60.0)
    core = ndimage.binary_erosion(case.implant) & (hu > 500)
    assert case.hu[core].mean() == pytest.approx(45.0, abs=3)
    assert 9 < case.hu[core].std() < 15
    left = (case.hu >= 400) & case.implant
    assert left.sum() < 0.1 * case.implant.sum()  # blended voxels at the rim only


def test_a_cut_does_not_depend_on_the_axis_order(intact):
    _, bone, affine = intact
    case = cut_case(bone, affine, "frontal", 5, is_mask=True)
    order, turned = [2, 0, 1], bone.transpose(2, 0, 1)[:, ::-1]
    grid = affine[:, [*order, 3]].copy()
    grid[:3, 3] += grid[:3, 1] * (turned.shape[1] - 1)
    grid[:3, 1] *= -1
    again = cut_case(turned, grid, "frontal", 5, is_mask=True)
    back = again.implant[:, ::-1].transpose(1, 2, 0)
    overlap = 2 * (back & case.implant).sum() / (back.sum() + case.implant.sum())
    assert overlap > 0.98


def test_same_seed_same_bytes(intact):
    hu, _, affine = intact
    first, again = (cut_case(hu, affine, "elliptic", 8, is_mask=False) for _ in range(2))
    assert first.hu.tobytes() == again.hu.tobytes()
    assert first.implant.tobytes() == again.implant.tobytes()


def test_what_cannot_be_cut_is_refused(intact):
    _, bone, affine = intact
    with pytest.raises(ValueError, match="no bone in this scan"):
        cut_case(np.zeros_like(bone), affine, "frontal", is_mask=True)
    with pytest.raises(ValueError, match="no defect named"):
        cut_case(bone, affine, "ear", is_mask=True)
    half = bone.copy()
    half[:, :64] = False
    with pytest.raises(ValueError, match=r"no bone where|meets no bone|No vault"):
        cut_case(half, affine, "frontal", 0, is_mask=True)


@pytest.mark.real
def test_real_skull_mask(real_data):
    voxels, affine, is_mask = read_scan(real_data / "skullfix/complete/010.nrrd")
    assert is_mask
    case = cut_case(voxels, affine, "near_base", 1, is_mask=True)
    np.testing.assert_array_equal(case.complete, voxels)
    assert 3e3 < case.implant.sum() * case.voxel_volume < 3e4
    centre = np.argwhere(case.implant).mean(0)
    top = np.flatnonzero(voxels.any((1, 2)))[-1]
    below = (top - centre[0]) * case.affine[2, 0]
    assert 20 < below < 100


@pytest.mark.real
def test_real_dry_skull(real_data):
    voxels, affine, is_mask = read_scan(real_data / "dicom/dryskull_multiseries/S2020")
    assert not is_mask and voxels.shape == (140, 512, 512)
    np.testing.assert_allclose(np.linalg.norm(affine[:3, :3], axis=0), [1.0, 0.451, 0.451], atol=1e-3)
    case = cut_case(voxels, affine, "unilateral", 1, is_mask=False)
    np.testing.assert_array_equal(case.complete, voxels >= 400)
    # the saw cut through this skull must not stop the hole
    span = np.flatnonzero(case.implant.any((1, 2)))
    assert np.ptp(span) >= 50
    assert (case.hu[case.implant] >= 400).mean() < 0.05
