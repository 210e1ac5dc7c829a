"""Defects of every name: planned for any seed, and cut where they say."""

import numpy as np
import pytest

from data_synth import DEFECTS, phantom_case
from data_synth.defect import plan_cutters


def test_every_defect_opens_or_thins_the_skull_where_it_says():
    for defect in ("frontal", "occipital", "vertex", "multiple", "partial"):
        case, specs = phantom_case("tiny", defect, 5), DEFECTS[defect]
        assert len(case.head.cutters) == len(specs)
        for cutter in case.head.cutters:
            d = cutter.axes[2]
            p = d * (case.head.outer_radius(d) - 0.5 * cutter.depth * case.head.bone_thickness(d))
            at = np.linalg.solve(case.affine[:3, :3], p + case.head.centre - case.affine[:3, 3])
            assert case.implant[tuple(at.round().astype(int))], defect


@pytest.mark.parametrize("defect", DEFECTS)
def test_every_defect_can_be_planned_for_any_seed(defect):
    for seed in range(50):
        for cutter in plan_cutters(defect, np.random.default_rng(seed), lambda d: 75.0):
            np.testing.assert_allclose(cutter.axes @ cutter.axes.T, np.eye(3), atol=1e-12)
            assert np.linalg.det(cutter.axes) == pytest.approx(1)
            assert cutter.distance(cutter.axes[2] * 75.0, 69.0, 75.0) > 0
            assert cutter.distance(cutter.axes[2] * -75.0, 69.0, 75.0) < 0
