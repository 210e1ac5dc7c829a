"""Maps over the rays of the vault: mirror images, medians, distances, and the radii of a phantom."""

import numpy as np
import pytest

from cranio_nb.prior.vault_radii import (
    RADIUS_MM,
    coarse_rays,
    distance_mm,
    interpolate_radius,
    local_median,
    mirror_radii,
    rays_near,
    rays_without_bone,
    vault_rays,
    without_outliers,
)


def test_mirroring_twice_changes_nothing_and_swaps_left_and_right():
    x = vault_rays()[:, 0]
    np.testing.assert_allclose(mirror_radii(x), -x, atol=1e-12)
    np.testing.assert_array_equal(mirror_radii(mirror_radii(x)), x)


def test_distances_are_chords(hole):
    one = np.zeros(len(vault_rays()), bool)
    one[100] = True
    chord = RADIUS_MM * np.linalg.norm(vault_rays() - vault_rays()[100], axis=1)
    np.testing.assert_allclose(distance_mm(one), chord, atol=1e-9)
    np.testing.assert_array_equal(rays_near(one, 10.0), chord <= 10.0)
    assert np.isinf(distance_mm(np.zeros(len(one), bool))).all()
    assert (distance_mm(hole)[hole] == 0).all()


def test_a_hole_is_open_and_a_suture_is_not(hole):
    radii = np.full((2, len(hole)), 80.0)
    radii[:, hole] = np.nan
    suture = np.abs(vault_rays()[:, 1] + 0.5) < 0.01
    radii[:, suture] = np.nan
    found = rays_without_bone(radii)
    assert found[hole & (distance_mm(~hole) > 6)].all() and not found[suture & ~rays_near(hole, 6)].any()


def test_an_outlier_is_left_out_and_the_median_does_not_follow_it():
    radii = np.full((2, len(vault_rays())), 80.0)
    radii[0, 50] = 90.0
    kept = without_outliers(radii, local_median(radii))
    assert np.argwhere(np.isnan(kept)).tolist() == [[0, 50]]
    np.testing.assert_array_equal(local_median(radii), 80.0)


def test_the_radius_of_an_ellipsoid_is_interpolated():
    points = vault_rays() * (80 + 5 * vault_rays()[:, [2]])
    np.testing.assert_allclose(interpolate_radius(points * 1.0), 80 + 5 * vault_rays()[:, 2], atol=0.05)


@pytest.mark.parametrize("halvings", [3, 4])
def test_coarser_rays_are_a_quarter_at_each_step(halvings):
    share = coarse_rays(halvings).mean()
    assert share == pytest.approx(0.25 ** (5 - halvings), rel=0.05)
