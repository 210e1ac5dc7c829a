"""Features along rays: drawn rings with known gaps, and radius profiles whose fits are exact."""

import numpy as np
import pytest

from cranio_nb.rays import RayProfile, find_gaps, fit_rims, look, share_tangents

CENTRE = np.array([200.0, 200.0])
INNER, OUTER, HALF_GAP = 160.0, 172.0, 15.0
LARGE = {"centre": CENTRE, "shape": (401, 401)}
PX, APART, STEP = 0.5, 1.0, 0.005
ANGLES = np.arange(-1.2, 1.2, STEP)
PLANES = 9
EDGE = np.radians(HALF_GAP)


@pytest.fixture(scope="module")
def stack(ring):
    """Nine equal slices of a ring with a gap of 30 degrees, and the sheet across it."""
    bone = ring(INNER, OUTER, half_gap=HALF_GAP, **LARGE)
    sheet = ring(INNER, OUTER, **LARGE) & ~bone
    return np.stack([bone] * PLANES), np.stack([sheet] * PLANES)


def gaps_of(slices, opening):
    profile = look(slices, CENTRE, ANGLES, px=PX)
    return profile, find_gaps(profile, opening, px=PX, apart=APART)


def exact_profile(outer, inner=None):
    """A profile whose radii are functions of the angle, the same in every slice."""
    radii = np.tile(outer(ANGLES), (PLANES, 1))
    return RayProfile(CENTRE, ANGLES, radii - 12 if inner is None else np.tile(inner(ANGLES), (PLANES, 1)), radii)


def polar(points):
    p = points - CENTRE
    return np.linalg.norm(p, axis=-1), np.arctan2(p[..., 1], -p[..., 0])


EXACT_GAP = np.tile([np.searchsorted(ANGLES, -EDGE), np.searchsorted(ANGLES, EDGE)], (PLANES, 1))


def test_radii_of_a_ring(stack):
    profile = look(stack[0], CENTRE, ANGLES, px=PX)
    there = np.abs(ANGLES) > EDGE + 2 * STEP
    np.testing.assert_allclose(profile.outer[:, there], OUTER, atol=1.0)
    np.testing.assert_allclose(profile.inner[:, there], INNER, atol=1.0)
    assert abs(np.mean(profile.outer[:, there]) - OUTER) < 0.3
    assert abs(np.mean(profile.inner[:, there]) - INNER) < 0.3
    away = np.abs(ANGLES) < EDGE - 2 * STEP
    assert np.isnan(profile.outer[:, away]).all() and np.isnan(profile.inner[:, away]).all()


def test_angle_0_points_up_the_slice_and_grows_towards_the_columns():
    image = np.zeros((1, 101, 101), bool)
    image[0, 45:56, 85:90] = True  # beside the centre, towards the columns
    profile = look(image, np.array([50.0, 50.0]), np.radians([0.0, 90, 180, -90]), px=1.0)
    np.testing.assert_array_equal(np.isfinite(profile.outer[0]), [False, True, False, False])
    assert profile.inner[0, 1] == pytest.approx(34.5, abs=0.5) and profile.outer[0, 1] == pytest.approx(39.5, abs=0.5)


def test_a_thin_break_along_a_ray_is_diploe_and_a_wide_one_is_not(ring):
    for width, whole in ((5, True), (8, False)):  # 2.5 mm and 4 mm
        spongy = ring(140, OUTER, **LARGE) & ~ring(150, 150 + width, **LARGE)
        inner = look(spongy[None], CENTRE, ANGLES, px=PX).inner
        assert np.median(inner) == pytest.approx(140 if whole else 150 + width, abs=1.5)


def test_the_gap_is_found_to_one_ray(stack):
    profile, gap = gaps_of(*stack)
    first, last = ANGLES[gap[:, 0]], ANGLES[gap[:, 1]]
    np.testing.assert_allclose(first, -EDGE, atol=1.5 * STEP)
    np.testing.assert_allclose(last, EDGE, atol=1.5 * STEP)
    assert np.isnan(profile.outer[0, gap[0, 0] + 1 : gap[0, 1]]).all()


