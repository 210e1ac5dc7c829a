"""The conditional mean: it obeys the known bone, and predicts what it was given best."""

import numpy as np

from cranio_nb.prior.mean_frame import mirror_index
from cranio_nb.prior.shape_prior import Prior, conditional_mean
from cranio_nb.prior.vault_radii import distance_mm, mirror_radii, vault_rays


def masked(radii, unknown):
    return np.where(unknown, np.nan, radii.astype(float))


def test_known_bone_is_reproduced(learned, hole, intact):
    truth = learned.radii[0]
    given = conditional_mean(learned.subset([1, 2, 3]), masked(truth, hole), np.ones(len(hole), bool))
    beside = ~hole & (distance_mm(hole) < 10)
    assert np.abs(given - truth)[:, beside].mean() < 0.25  # the noise of the tiny heads' voxels


def test_a_skull_that_was_seen_is_predicted_better(learned, hole):
    truth = learned.radii[0]
    off = [
        np.abs(conditional_mean(learned.subset(chosen), masked(truth, hole), hole) - truth[:, hole]).mean()
        for chosen in ([1, 2, 3], [0, 1, 2, 3])
    ]
    assert off[1] < 0.6 * off[0]


def test_a_larger_head_is_predicted_larger(learned, hole):
    truth, others = 1.03 * learned.radii[0], learned.subset([1, 2, 3])
    predicted = conditional_mean(others, masked(truth, hole), hole)
    plain = others.samples.mean(axis=0)[:, hole]
    assert np.abs(predicted - truth[:, hole]).mean() < 0.2 * np.abs(plain - truth[:, hole]).mean()


def test_without_known_bone_the_mean_head_is_predicted(learned, hole):
    nothing = np.full(learned.radii.shape[1:], np.nan)
    np.testing.assert_allclose(conditional_mean(learned, nothing, hole), learned.samples.mean(axis=0)[:, hole])


def test_where_all_skulls_agree_the_smooth_kernel_decides(learned, hole):
    alike = Prior(learned.mean, np.repeat(learned.samples.mean(axis=0, keepdims=True), 3, axis=0).astype("f4"))
    swollen = alike.radii[0] + 1.0
    predicted = conditional_mean(alike, masked(swollen, hole), hole) - alike.radii[0][:, hole]
    rim = distance_mm(~hole)[hole] < 6
    assert (predicted > 0.8).all() and predicted[:, rim].mean() > 0.95


def test_the_mirror_image_is_predicted_as_the_mirror_image(learned, hole):
    truth, others = learned.radii[0], learned.subset([1, 2, 3])
    twin = mirror_index(vault_rays())
    plain = np.zeros(truth.shape)
    plain[:, hole] = conditional_mean(others, masked(truth, hole), hole)
    turned = np.zeros(truth.shape)
    turned[:, hole[twin]] = conditional_mean(others, masked(truth, hole)[:, twin], hole[twin])
    np.testing.assert_allclose(mirror_radii(turned), plain, atol=0.01)  # mm: ties between neighbours
