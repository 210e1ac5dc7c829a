"""Cases by path, by seed and by a cut: what they hold, and how they refuse."""

import numpy as np
import pytest
from studies import unreadable

from cranio_nb.errors import InputRefused
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.study.cases import cut_case, load_case, phantom_cases, scan_cases
from cranio_nb.volume import Volume


@pytest.fixture
def folder(tmp_path, phantom):
    """A skull with a hole and its truth, and a whole skull."""
    case = phantom("burr_hole", 0)
    (tmp_path / "one").mkdir()
    write_nifti(Volume(case.bone, case.affine), tmp_path / "one" / "skull.nii.gz")
    write_nifti(Volume(case.implant, case.affine), tmp_path / "one" / "truth.nii.gz")
    write_nifti(Volume(case.complete, case.affine), tmp_path / "whole.nii.gz")
    return tmp_path


def test_a_phantom_is_the_one_of_its_seed(phantom):
    (case,) = phantom_cases(["burr_hole"], [0], size="tiny")
    made = load_case(case)
    scan, truth = made.scan, made.truth
    np.testing.assert_array_equal(scan.voxels, phantom("burr_hole", 0).hu)
    np.testing.assert_array_equal(truth.voxels, phantom("burr_hole", 0).implant)
    assert case.facts == {"defect": "burr_hole", "seed": 0, "asked_mm": None}


def test_a_scan_comes_with_the_truth_beside_it(folder, phantom):
    (case,) = scan_cases(["one/skull.nii.gz"], truth="truth.nii.gz", folder=folder)
    made = load_case(case)
    bone, truth = made.scan, made.truth
    np.testing.assert_array_equal(bone.voxels, phantom("burr_hole", 0).bone)
    np.testing.assert_array_equal(truth.voxels, phantom("burr_hole", 0).implant)
    assert load_case(scan_cases(["one/skull.nii.gz"], folder=folder)[0]).truth is None


def test_a_cut_too_wide_is_made_as_wide_as_fits(folder, phantom):
    whole = phantom("burr_hole", 0).complete
    made = load_case(cut_case("whole.nii.gz", "round", 1, diameter_mm=500, folder=folder))
    bone, truth = made.scan, made.truth
    assert truth.voxels.any() and not (bone.voxels & truth.voxels).any()
    np.testing.assert_array_equal(bone.voxels | truth.voxels, whole)


def test_what_cannot_be_made_or_read_is_refused():
    with pytest.raises(InputRefused, match="There is no defect named 'star'"):
        load_case(phantom_cases(["star"], [0], size="tiny")[0])
    with pytest.raises(InputRefused):
        load_case(unreadable())


def test_a_case_is_the_same_wherever_its_folder_lies():
    a, b = (scan_cases(["x.nii"], folder=folder)[0] for folder in ("here", "there"))
    assert a == b and "here" not in a.name