def test_a_slice_without_a_gap_has_none(stack, ring):
    bone, opening = stack[0].copy(), stack[1].copy()
    bone[0], opening[0] = ring(INNER, OUTER, **LARGE), False
    bone[1], opening[1] = False, False
    _, gap = gaps_of(bone, opening)
    np.testing.assert_array_equal(gap[0], -1)
    assert (gap[2:] >= 0).all()


def test_a_gap_that_the_opening_does_not_cross_is_another_ones(stack, ring):
    second = np.stack([ring(INNER, OUTER, half_gap=6, towards=45, **LARGE)] * PLANES)
    _, alone = gaps_of(*stack)
    _, both = gaps_of(stack[0] & second, stack[1])
    np.testing.assert_array_equal(both, alone)


def test_a_bevelled_rim_belongs_to_the_gap_up_to_85_percent_of_the_thickness():
    """The bevel runs over 5 degrees: bone grows from nothing to its full thickness."""
    row, col = np.indices(LARGE["shape"], dtype=float)
    radius = np.hypot(row - 200, col - 200)
    off = np.abs(np.degrees(np.arctan2(col - 200, 200 - row)))
    share = (radius - INNER) / (OUTER - INNER)
    bone = (share >= 0) & (share <= 1) & (off >= HALF_GAP + 5 * share)
    sheet = (share >= 0) & (share <= 1) & (off < HALF_GAP)
    _, gap = gaps_of(np.stack([bone] * PLANES), np.stack([sheet] * PLANES))
    wanted = np.radians(HALF_GAP + 0.85 * 5)
    # a twelfth of the thickness, one pixel, is 0.4 degrees of bevel
    np.testing.assert_allclose(np.abs(ANGLES[gap]), wanted, atol=np.radians(0.6))


def test_a_slice_of_partial_loss_beside_the_hole_belongs_to_the_gap(stack, ring):
    """The paper's Fig. 6: the slice next to the hole keeps its inner table, and has no hole of its own."""
    bone, opening = stack[0].copy(), stack[1].copy()
    bone[-1] = ring(INNER, OUTER, half_gap=HALF_GAP, **LARGE) | ring(INNER, INNER + 4, **LARGE)
    opening[-1] = False
    _, gap = gaps_of(bone, opening)
    np.testing.assert_allclose(np.abs(ANGLES[gap[-1]]), EDGE, atol=2 * STEP)


def test_points_lie_on_the_circle_and_tangents_along_it(stack):
    profile, gap = gaps_of(*stack)
    skip, reach = 4.0, 24.0
    rims = fit_rims(profile, gap, skip=skip, reach=reach)
    radius, angle = polar(rims.points)
    np.testing.assert_allclose(radius[:, 0], OUTER, atol=0.4)
    np.testing.assert_allclose(radius[:, 1], INNER, atol=0.4)
    for boundary, r in enumerate((OUTER, INNER)):
        np.testing.assert_allclose(np.abs(angle[:, boundary]), EDGE + skip / r, atol=2.5 * STEP)
    onward = np.stack([np.sin(angle), np.cos(angle)], axis=-1) * -np.sign(angle)[..., None]
    cosine = (rims.tangents * onward).sum(axis=-1)
    order_1 = fit_rims(profile, gap, skip=skip, reach=reach, order=1).tangents
    assert np.degrees(np.arccos(np.clip((order_1 * onward).sum(axis=-1), -1, 1))).max() < 1.0
    assert np.degrees(np.arccos(np.clip(cosine, -1, 1))).max() < 2.0  # pixels of a ring are its only noise


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
    rims = fit_rims(exact_profile(radius), EXACT_GAP, skip=4, reach=24, order=order)
    found, angle = polar(rims.points[:, 0])
    np.testing.assert_allclose(found, radius(angle), atol=1e-4)
    up, onward = (np.stack(v, axis=-1) for v in ((-np.cos(angle), np.sin(angle)), (np.sin(angle), np.cos(angle))))
    wanted = slope(angle)[..., None] * up + radius(angle)[..., None] * onward
    wanted *= -np.sign(angle)[..., None] / np.linalg.norm(wanted, axis=-1, keepdims=True)
    np.testing.assert_allclose(rims.tangents[:, 0], wanted, atol=1e-5)


