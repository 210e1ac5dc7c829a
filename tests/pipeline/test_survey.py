"""A scan, its bone, how the head lies, and every opening judged."""

from dataclasses import replace

import numpy as np
import pytest

import cranio_nb as cn
from cranio_nb.errors import NoOpening
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import run_design
from cranio_nb.pipeline.survey import survey_scan
from cranio_nb.vault import head_frame
from cranio_nb.vault.opening_search import survey_openings


def test_a_survey_is_that_of_the_bone_in_the_frame_it_names(phantom):
    case = phantom("bilateral")
    seen = survey_scan(cn.Volume(case.hu, case.affine))
    np.testing.assert_array_equal(seen.bone.voxels, cn.segment(cn.Volume(case.hu, case.affine)).voxels)
    assert [one.number for one in seen.found] == [1, 2]
    again = survey_openings(seen.bone, scan=cn.Volume(case.hu, case.affine))
    for one, other in zip(seen.found, again, strict=True):
        assert one.verdict == other.verdict
        np.testing.assert_array_equal(one.opening.sheet.voxels, other.opening.sheet.voxels)
        np.testing.assert_array_equal(one.opening.head_axes, seen.frame.ray_axes)


def test_that_a_skull_is_closed_is_said_with_the_second_one_that_may_be_open(phantom):
    closed, holed = phantom("burr_hole"), phantom("burr_hole")
    seen = survey_scan(cn.Volume(np.concatenate([closed.complete, holed.bone], axis=2), closed.affine))
    assert {"ThickSlices", "SecondSkull"} <= {one.code for one in seen.remarks}
    assert not seen.found
    with pytest.raises(NoOpening, match=r"there is nothing to close.*12 mm wide.*second skull"):
        seen.choose()


@pytest.mark.parametrize("method", ["reflection", "thin-plate"])
def test_how_the_head_lies_is_found_once_a_run_and_handed_on(method, skull, tmp_path, monkeypatch):
    write_nifti(skull("unilateral"), tmp_path / "skull.nii.gz")
    found = []

    def counted(bone, coarse_bone=head_frame.coarse_bone):
        found.append(bone)
        return coarse_bone(bone)

    monkeypatch.setattr(head_frame, "coarse_bone", counted)
    case = prepare(tmp_path / "skull.nii.gz")
    made = run_design(case, method=method).prosthesis
    assert len(found) == 1
    # openings without axes, as a user may give them: found once more, and the same comes out bit by bit
    bare = [replace(one, head_axes=None) for one in case.openings]
    again = cn.design(case.bone, bare, method=method)
    assert len(found) == 2
    np.testing.assert_array_equal(again.patch.voxels, made.patch.voxels)
    np.testing.assert_array_equal(again.mesh.vertices, made.mesh.vertices)


def test_thick_slices_are_said_whichever_axis_they_lie_along(phantom):
    case = phantom("bilateral")
    affine = case.affine.copy()
    affine[:, 1] *= 3  # rows of 5.25 mm, as in a coronal series, between planes of 3 mm
    seen = survey_scan(cn.Volume(case.hu[:, ::3], affine))
    said = {one.code: one.values for one in seen.remarks}
    assert said["ThickSlices"]["slice_mm"] == pytest.approx(5.25)
