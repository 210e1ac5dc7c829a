"""The method made of two sheets."""

import numpy as np

from cranio_nb.methods.design import design
from cranio_nb.methods.dnurbs import method as dnurbs
from cranio_nb.vault.ray_grid import RadiusMap, RayGrid


def test_a_sheet_on_a_sphere_needs_no_springs_near_the_hole_to_stay_on_it():
    """The natural shape: the middle of a wide hole in a sphere about another point than the head centre."""
    n, step = 121, np.radians(1.0)
    blank = np.full((n, n), np.nan)
    vault = RadiusMap(RayGrid(np.zeros(3), np.eye(3), step, n), outer=blank, inner=blank, hole=np.zeros((n, n), bool))
    middle, radius = np.array([4.0, -3.0, 6.0]), 80.0
    along = vault.grid.directions @ middle
    outer = along + np.sqrt(along**2 + radius**2 - middle @ middle)
    away = np.hypot(*(np.indices((n, n)) - 60))
    hole = away < 35
    vault = RadiusMap(RayGrid(np.zeros(3), np.eye(3), step, n), outer=outer, inner=outer - 6, hole=hole)
    made = dnurbs.fit(vault, wavelength_mm=20.0, tension_mm2=0.0, span_mm=8.0)
    error = dnurbs.radii_of(made.outer, vault)[hole] - outer[hole]
    assert np.abs(error).max() < 0.02
    tense = dnurbs.fit(vault, wavelength_mm=20.0, tension_mm2=0.0, span_mm=16.0)
    assert np.abs(dnurbs.radii_of(tense.outer, vault)[hole] - outer[hole]).max() < 0.1


def test_free_weights_design_a_prosthesis_and_say_how(skull, openings):
    made = design(
        skull("burr_hole"), openings("burr_hole"), span_mm=20.0, free_weights=True, max_iter=3, method="dnurbs"
    )
    frozen = design(skull("burr_hole"), openings("burr_hole"), span_mm=20.0, method="dnurbs")
    for one, plain in zip(made.record["sheets"], frozen.record["sheets"], strict=True):
        assert 1 <= one["n_iter"] <= 3 and isinstance(one["converged"], bool)
        assert 0 < one["weights"][0] < one["weights"][1] and plain["weights"] == [1.0, 1.0] and plain["n_iter"] == 0
    a, b = made.patch.voxels, frozen.patch.voxels
    assert 2 * (a & b).sum() / (a.sum() + b.sum()) > 0.9
