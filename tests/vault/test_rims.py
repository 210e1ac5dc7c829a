"""Rims along rays: radius profiles whose fits are exact."""

import numpy as np
import pytest

from cranio_nb.vault.rims import RayProfile, fit_rims, share_tangents

CENTRE = np.array([200.0, 190.0])
STEP = 0.005
ANGLES = np.arange(-240, 241) * STEP
PLANES = 9
EDGE = np.radians(15.0)
GAP = np.tile(np.abs(ANGLES) <= EDGE, (PLANES, 1))


def exact_profile(outer, inner=None, missing=GAP):
    """A profile whose radii are functions of the angle, the same in every slice."""
    radii = np.tile(outer(ANGLES), (PLANES, 1))
    within = radii - 12 if inner is None else np.tile(inner(ANGLES), (PLANES, 1))
    return RayProfile(CENTRE, ANGLES, outer=radii, inner=within, missing=missing)


def polar(points):
    p = points - CENTRE
    return np.linalg.norm(p, axis=-1), np.arctan2(p[..., 1], -p[..., 0])


def degrees_between(a, b):
    return np.degrees(np.arccos(np.clip((a * b).sum(axis=-1), -1, 1)))


def test_the_gap_is_the_first_and_last_missing_ray():
    missing = GAP.copy()
    missing[2] = False
    missing[3] = False
    missing[3, 7] = True
    gap = exact_profile(lambda a: 170 + 0 * a, missing=missing).gap
    first, last = np.flatnonzero(GAP[0])[[0, -1]]
    np.testing.assert_array_equal(gap[[0, 2, 3]], [[first, last], [-1, -1], [7, 7]])


def test_points_lie_on_the_circle_and_tangents_along_it():
    skip, reach = 4.0, 24.0
    for order in (1, 2):
        rims = fit_rims(exact_profile(lambda a: 172 + 0 * a), skip_mm=skip, reach_mm=reach, order=order)
        radius, angle = polar(rims.points)
        np.testing.assert_allclose(radius[:, 0], 172, atol=1e-5)
        np.testing.assert_allclose(radius[:, 1], 160, atol=1e-5)
        for boundary, r in enumerate((172, 160)):
            np.testing.assert_allclose(np.abs(angle[:, boundary]), EDGE + skip / r, atol=1.5 * STEP)
        np.testing.assert_array_equal(np.sign(angle[0]), [[-1, 1], [-1, 1]])
        onward = np.stack([np.sin(angle), np.cos(angle)], axis=-1) * -np.sign(angle)[..., None]
        np.testing.assert_allclose(rims.tangents, onward, atol=1e-6)


@pytest.mark.parametrize(
    ("order", "radius", "slope"),
    [
        (1, lambda a: 170 + 0 * a, lambda a: 0 * a),
        (1, lambda a: 170 + 9 * a, lambda a: 9 + 0 * a),
        (2, lambda a: 170 + 9 * a - 30 * a**2, lambda a: 9 - 60 * a),
    ],
    ids=["arc", "linear", "bent"],
)
def test_radii_of_the_fitted_order_are_carried_exactly(order, radius, slope):
    rims = fit_rims(exact_profile(radius), skip_mm=4, reach_mm=24, order=order)
    found, angle = polar(rims.points[:, 0])
    np.testing.assert_allclose(found, radius(angle), atol=1e-4)
    up, onward = (np.stack(v, axis=-1) for v in ((-np.cos(angle), np.sin(angle)), (np.sin(angle), np.cos(angle))))
    wanted = slope(angle)[..., None] * up + radius(angle)[..., None] * onward
    wanted *= -np.sign(angle)[..., None] / np.linalg.norm(wanted, axis=-1, keepdims=True)
    np.testing.assert_allclose(rims.tangents[:, 0], wanted, atol=1e-5)


def test_a_first_order_fit_lags_behind_a_bend_and_a_second_order_fit_does_not():
    profile = exact_profile(lambda a: 170 - 30 * a**2)
    _, at = polar(fit_rims(profile, skip_mm=4, reach_mm=24).points[0, 0])
    first, second = (fit_rims(profile, skip_mm=4, reach_mm=24, order=o).tangents[0, 0] for o in (1, 2))
    swing = np.degrees(np.arccos((first * second).sum(axis=-1)))
    lag = 60 * (24 / 170) / 2  # slope changes by 60 per radian, the middle lies reach / 2 away
    np.testing.assert_allclose(swing, np.degrees(lag / 170), rtol=0.15)
    assert (np.abs(at) > EDGE).all()


