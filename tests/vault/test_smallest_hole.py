"""The smallest hole that slices can show."""

import pytest

from cranio_nb.vault.smallest_hole import LEAST_MM, smallest_hole_mm


def test_thin_slices_show_what_is_looked_for():
    assert smallest_hole_mm(0.5) == smallest_hole_mm(2.5) == LEAST_MM


@pytest.mark.parametrize("slice_mm", [3.0, 4.5, 10.0])
def test_of_a_hole_that_is_shown_a_core_stays_between_two_blurred_slices(slice_mm):
    assert smallest_hole_mm(slice_mm) - 2 * slice_mm == pytest.approx(6.0)