def test_a_first_order_fit_lags_behind_a_bend_and_a_second_order_fit_does_not():
    profile = exact_profile(lambda a: 170 - 30 * a**2)
    _, at = polar(fit_rims(profile, EXACT_GAP, skip=4, reach=24).points[0, 0])
    first, second = (fit_rims(profile, EXACT_GAP, skip=4, reach=24, order=o).tangents[0, 0] for o in (1, 2))
    swing = np.degrees(np.arccos((first * second).sum(axis=-1)))
    lag = 60 * (24 / 170) / 2  # slope changes by 60 per radian, the middle lies reach / 2 away
    np.testing.assert_allclose(swing, np.degrees(lag / 170), rtol=0.15)
    assert (np.abs(at) > EDGE).all()


def test_noise_and_scattered_outliers_do_not_move_the_fit():
    rng = np.random.default_rng(4)
    profile = exact_profile(lambda a: 170 + 0 * a)
    outer = profile.outer + rng.normal(0, 0.3, profile.outer.shape)
    outer[:, ::7] += 9.0  # sutures, screws: 14 % of the rays
    clean = fit_rims(profile, EXACT_GAP, skip=4, reach=40, order=1)
    noisy = fit_rims(RayProfile(CENTRE, ANGLES, profile.inner, outer), EXACT_GAP, skip=4, reach=40, order=1)
    assert np.linalg.norm(noisy.points - clean.points, axis=-1).max() < 0.5
    turn = (noisy.tangents * clean.tangents).sum(axis=-1)
    assert np.degrees(np.arccos(np.clip(turn, -1, 1))).max() < 1.5


def test_a_rim_with_bone_for_fewer_than_half_of_its_points_is_unknown():
    profile = exact_profile(lambda a: 170 + 0 * a)
    for reach_left, known in ((0.6, True), (0.4, False)):
        outer = profile.outer.copy()
        outer[:, ANGLES < -EDGE - (4 + reach_left * 24) / 170] = np.nan
        rims = fit_rims(RayProfile(CENTRE, ANGLES, profile.inner, outer), EXACT_GAP, skip=4, reach=24)
        assert np.isfinite(rims.points[:, 0, 0]).all() == known
        assert np.isfinite(rims.points[:, 0, 1]).all() and np.isfinite(rims.points[:, 1]).all()


def test_a_slice_without_a_gap_has_no_rims(stack):
    profile = look(stack[0], CENTRE, ANGLES, px=PX)
    gap = EXACT_GAP.copy()
    gap[3] = -1
    rims = fit_rims(profile, gap, skip=4, reach=24)
    assert np.isnan(rims.points[3]).all() and np.isnan(rims.tangents[3]).all()
    assert np.isfinite(np.delete(rims.points, 3, axis=0)).all()


def test_mirrored_slices_give_mirrored_rims(stack):
    symmetric = np.linspace(-1.2, 1.2, 481)
    rims = []
    for slices, opening in (stack, tuple(s[:, :, ::-1] for s in stack)):
        profile = look(slices, CENTRE, symmetric, px=PX)
        gap = find_gaps(profile, opening, px=PX, apart=APART)
        rims.append(fit_rims(profile, gap, skip=4, reach=24))
    mirrored = rims[1].points[:, :, ::-1]
    np.testing.assert_allclose(mirrored[..., 0], rims[0].points[..., 0], atol=1e-6)
    np.testing.assert_allclose(400 - mirrored[..., 1], rims[0].points[..., 1], atol=1e-6)


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
