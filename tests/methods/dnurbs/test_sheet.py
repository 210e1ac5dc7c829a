"""The rational sheet and its energy: planes, spheres, and integrals in closed form."""

import numpy as np
import pytest
from sheets import SHAPE, SPANS, greville, plane

from cranio_nb.methods.dnurbs import sheet
from cranio_nb.methods.dnurbs.sheet import Material, Sheet, Springs


def test_the_basis_is_a_partition_of_unity_and_its_derivatives_sum_to_nothing(places):
    for derivative, wanted in ((0, 1.0), (1, 0.0), (2, 0.0)):
        sums = sheet.basis(np.append(places[0], [0, SPANS[0]]), SPANS[0], derivative).sum(axis=1)
        np.testing.assert_allclose(sums, wanted, atol=1e-12)


def test_derivatives_of_the_basis_are_those_of_finite_differences(places):
    x, step = np.clip(places[0], 0.01, SPANS[0] - 0.01), 1e-5
    for d in (1, 2):
        ahead, behind = (sheet.basis(x + s, SPANS[0], d - 1) for s in (step, -step))
        np.testing.assert_allclose(
            (ahead - behind).toarray() / (2 * step), sheet.basis(x, SPANS[0], d).toarray(), atol=1e-6
        )


def test_a_plane_is_a_plane(places):
    v, u = places
    np.testing.assert_allclose(plane().at(v, u), np.column_stack([2 * v, 3 * u, v - u + 1]), atol=1e-12)


def test_weights_that_are_all_alike_do_not_show(wild, places):
    alike = Sheet(wild.control, np.full(SHAPE, 3.7))
    np.testing.assert_allclose(alike.at(*places), Sheet(wild.control, np.ones(SHAPE)).at(*places), atol=1e-12)


def test_weights_make_a_sphere():
    """A quarter circle turned about an axis by a quarter: an eighth of a sphere, to rounding."""
    arc = np.array([[1.0, 0], [1, 1], [0, 1]])
    weight = np.array([1, np.sqrt(0.5), 1])
    lift = np.array([[1, 0, 0], [1 / 3, 2 / 3, 0], [0, 2 / 3, 1 / 3], [0, 0, 1]])  # degree 2 to degree 3
    w = lift @ weight
    points = (lift @ (arc * weight[:, None])) / w[:, None]
    control = np.stack(
        [
            points[:, None, 0] * points[None, :, 0],
            points[:, None, 0] * points[None, :, 1],
            np.broadcast_to(points[:, None, 1], (4, 4)),
        ],
        axis=-1,
    )
    v, u = np.random.default_rng(1).random((2, 50))
    on_it = Sheet(control, np.outer(w, w)).at(v, u)
    np.testing.assert_allclose(np.linalg.norm(on_it, axis=1), 1, atol=1e-14)
    assert np.ptp(np.linalg.norm(Sheet(control, np.ones((4, 4))).at(v, u), axis=1)) > 0.01  # not without weights


def test_the_stiffness_is_symmetric_and_knows_what_costs_nothing():
    """Tension leaves constants alone; bending also planes; the twist v u costs b12 only."""
    v, u = (part.ravel() for part in np.meshgrid(*(greville(n) for n in SPANS), indexing="ij"))
    free = {"tension": (1.0, 1.0, 0, 0, 0), "bending": (0, 0, 1.0, 2.0, 1.0), "no twist": (0, 0, 1.0, 0, 1.0)}
    for name, wanted in (("tension", 1), ("bending", 3), ("no twist", 4)):
        k = sheet.stiffness(SPANS, Material(free[name])).toarray()
        np.testing.assert_allclose(k, k.T, atol=1e-12)
        values = np.linalg.eigvalsh(k)
        assert values[0] > -1e-9 and (values < 1e-9).sum() == wanted
    k = sheet.stiffness(SPANS, Material(free["bending"]))
    for shape in (np.ones_like(v), v, u):
        np.testing.assert_allclose(k @ shape, 0, atol=1e-11)
    twist = v * u
    assert twist @ (k @ twist) == pytest.approx(2.0 * SPANS[0] * SPANS[1])


def test_the_bending_energy_of_a_bicubic_is_its_integral():
    """s = v^2 u over [0, 5] x [0, 4]: int (2 u)^2 + 2 (2 v)^2."""
    v, u = np.random.default_rng(2).random((2, 400)) * np.array(SPANS)[:, None]
    height = np.column_stack([np.zeros((400, 2)), v**2 * u])
    soft = Material((0, 0, 1e-12, 1e-12, 1e-12))
    made, _ = sheet.settle(Springs(height, v, u, np.ones(400)), sheet.flat(SPANS), soft)
    np.testing.assert_allclose(made.at(v, u), height, atol=1e-6)
    z = made.control[..., 2].ravel()
    energy = z @ (sheet.stiffness(SPANS, Material((0, 0, 1.0, 2.0, 1.0))) @ z)
    assert energy == pytest.approx(4 * 5 * 4**3 / 3 + 8 * 4 * 5**3 / 3, rel=1e-5)


def test_a_plate_means_the_same_whatever_its_spans():
    """The bending energy of z = x^2 over one plate, in mm, by coarse and by fine spans."""
    energies = []
    for n in (4, 9):
        knots = np.concatenate([np.zeros(3), np.arange(n + 1.0), np.full(3, n)])
        blossom = (knots[1:-3] * knots[2:-2] + knots[2:-2] * knots[3:-1] + knots[1:-3] * knots[3:-1]) / 3
        square = blossom * (36 / n) ** 2
        z = np.repeat(square[:, None], n + 3, axis=1).ravel()
        material = Material.plate(0.0, 1.0, (36 / n, 36 / n))
        energies.append(z @ (sheet.stiffness((n, n), material) @ z))
    assert energies == pytest.approx([4.0 * 36 * 36] * 2)


def test_springs_far_off_are_weakened(rng):
    v, u = rng.uniform(0, SPANS[0], 300), rng.uniform(0, SPANS[1], 300)
    points = plane().at(v, u)
    points[::20, 2] += 8.0
    springs = Springs(points, v, u, np.ones(300))
    made, weakened = sheet.settle(springs, sheet.flat(SPANS), Material((0, 0, 1e-3, 1e-3, 1e-3)), rounds=8)
    assert np.abs(made.at(v, u) - plane().at(v, u)).max() < 0.25
    assert weakened.strength[::20].max() < 0.05 and np.delete(weakened.strength, np.s_[::20]).min() > 0.5
