"""What comes before a design: the scan, its bone and openings, the missing bone."""

import numpy as np
import pytest
from hollow_ball import pierced

import cranio_nb as cn
from cranio_nb.errors import InputRefused, NoOpening
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline.preparation import Clock, check_margin, prepare, touches_border, within_planes
from cranio_nb.vault.opening_search import survey_openings


@pytest.fixture
def scan(skull, tmp_path):
    path = tmp_path / "skull.nii.gz"
    write_nifti(skull("burr_hole"), path)
    return path


def test_a_prepared_mask_is_the_skull_and_its_openings(scan, skull, openings):
    case = prepare(scan)
    np.testing.assert_array_equal(case.bone.voxels, skull("burr_hole").voxels)
    assert [o.planes for o in case.openings] == [o.planes for o in openings("burr_hole")]
    assert case.threshold is None and case.truth is None and all(s >= 0 for s in case.seconds.values())


def test_only_the_part_between_two_planes_is_kept(skull):
    (one,) = survey_openings(skull("burr_hole"))
    opening = one.opening
    first, end = opening.planes
    (kept,) = within_planes((one,), (first + 1, end + 5))
    part = kept.opening
    assert kept.number == one.number and kept.size.planes == (first + 1, end - 1)
    assert part.planes == (first + 1, end)
    np.testing.assert_array_equal(part.sheet.voxels[first + 1 :], opening.sheet.voxels[first + 1 :])
    np.testing.assert_array_equal(part.head_centre, opening.head_centre)


def test_planes_without_an_opening_and_planes_that_are_none_are_refused(skull):
    (one,) = survey_openings(skull("burr_hole"))
    end = one.opening.planes[1]
    with pytest.raises(NoOpening, match="openings were found in planes"):
        within_planes((one,), (end, end))
    for planes in ((-1, 3), (5, 4), (0, one.opening.sheet.shape[0])):
        with pytest.raises(InputRefused) as refused:
            within_planes((one,), planes)
        assert refused.value.code == "BadPlanes"


@pytest.mark.parametrize("at", [(0, 2, 2), (4, 2, 2), (2, 0, 2), (2, 4, 2), (2, 2, 0), (2, 2, 4), (2, 2, 2), (1, 3, 1)])
def test_a_mask_touches_the_border_where_it_has_an_outermost_voxel(at):
    voxels = np.zeros((5, 5, 5), bool)
    voxels[at] = True
    mask, outermost = cn.Volume(voxels, np.eye(4)), bool({0, 4} & set(at))
    assert touches_border(mask) == outermost
    if outermost:
        with pytest.raises(InputRefused, match="The hole reaches the edge"):
            check_margin(mask, "The hole")
    else:
        check_margin(mask, "The hole")


def test_a_clock_goes_on_from_what_was_measured():
    clock = Clock({"read": 3.0})
    clock.lap("bone")
    assert clock.seconds["read"] == 3.0 and clock.seconds["bone"] >= 0


def test_openings_are_chosen_by_number_and_the_others_left_open(skull, tmp_path):
    write_nifti(skull("bilateral"), tmp_path / "skull.nii.gz")
    both, second = prepare(tmp_path / "skull.nii.gz"), prepare(tmp_path / "skull.nii.gz", opening=[2])
    assert [one.number for one in both.closed] == [1, 2] and both.left_open == ()
    assert [one.number for one in second.closed] == [2] and [one.number for one in second.left_open] == [1]
    np.testing.assert_array_equal(second.openings[0].sheet.voxels, both.openings[1].sheet.voxels)
    assert second.sizes == both.sizes[1:]
    # beside planes: numbers first, and what is left keeps its number
    first, last = second.sizes[0].planes
    part = prepare(tmp_path / "skull.nii.gz", opening=[2], planes=(first + 2, last))
    assert [one.number for one in part.closed] == [2] and part.sizes[0].planes == (first + 2, last)
    with pytest.raises(InputRefused, match=r"no opening 3.*Opening 1.*Opening 2") as refused:
        prepare(tmp_path / "skull.nii.gz", opening=[3])
    assert refused.value.code == "NoSuchOpening"


def test_thick_slices_are_said_before_a_design(scan):
    case = prepare(scan)  # its slices are 3 mm apart
    (said,) = [found for found in case.load.findings if found.code == "ThickSlices"]
    assert said.severity == "warning" and said.values["slice_mm"] == pytest.approx(3.0)


def test_a_hole_that_was_filled_as_a_pore_is_open_again_where_it_is_chosen(tmp_path):
    """A hollow ball with a hole of 55 mm2 at its top, which its slices cut flat."""
    ball = pierced(8.4, 1.0, at_top=True)
    write_nifti(ball, tmp_path / "ball.nii.gz")
    with pytest.raises(NoOpening, match="--opening 1"):
        prepare(tmp_path / "ball.nii.gz")
    case = prepare(tmp_path / "ball.nii.gz", opening=(1,))
    np.testing.assert_array_equal(case.bone.voxels, ball.voxels)
