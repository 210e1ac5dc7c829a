"""The phantom's closed forms: volumes, radii and gradients."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth import scan
from data_synth.head import head_shape


@pytest.fixture(scope="module")
def head():
    return head_shape(np.random.default_rng(3), [3.0, -12.0, 41.0])


@pytest.fixture(scope="module")
def directions():
    d = np.random.default_rng(0).standard_normal((2000, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def integrate(function):
    """Integral over all directions, by Gauss-Legendre in z and the midpoint rule around."""
    z, weights = np.polynomial.legendre.leggauss(200)
    turn = (np.arange(400) + 0.5) * 2 * np.pi / 400
    flat = np.sqrt(1 - z**2)[:, None]
    d = np.stack(np.broadcast_arrays(flat * np.cos(turn), flat * np.sin(turn), z[:, None]), axis=-1)
    return float((function(d).sum(1) * weights).sum() * 2 * np.pi / 400)


def test_voxelised_shell_has_the_analytic_volume(head):
    closed = replace(head, foramen=0.0)
    spacing = np.array([1.7, 1.3, 1.3])
    shape = (120, 170, 130)
    affine = np.eye(4)
    affine[:3, :3] = np.fliplr(np.diag(spacing))
    affine[:3, 3] = head.centre - affine[:3, :3] @ [45.2, 82.9, 63.7]
    _, bone, implant = scan(closed, affine, shape)
    truth = integrate(lambda d: (closed.outer_radius(d) ** 3 - closed.inner_radius(d) ** 3) / 3)
    assert not implant.any()
    assert not bone[0].any() and not bone[-1].any()
    assert bone.sum() * spacing.prod() == pytest.approx(truth, rel=2e-3)


def test_the_skull_is_thick_enough_and_never_too_thick(directions):
    for seed in range(20):
        head = head_shape(np.random.default_rng(seed), np.zeros(3))
        thickness = head.outer_radius(directions) - head.inner_radius(directions)
        assert 3.5 < thickness.min() < 6 < thickness.max() < 9.5
        assert np.all(head.skin_radius(directions) > head.outer_radius(directions))


def test_left_and_right_differ_by_a_few_millimetres(head, directions):
    difference = head.outer_radius(directions) - head.outer_radius(directions * [-1, 1, 1])
    assert 1.0 < np.abs(difference).max() < 8.0


def test_gradients_match_finite_differences(head, directions):
    p = directions * 80.0
    step = 1e-5

    def levels(q):
        length = np.linalg.norm(q, axis=-1)
        d = q / length[..., None]
        return length - head.outer_radius(d), length - head.inner_radius(d)

    for surface, gradient in enumerate(head.gradients(p)):
        for axis, unit in enumerate(np.eye(3)):
            difference = (levels(p + step * unit)[surface] - levels(p - step * unit)[surface]) / (2 * step)
            np.testing.assert_allclose(gradient[:, axis], difference, atol=1e-7)


def test_inside_bone_agrees_with_the_radii(head, directions):
    outer, inner = head.outer_radius(directions)[:, None], head.inner_radius(directions)[:, None]
    away = head.foramen_distance(directions) < 0
    assert head.inside_bone(directions * (outer - 1e-6))[away].all()
    assert head.inside_bone(directions * (inner + 1e-6))[away].all()
    assert not head.inside_bone(directions * (outer + 1e-6)).any()
    assert not head.inside_bone(directions * (inner - 1e-6)).any()
    assert not head.inside_bone(directions * outer * 0.999)[~away].any()
