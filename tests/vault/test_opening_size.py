"""The size of an opening whose sheet is drawn, and words for where it lies."""

import numpy as np
import pytest

from cranio_nb.opening import Opening
from cranio_nb.vault.opening_size import measure_opening, name_place
from cranio_nb.volume import Volume


def test_words_for_places_are_the_patients():
    assert name_place([1, 0, 0]) == "left" and name_place([-0.7, -0.7, 0]) == "right, front"
    assert name_place([0, 0.6, 0.8]) == "back, top"


def test_a_flat_oval_sheet_has_its_axes_and_place():
    affine = np.array([[0, 0, 2.0, 40], [0, 1.5, 0, -20], [2.5, 0, 0, 10], [0, 0, 0, 1]])
    grid = Volume(np.zeros((60, 60, 20), bool), affine)
    p = grid.to_world(np.moveaxis(np.indices(grid.shape), 0, -1))
    centre = np.array([60.0, 24.0, 84.0])
    oval = (((p - centre)[..., 1] / 20) ** 2 + ((p - centre)[..., 2] / 35) ** 2 <= 1) & (np.abs(p - centre)[..., 0] < 3)
    one = measure_opening(Opening(grid.with_voxels(oval), centre - [70.0, 0, 0]))
    assert (one.length, one.width) == pytest.approx((70, 40), abs=3)  # two voxels, less the outermost percent
    assert one.centre == pytest.approx(tuple(centre), abs=1) and one.direction == pytest.approx((1, 0, 0), abs=0.01)
    assert one.place == "left" and one.lowest == pytest.approx(centre[2] - 35, abs=2.5)
    # in a head that lies face down in the scan it is the head's other side
    down = Opening(grid.with_voxels(oval), centre - [70.0, 0, 0], np.diag([-1.0, -1.0, 1.0]))
    assert measure_opening(down).place == "right"
    assert one.planes == (int(np.flatnonzero(oval.any(axis=(1, 2)))[0]), int(np.flatnonzero(oval.any(axis=(1, 2)))[-1]))


def test_the_found_opening_of_a_phantom_lies_where_it_was_cut(openings):
    (one,) = [measure_opening(opening) for opening in openings("unilateral")]
    (opening,) = openings("unilateral")
    assert one.place.startswith("left") and opening.planes == (one.planes[0], one.planes[1] + 1)
    assert one.centre == pytest.approx(tuple(opening.centre))
    assert one.direction == pytest.approx(tuple(opening.direction))
