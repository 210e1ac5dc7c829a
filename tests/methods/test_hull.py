"""Hulls over the hole of a hollow ball, where the flat lid is known in closed form."""

import numpy as np
import pytest
from hollow_ball import CENTRE, HALF_DEG, INNER, OUTER, STEP, ball

from cranio_nb.errors import NoOpening
from cranio_nb.methods.design import design


def depths(made, towards):
    """Heights of the patch's voxels over the head centre along the hole's axis, mm."""
    points = made.patch.to_world(np.argwhere(made.patch.voxels)) - CENTRE
    return points @ (towards / np.linalg.norm(towards))


@pytest.mark.parametrize("axial", [False, True])
def test_a_round_hole_gets_a_flat_lid_from_rim_to_rim(axial):
    towards = np.array([0.9, 0.35, 0.0])
    bone, opening = ball(towards)
    made = design(bone, (opening,), axial=axial, method="hull")
    height = depths(made, towards)
    lid, floor = OUTER * np.cos(np.radians(HALF_DEG)), INNER * np.cos(np.radians(HALF_DEG))
    assert np.quantile(height, 0.99) < lid + 1.5 * STEP and np.quantile(height, 0.01) > floor - 1.5 * STEP
    assert np.quantile(height, 0.95) == pytest.approx(lid, abs=2.0)
    assert height.max() < OUTER - 2  # the ball's own cap would reach up to OUTER


def test_the_hull_in_space_closes_the_top_where_slices_hold_no_ring():
    towards = np.array([0.0, 0.1, 1.0])
    bone, opening = ball(towards)
    assert design(bone, (opening,), method="hull").patch.voxels.any()
    try:
        sliced = design(bone, (opening,), axial=True, method="hull")
    except NoOpening as nothing:
        assert nothing.code == "NothingBridged"
    else:
        assert sliced.patch.voxels.sum() < 0.5 * design(bone, (opening,), method="hull").patch.voxels.sum()


def test_the_hulls_of_slices_lie_below_the_hull_in_space(skull, openings):
    """Every point of a slice's hull is a point of the hull in space."""
    (part,) = design(skull("round"), openings("round"), method="hull").working
    sliced = design(skull("round"), openings("round"), axial=True, method="hull").patch
    away = sliced.to_world(np.argwhere(sliced.voxels)) - part.radius_map.grid.centre
    v, u = np.rint(part.radius_map.grid.locate(away)).astype(int)
    top = part.outer[v, u]
    above = np.linalg.norm(away, axis=1) - top
    assert np.quantile(above[np.isfinite(top)], 0.99) < 0.6 * sliced.spacing.max()


def test_every_slice_says_how_it_was_filled(skull, openings):
    record = design(skull("unilateral"), openings("unilateral"), axial=True, method="hull").record["slices"]
    first, end = openings("unilateral")[0].planes
    assert [entry["plane"] for entry in record] == list(range(first - 2, end + 2))
    assert {"open ring"} <= {entry["reason"] for entry in record if entry["status"] == "hull"}
    assert "slices" not in design(skull("unilateral"), openings("unilateral"), method="hull").record


def test_a_hull_is_no_deeper_or_higher_than_its_two_surfaces(skull, openings):
    (part,) = design(skull("round"), openings("round"), method="hull").working
    inside = part.radius_map.hole
    assert np.isfinite(part.outer[inside]).mean() > 0.98 and np.isnan(part.outer[~inside]).all()
    assert (part.outer - part.inner)[np.isfinite(part.outer)].min() > 2.0
