"""The rational sheet, its energy and its motion, and the method made of two of them."""

import numpy as np
import pytest
from scipy import sparse

from cranio_nb.methods.design import design
from cranio_nb.methods.dnurbs import method as dnurbs
from cranio_nb.methods.dnurbs.method import sheet, sheet_motion
from cranio_nb.methods.dnurbs.sheet import Material, Sheet, Springs
from cranio_nb.methods.dnurbs.sheet_motion import Dynamics, Setting
from cranio_nb.vault.ray_grid import RadiusMap, RayGrid

SPANS = (5, 4)
SHAPE = (8, 7)
MATERIAL = Material((0.1, 0.2, 0.3, 0.4, 0.5))


@pytest.fixture
def rng():
    return np.random.default_rng(7)


@pytest.fixture
def places(rng):
    return rng.uniform(0, SPANS[0], 40), rng.uniform(0, SPANS[1], 40)


@pytest.fixture
def wild(rng):
    return Sheet(rng.normal(size=(*SHAPE, 3)), rng.uniform(0.5, 2, SHAPE))


@pytest.fixture
def setting(rng, places):
    springs = Springs(rng.normal(size=(40, 3)), *places, rng.uniform(0.5, 2, 40))
    return Setting(springs, Sheet(rng.normal(size=(*SHAPE, 3)), np.ones(SHAPE)), MATERIAL)


def greville(spans):
    """Parameters whose own coefficients make s(x) = x."""
    knots = np.concatenate([np.zeros(3), np.arange(spans + 1.0), np.full(3, spans)])
    return (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3


def plane():
    v, u = np.meshgrid(*(greville(n) for n in SPANS), indexing="ij")
    return Sheet(np.stack([2 * v, 3 * u, v - u + 1], axis=-1), np.ones(SHAPE))


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


def test_the_kronecker_stiffness_is_the_one_of_gauss_points(setting):
    """The fast path and the general one agree on K where weights are 1."""
    loose = Springs(np.zeros((1, 3)), np.ones(1), np.ones(1), np.zeros(1))
    soft = Setting(loose, setting.natural, MATERIAL)
    _, elastic, _ = sheet_motion._forces(setting.natural, soft, Dynamics())
    wanted = sparse.block_diag([sheet.stiffness(SPANS, MATERIAL)] * 3)
    assert abs(elastic - wanted).max() < 1e-11


def test_s_is_j_q_and_j_is_the_derivative_by_q(wild, places):
    q = sheet_motion._coordinates(wild, True)
    found = sheet_motion.jacobians(wild, *places, True)
    shape = sheet_motion.derivatives(wild, *places)
    np.testing.assert_allclose(shape[sheet.VALUE], wild.at(*places), atol=1e-13)
    for d, part in found.items():
        np.testing.assert_allclose(part @ q, shape[d].T.ravel(), atol=1e-11)
        for i in (0, 100, 170, 200):
            ahead, behind = (
                sheet_motion.derivatives(sheet_motion._with_coordinates(wild, q + s * np.eye(len(q))[i], True), *places)
                for s in (1e-6, -1e-6)
            )
            slope = (ahead[d] - behind[d]).T.ravel() / 2e-6
            np.testing.assert_allclose(part[:, [i]].toarray().ravel(), slope, atol=1e-6)


@pytest.mark.parametrize("mass", [0.0, 3.0])
def test_a_frozen_sheet_comes_to_rest_where_one_solve_puts_it(wild, setting, mass):
    dynamics = Dynamics(mass=mass)
    energies = []
    still = sheet_motion.start(Sheet(wild.control, np.ones(SHAPE)), setting, dynamics)
    end = sheet_motion.relax(
        still, setting, dynamics, tol=1e-10, max_iter=2000, iter_callback=lambda m: energies.append(m.energy)
    )
    rest, _ = sheet.settle(setting.springs, setting.natural, MATERIAL)
    assert end.converged and end.n_iter == len(energies)
    np.testing.assert_allclose(end.sheet.control, rest.control, atol=1e-6)
    assert (np.diff([still.energy, *energies]) <= 1e-12 * still.energy).all()
    again = sheet_motion.relax(sheet_motion.start(rest, setting, dynamics), setting, dynamics, tol=1e-9)
    assert again.n_iter == 1 and again.moved < 1e-9  # rest is a fixed point


@pytest.mark.parametrize(("mass", "damping"), [(1e6, 1.0), (0.0, 1e6)])
def test_a_sheet_that_is_only_slow_is_not_at_rest(wild, setting, mass, damping):
    dynamics = Dynamics(mass=mass, damping=damping)
    still = sheet_motion.start(Sheet(wild.control, np.ones(SHAPE)), setting, dynamics)
    first = sheet_motion.relax(still, setting, dynamics, tol=1e-2, max_iter=1)
    assert 0 < first.moved < 1e-2 and not first.converged


def test_free_weights_find_a_place_of_less_energy_that_is_a_least_one(setting):
    dynamics = Dynamics(free_weights=True, hold=0.1)
    rest, _ = sheet.settle(setting.springs, setting.natural, MATERIAL)
    energies = []
    end = sheet_motion.relax(
        sheet_motion.start(rest, setting, dynamics),
        setting,
        dynamics,
        tol=1e-8,
        max_iter=500,
        iter_callback=lambda m: energies.append(m.energy),
    )
    assert end.converged and (np.diff(energies) <= 1e-12 * energies[0]).all()
    least = sheet_motion.potential(end.sheet, setting, dynamics)
    assert least < sheet_motion.potential(rest, setting, dynamics) - 1e-3
    assert end.sheet.weights.min() > 0 and np.ptp(end.sheet.weights) > 0.1
    q = sheet_motion._coordinates(end.sheet, True)
    for i in (3, 90, 165, 180, 210):
        beside = [
            sheet_motion._with_coordinates(q=q + s * np.eye(len(q))[i], sheet=end.sheet, free_weights=True)
            for s in (0.01, -0.01)
        ]
        assert all(sheet_motion.potential(other, setting, dynamics) > least for other in beside)


def test_springs_far_off_are_weakened(rng):
    v, u = rng.uniform(0, SPANS[0], 300), rng.uniform(0, SPANS[1], 300)
    points = plane().at(v, u)
    points[::20, 2] += 8.0
    springs = Springs(points, v, u, np.ones(300))
    made, weakened = sheet.settle(springs, sheet.flat(SPANS), Material((0, 0, 1e-3, 1e-3, 1e-3)), rounds=8)
    assert np.abs(made.at(v, u) - plane().at(v, u)).max() < 0.25
    assert weakened.strength[::20].max() < 0.05 and np.delete(weakened.strength, np.s_[::20]).min() > 0.5


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