def test_noise_and_scattered_outliers_do_not_move_the_fit():
    rng = np.random.default_rng(4)
    profile = exact_profile(lambda a: 170 + 0 * a)
    outer = profile.outer + rng.normal(0, 0.3, profile.outer.shape)
    outer[:, ::7] += 9.0  # sutures, screws: 14 % of the rays
    noisy_profile = RayProfile(CENTRE, ANGLES, outer=outer, inner=profile.inner, missing=GAP)
    clean, noisy = (fit_rims(p, skip_mm=4, reach_mm=40, order=1) for p in (profile, noisy_profile))
    assert np.linalg.norm(noisy.points - clean.points, axis=-1).max() < 0.5
    assert degrees_between(noisy.tangents, clean.tangents).max() < 1.5


def test_a_rim_with_bone_for_fewer_than_half_of_its_points_is_unknown():
    profile = exact_profile(lambda a: 170 + 0 * a)
    for share, known in ((0.6, True), (0.4, False)):
        outer = profile.outer.copy()
        outer[:, ANGLES < -EDGE - (4 + share * 24) / 170] = np.nan
        rims = fit_rims(
            RayProfile(CENTRE, ANGLES, outer=outer, inner=profile.inner, missing=GAP), skip_mm=4, reach_mm=24
        )
        assert np.isfinite(rims.points[:, 0, 0]).all() == known
        assert np.isfinite(rims.points[:, 0, 1]).all() and np.isfinite(rims.points[:, 1]).all()


def test_a_rim_at_the_edge_of_what_was_looked_at_is_unknown():
    missing = GAP | (ANGLES < 0)
    rims = fit_rims(exact_profile(lambda a: 170 + 0 * a, missing=missing), skip_mm=4, reach_mm=24)
    assert np.isnan(rims.points[:, :, 0]).all() and np.isfinite(rims.points[:, :, 1]).all()


def test_a_slice_without_a_gap_has_no_rims():
    missing = GAP.copy()
    missing[3] = False
    rims = fit_rims(exact_profile(lambda a: 170 + 0 * a, missing=missing), skip_mm=4, reach_mm=24)
    assert np.isnan(rims.points[3]).all() and np.isnan(rims.tangents[3]).all()
    assert np.isfinite(np.delete(rims.points, 3, axis=0)).all()


def test_a_mirrored_profile_gives_mirrored_rims():
    def bent(a):
        return 170 + 9 * a - 30 * a**2 + 4 * a**3

    one, other = (fit_rims(exact_profile(f), skip_mm=4, reach_mm=24) for f in (bent, lambda a: bent(-a)))
    for a, b in ((one.points - CENTRE, other.points - CENTRE), (one.tangents, other.tangents)):
        np.testing.assert_allclose(b[:, :, ::-1] * [1, -1], a, atol=1e-9)


def test_scale_is_only_a_unit():
    one = fit_rims(exact_profile(lambda a: 170 - 30 * a**2), skip_mm=4, reach_mm=24)
    big = exact_profile(lambda a: 340 - 60 * a**2, inner=lambda a: 340 - 24 - 60 * a**2)
    double = fit_rims(big, skip_mm=8, reach_mm=48)
    np.testing.assert_allclose(double.points - CENTRE, 2 * (one.points - CENTRE), atol=1e-6)
    np.testing.assert_allclose(double.tangents, one.tangents, atol=1e-9)


def units(angles):
    return np.stack([np.cos(angles), np.sin(angles)], axis=-1)


def test_shared_tangents_stay_unit_vectors_and_unknown_ones_unknown():
    tangents = units(np.random.default_rng(0).normal(0, 0.3, (30, 2, 2)))
    tangents[[4, 5, 20]] = np.nan
    shared = share_tangents(tangents, 3.0)
    np.testing.assert_array_equal(np.isnan(shared), np.isnan(tangents))
    np.testing.assert_allclose(np.linalg.norm(np.delete(shared, [4, 5, 20], axis=0), axis=-1), 1, atol=1e-12)


def test_sharing_keeps_what_all_agree_on_also_beside_unknown_slices():
    tangents = np.tile(units(np.array([0.4, 2.0])), (30, 1, 1))
    tangents[[0, 7, 8]] = np.nan
    np.testing.assert_allclose(share_tangents(tangents, 3.0), tangents, atol=1e-12)


def test_sharing_calms_an_outlier_and_0_leaves_all_as_it_is():
    angles = np.zeros(31)
    angles[15] = 0.8
    tangents = units(angles)
    np.testing.assert_array_equal(share_tangents(tangents, 0.0), tangents)
    shared = share_tangents(tangents, 2.0)
    left = np.arctan2(shared[:, 1], shared[:, 0])
    assert abs(left[15]) < 0.8 * 0.25 and left.max() == left[15]
    np.testing.assert_allclose(left, left[::-1], atol=1e-12)
    assert tangents[15, 1] == np.sin(0.8)  # the input is as it was
