"""Fans of slices across a hole in a hollow ball: every slice is a circle, so all curves are known."""

import numpy as np
import pytest
from hollow_ball import CENTRE, INNER, OUTER, STEP, ball

from cranio_nb.methods.slicewise import fanned
from cranio_nb.methods.slicewise.slices import Settings, SliceResult
from cranio_nb.vault.rims import RayProfile

SETTINGS = Settings(n_snaxels=41, pressure=None, tension=1.0, rigidity=1.0, dt=1.0, tol=1e-3, max_iter=2000)
ANGLES = np.arange(-240, 241) * 0.005
RADII = (170.0, 158.0)


def circle_profile(half_gaps):
    """Slices of concentric circles; each lacks bone within an angle, radians, of angle 0."""
    missing = np.abs(ANGLES) <= np.asarray(half_gaps)[:, None]
    outer, inner = (np.where(missing, np.nan, radius) for radius in RADII)
    return RayProfile(np.zeros(2), ANGLES, outer=outer, inner=inner, missing=missing)


def arc(plane, half_angle, turns=0.0):
    """A slice whose curves are the arcs of both circles, its rims bending by `turns` radians."""
    at = np.linspace(-half_angle, half_angle, 81)
    curves = np.stack([radius * np.column_stack([-np.cos(at), np.sin(at)]) for radius in RADII])
    return SliceResult(plane, "balloon", curves=curves, turns_rad=np.full((2, 2), turns))


def test_ends_lie_on_the_circles_and_tangents_along_them():
    (made,) = fanned.by_rays(circle_profile([0.3]), skip_mm=2.0, reach_mm=20.0, coupling_mm=0.0)
    assert (made.plane, made.status) == (0, "balloon")
    for ends, radius in zip(made.ends, RADII, strict=True):
        np.testing.assert_allclose(np.linalg.norm(ends.points, axis=1), radius, atol=1e-6)
        np.testing.assert_allclose((ends.points * ends.tangents).sum(axis=1), 0, atol=1e-6 * radius)
        assert ends.tangents[0] @ (ends.points[1] - ends.points[0]) > 0  # into the gap
    np.testing.assert_allclose(made.turns_rad, 0, atol=1e-6)


def test_only_slices_that_cross_the_hole_are_listed_and_those_without_bone_skipped():
    half_gaps = [-1.0, 0.3, 1.15, -1.0, 0.2]  # no gap, a gap, nearly no bone beside it
    made = fanned.by_rays(circle_profile(half_gaps), skip_mm=2.0, reach_mm=20.0, coupling_mm=0.0)
    assert [(s.plane, s.status) for s in made] == [(1, "balloon"), (2, "skipped"), (4, "balloon")]


def test_the_mean_of_directions_heeds_weights_and_leaves_out_what_is_unknown():
    values = np.array([[1.0, 2.0, np.nan, np.nan], [3.0, np.nan, 5.0, np.nan]])
    weights = np.array([[1.0, 1.0, 9.0, 1.0], [3.0, 7.0, 2.0, 0.0]])
    np.testing.assert_allclose(fanned._weighted_mean(values, weights), [2.5, 2.0, 5.0, np.nan])


@pytest.mark.parametrize("boundary", [0, 1])
def test_an_arc_has_its_radius_on_every_ray_of_its_gap_and_none_beside_it(boundary):
    profile = circle_profile([0.3, 0.3])
    radius, weight = fanned._on_rays([arc(0, 0.3)], boundary, profile)
    inside = np.abs(ANGLES) < 0.3
    np.testing.assert_allclose(radius[0, inside], RADII[boundary], atol=0.01)  # chords between 81 points
    assert np.isnan(radius[0, np.abs(ANGLES) > 0.31]).all()
    assert np.isnan(radius[1]).all() and not weight[1].any()


def test_a_place_is_the_surer_the_nearer_its_rim_the_shorter_its_slice_and_the_straighter_its_bone():
    profile = circle_profile([0.3, 0.15, 0.3])
    _, weight = fanned._on_rays([arc(0, 0.3), arc(1, 0.15), arc(2, 0.3, turns=0.2)], 0, profile)
    middle = len(ANGLES) // 2
    across = weight[0, np.abs(ANGLES) < 0.299]
    np.testing.assert_allclose(across, across[::-1], rtol=1e-6)
    assert (np.diff(across[: len(across) // 2]) < 0).all()  # falls from the rim to the middle
    assert weight[1, middle] > weight[0, middle] > weight[2, middle]
    # both tangents wrong by e move the middle of a cubic by L / 8 each: variance 2 (e L / 8)^2, and the ends' own
    length = 2 * RADII[0] * np.sin(0.3)
    wanted = 2 * (fanned._TANGENT_ERROR * length / 8) ** 2 + fanned._POINT_ERROR**2
    assert weight[0, middle] == pytest.approx(1 / wanted, rel=1e-3)


def test_a_hole_in_a_hollow_ball_is_filled_and_the_better_the_more_directions():
    bone, opening = ball(np.array([0.9, 0.35, 0.4]))
    radius = np.linalg.norm(bone.to_world(np.moveaxis(np.indices(bone.shape), 0, -1)) - CENTRE, axis=-1)
    missing = (radius >= INNER) & (radius <= OUTER) & ~bone.voxels
    lengths = {"skip_mm": 1.5, "reach_mm": 10.0, "coupling_mm": 4.0}
    dice = []
    for n in (1, 3):
        made, patch = fanned.bridge(bone, opening, directions=n, settings=SETTINGS, **lengths)
        assert len(made) == n and not (patch & bone.voxels).any()
        dice.append(2 * (patch & missing).sum() / (patch.sum() + missing.sum()))
    assert dice[0] > 0.93 and dice[1] > 0.96
    assert INNER - STEP < radius[patch].min() and radius[patch].max() < OUTER + STEP  # of three directions
