"""The largest errors of a run are found where they are, and shown."""

import dataclasses

import numpy as np
import pytest

from cranio_nb.evaluation.against_truth import SIDES
from cranio_nb.output import error_pictures
from cranio_nb.output.error_pictures import error_shots, largest_errors


def test_each_side_is_told_with_its_largest_distance(result):
    found = largest_errors(result)
    assert [one.side for one in found] == ["outer", "inner"]
    for one in found:
        assert one.distance_mm == result.truth.distances[one.side].max() == pytest.approx(result_max(result, one.side))
        nodes = result.prosthesis.surface(SIDES[one.side]).vertices
        assert (nodes == one.point).all(axis=1).any()
        assert "left" in one.place  # the hole was cut on the left
        # the point lies in its voxel
        assert np.abs(result.case.bone.to_voxel(one.point) - one.voxel).max() <= 0.5


def result_max(result, side):
    """The largest distance as Table 3 of the page gives it."""
    from cranio_nb.output.design_page import distance_table

    return distance_table(result)[f"{side.capitalize()} (mm)"].max


@pytest.mark.parametrize(
    ("out", "names"),
    [((0, 0, 1), {"coronal", "sagittal"}), ((1, 0, 0), {"axial", "coronal"}), ((0.1, -0.9, 0.4), {"sagittal"})],
)
def test_the_cut_runs_out_of_the_head(out, names):
    assert error_pictures._cut_along(np.array(out)) in names


def test_each_error_has_its_picture(result):
    errors = largest_errors(result)
    shots = error_shots(result, errors)
    assert len(shots) == len(errors) == 2 and shots[0].data != shots[1].data
    for shot, one in zip(shots, errors, strict=True):
        assert f"{one.distance_mm:.2f} mm" in shot.alt and f"{one.distance_mm:.2f} mm in the ring" in shot.caption
        assert one.cut in shot.caption and "scale bar 20 mm" in shot.alt


def test_without_a_truth_there_are_none(result):
    assert largest_errors(dataclasses.replace(result, truth=None)) == []
