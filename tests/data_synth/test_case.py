"""A case: its parts, its volume, and its gaps."""

import numpy as np
import pytest

from data_synth import cut_case, phantom_case


def test_a_case_is_a_skull_in_two_parts():
    case = phantom_case("tiny", "unilateral", 0)
    assert not (case.bone & case.implant).any()
    np.testing.assert_array_equal(case.complete, case.bone | case.implant)
    assert case.voxel_volume == pytest.approx(3 * 1.75**2)


def test_only_a_phantom_knows_its_gaps_in_closed_form():
    case = phantom_case("tiny", "unilateral", 0)
    plane = int(np.argwhere(case.implant).mean(0)[0].round())
    (truth,) = case.slice_truth(plane)
    assert truth.is_open and truth.plane == plane
    cut = cut_case(case.complete, case.affine, "unilateral", is_mask=True)
    assert cut.head is None and cut.slice_truth(plane) == ()
