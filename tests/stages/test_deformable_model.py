"""The balloon against its equilibria in closed form and a dense twin of the scheme."""

import numpy as np
import pytest

from cranio_nb.curves import cubic, spiral
from cranio_nb.stages.deformable_model import PAPER_PRESSURE, curvature_pressure, inflate, tangent_pressure

FAR = 1e6  # a chord so long that every normal stands on it
STIFF = {"dt": 1e4, "tol": 1e-9, "max_iter": 400}  # large steps: straight to the equilibrium
GAPS = np.array([60.0, 90.0, 120.0, 160.0])
RADIUS = 189.0


def chord(length, n):
    return np.stack([np.linspace(0, length, n), np.zeros(n)], axis=1)


def slopes_of(length, theta0, theta1, n):
    """End slopes per snaxel of the paper's parametrisation, x = L s."""
    length = np.asarray(length, float)
    return np.stack([np.stack([length, length * np.tan(t)], axis=-1) for t in (theta0, theta1)], axis=-2) / (n - 1)


def paper_batch(n=21, **options):
    half = np.arcsin(GAPS / 2 / RADIUS)
    start = cubic(GAPS, half, np.pi - half, n)
    return inflate(start, slopes_of(GAPS, half, np.pi - half, n), **options)


def errors_from_arc(curves):
    """Largest distance of each curve's snaxels from the arc of `RADIUS` over its gap, px."""
    centre = np.stack([GAPS / 2, -np.sqrt(RADIUS**2 - GAPS**2 / 4)], axis=-1)[:, None]
    return np.abs(np.linalg.norm(curves - centre, axis=-1) - RADIUS).max(axis=-1)


def dense_step(c, slopes, k, w1, w2, dt):
    """One step by the textbook: ghost nodes written out, one dense system; c (n, 2), slopes (2, 2), k (n,)."""
    n = len(c)
    tangent = np.gradient(c, axis=0)
    normal = np.stack([-tangent[:, 1], tangent[:, 0]], axis=1) / np.linalg.norm(tangent, axis=1, keepdims=True)
    m, rhs = np.zeros((n + 2, n + 2)), np.zeros((n + 2, 2))  # c(-1) ... c(n)
    m[0, [0, 2]], rhs[0] = (-1, 1), 2 * slopes[0]
    m[-1, [-3, -1]], rhs[-1] = (-1, 1), 2 * slopes[1]
    m[1, 1], rhs[1] = 1, c[0]
    m[-2, -2], rhs[-2] = 1, c[-1]
    for i in range(1, n - 1):
        j = i + 1
        m[j, j] += 1
        m[j, j - 1 : j + 2] -= dt * w1 * np.array([1, -2, 1])
        m[j, j - 2 : j + 3] += dt * w2 * np.array([1, -4, 6, -4, 1])
        rhs[j] = c[i] + dt * k[i] * normal[i]
    return np.linalg.solve(m, rhs)[1:-1]


@pytest.mark.parametrize("seed", range(5))
def test_a_step_is_the_clamped_semi_implicit_scheme(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(6, 40))
    c, slopes, k = rng.normal(size=(n, 2)) * 20, rng.normal(size=(2, 2)) * 3, rng.normal(size=n)
    w1, w2, dt = rng.uniform(0.1, 5, 3)
    step = inflate(c, slopes, pressure=k, tension=w1, rigidity=w2, dt=dt, max_iter=1)
    np.testing.assert_allclose(step.curve, dense_step(c, slopes, k, w1, w2, dt), atol=1e-9)


def held_spiral(n, w1, w2, turn):
    """A solution of eq. (1) at rest in closed form: snaxels (n, 2), end slopes, pressure, tension, rigidity.

    The logarithmic spiral c(s) = exp(z s), 0 <= s <= 1, as a complex number, with z = -a + i turn: its own force is
    -w1 c'' + w2 c'''' = (-w1 z + w2 z^3) c'. It stands on the curve, a real multiple of i c', where the real part of
    the bracket is none: a^2 = 3 turn^2 + w1 / w2. The other part, times |c'|, is the pressure that holds the spiral;
    like the curvature it grows all along, here e^|a| > 5 fold. Per snaxel, with h = 1 / (n - 1): pressure h^2 k,
    tension w1, rigidity w2 / h^2.
    """
    h = 1 / (n - 1)
    z = complex(-np.sqrt(3 * turn**2 + w1 / w2), turn)
    c = np.exp(z * np.linspace(0, 1, n))
    own = -w1 * z + w2 * z**3
    assert own.real == pytest.approx(0, abs=1e-12 * abs(own))
    pairs = [np.stack([part.real, part.imag], axis=1) for part in (c, h * z * c[[0, -1]])]
    return *pairs, h**2 * own.imag * np.abs(z * c), w1, w2 / h**2


@pytest.mark.parametrize("turn", [-1.0, 1.5])
@pytest.mark.parametrize(("w1", "w2"), [(1.0, 1.0), (0.0, 1.0), (3.0, 0.5)])
def test_a_manufactured_rest_is_approached_in_second_order(w1, w2, turn):
    """From a straight start, with 3 times 2 refinements; central differences and ghost nodes are of second order."""
    errors = []
    for n in (21, 41, 81, 161):
        wanted, slopes, k, tension, rigidity = held_spiral(n, w1, w2, turn)
        start = np.linspace(wanted[0], wanted[-1], n)
        made = inflate(start, slopes, pressure=k, tension=tension, rigidity=rigidity, dt=n**2, tol=1e-11)
        assert made.converged
        again = dense_step(made.curve, slopes, k, tension, rigidity, 1.0)
        np.testing.assert_allclose(again, made.curve, atol=1e-9)  # the textbook's scheme rests there too
        errors.append(np.linalg.norm(made.curve - wanted, axis=1).max())
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders, 2, atol=0.05)


@pytest.mark.parametrize("length", [FAR, 5 * FAR])
@pytest.mark.parametrize("n", [21, 41, 81])
def test_with_matching_slopes_the_equilibrium_is_a_parabola_whatever_the_chord(length, n):
    k = PAPER_PRESSURE
    end = np.array([[length / (n - 1), k * (n - 1) / 2], [length / (n - 1), -k * (n - 1) / 2]])
    relaxed = inflate(chord(length, n), end, **STIFF)
    i = np.arange(n)
    assert relaxed.converged
    np.testing.assert_allclose(relaxed.curve[:, 1], k * i * (n - 1 - i) / 2, atol=1e-7)
    assert relaxed.curve[:, 1].max() == pytest.approx(k * (n - 1) ** 2 / 8, rel=1e-7)  # 3.1 px for the paper's 21


def test_away_from_any_ends_the_second_difference_is_minus_the_pressure():
    n = 201
    for slope in (-2.0, 0.0, 7.0):
        end = np.array([[FAR / (n - 1), slope]] * 2)
        y = inflate(chord(FAR, n), end, pressure=0.062, **STIFF).curve[:, 1]
        np.testing.assert_allclose(np.diff(y, 2)[20:-20], -0.062, atol=1e-7)


def test_tension_scales_the_bend():
    n = 201
    end = np.array([[FAR / (n - 1), 0.0]] * 2)
    y = inflate(chord(FAR, n), end, pressure=0.3, tension=4.0, **STIFF).curve[:, 1]
    np.testing.assert_allclose(np.diff(y, 2)[40:-40], -0.3 / 4, atol=1e-7)


def test_rigidity_alone_gives_the_cubic_with_the_end_slopes():
    n, slopes = 25, np.array([[4.0, 2.5], [4.0, -1.0]])
    relaxed = inflate(chord(96.0, n), slopes, pressure=0.0, tension=0.0, dt=1e7, tol=1e-8, max_iter=100).curve

    def powers(i):
        return np.array([1.0, i, i**2, i**3])

    conditions = [powers(0), powers(n - 1), (powers(1) - powers(-1)) / 2, (powers(n) - powers(n - 2)) / 2]
    wanted = np.linalg.solve(conditions, np.array([[0, 0], [96, 0], *slopes]))
    np.testing.assert_allclose(relaxed, np.array([powers(i) for i in range(n)]) @ wanted, atol=1e-6)


def test_the_papers_pressure_fits_one_width_only():
    errors = errors_from_arc(paper_batch().curve)
    np.testing.assert_allclose(errors, [0.56, 1.9, 5.4, 11.9], rtol=0.03)


def test_the_tangents_pressure_fits_every_width():
    half = np.arcsin(GAPS / 2 / RADIUS)
    errors = errors_from_arc(paper_batch(pressure=tangent_pressure(GAPS, half, np.pi - half, 21)).curve)
    np.testing.assert_allclose(errors, [0.01, 0.07, 0.21, 0.70], rtol=0.05, atol=0.006)


def test_the_spirals_own_curvature_holds_the_arc():
    half, n = np.arcsin(GAPS / 2 / RADIUS), 41
    start, curvature = spiral(GAPS, half, np.pi - half, n)
    along = 2 * half * RADIUS
    head = np.stack([np.stack([np.cos(t), np.sin(t)], axis=-1) for t in (half, -half)], axis=-2)
    slopes = head * (along / (n - 1))[:, None, None]
    relaxed = inflate(start, slopes, pressure=curvature_pressure(along, curvature))
    assert relaxed.converged.all()
    assert errors_from_arc(relaxed.curve).max() < 0.01


def test_tangent_pressure_of_a_shallow_arc_is_its_curvature_pressure():
    half = np.radians(1.0)
    length, n = 2 * RADIUS * np.sin(half), 21
    k = tangent_pressure(length, half, np.pi - half, n)
    held = curvature_pressure(np.array(2 * RADIUS * half), np.full(n, 1 / RADIUS))
    np.testing.assert_allclose(held, k, rtol=1e-3)
    assert k > 0


def test_without_pressure_a_straight_curve_stays_straight():
    start = chord(80.0, 31)
    relaxed = inflate(start, np.array([[80 / 30, 0.0]] * 2), pressure=0.0)
    np.testing.assert_allclose(relaxed.curve, start, atol=1e-12)
    assert relaxed.n_iter == 1 and relaxed.converged


def test_pressure_outward_is_positive_and_its_sign_turns_the_curve_over():
    out = inflate(chord(60.0, 21), np.array([[3.0, 0.0]] * 2), pressure=0.1, **STIFF).curve
    inward = inflate(chord(60.0, 21), np.array([[3.0, 0.0]] * 2), pressure=-0.1, **STIFF).curve
    assert (out[1:-1, 1] > 0).all()
    np.testing.assert_allclose(inward, out * [1, -1], atol=1e-9)


def test_a_symmetric_balloon_stays_symmetric():
    curves = paper_batch().curve
    np.testing.assert_allclose(GAPS[:, None] - curves[:, ::-1, 0], curves[..., 0], atol=1e-9)
    np.testing.assert_allclose(curves[:, ::-1, 1], curves[..., 1], atol=1e-9)


def test_dt_changes_the_way_but_not_the_rest():
    runs = [paper_batch(dt=dt, tol=1e-9, max_iter=50_000) for dt in (0.5, 1.0, 20.0)]
    assert all(run.converged.all() for run in runs)
    assert (runs[0].n_iter > runs[1].n_iter).all() and (runs[1].n_iter > runs[2].n_iter).all()
    for run in runs[:2]:
        np.testing.assert_allclose(run.curve, runs[2].curve, atol=1e-6)


def test_without_pressure_the_energy_never_grows():
    rng = np.random.default_rng(2)
    start = chord(60.0, 21) + np.pad(rng.normal(size=(19, 2)), ((1, 1), (0, 0)))
    seen = [start]
    slope = np.array([3.0, 0.0])
    inflate(start, np.array([slope, slope]), pressure=0.0, iter_callback=lambda step, c, d: seen.append(c))

    def energy(c):
        ghosts = np.concatenate([[c[1] - 2 * slope], c, [c[-2] + 2 * slope]])
        bend = (np.diff(ghosts, 2, axis=0) ** 2).sum(axis=1)
        return (np.diff(c, axis=0) ** 2).sum() + bend[1:-1].sum() + (bend[0] + bend[-1]) / 2

    assert (np.diff([energy(c) for c in seen]) <= 1e-12).all()
    assert len(seen) > 10


def test_a_batch_is_its_members():
    rng = np.random.default_rng(7)
    start = cubic(GAPS, 0.2, 2.9, 21).reshape(2, 2, 21, 2)
    slopes = slopes_of(GAPS, np.full(4, 0.2), np.full(4, 2.9), 21).reshape(2, 2, 2, 2)
    for pressure in (0.062, rng.uniform(0, 0.3, (2, 2)), rng.uniform(0, 0.3, (2, 2, 21))):
        batch = inflate(start, slopes, pressure=pressure)
        for i in np.ndindex(2, 2):
            one = inflate(start[i], slopes[i], pressure=pressure if np.ndim(pressure) == 0 else pressure[i])
            np.testing.assert_allclose(batch.curve[i], one.curve, rtol=0, atol=1e-12)
            assert batch.n_iter[i] == one.n_iter and batch.converged[i] == one.converged
        assert batch.curve.shape == start.shape and batch.n_iter.shape == (2, 2)


def test_it_says_when_it_gave_up():
    relaxed = paper_batch(max_iter=60)
    assert not relaxed.converged.all()
    assert (relaxed.n_iter[~relaxed.converged] == 60).all()
    assert paper_batch().converged.all()


def test_it_stops_at_the_first_step_that_is_small_enough():
    changes = []
    relaxed = paper_batch(tol=1e-3, iter_callback=lambda step, c, change: changes.append(change))
    changes = np.array(changes)
    for curve in range(4):
        last = relaxed.n_iter[curve]
        assert (changes[: last - 1, curve] > 1e-3).all() and changes[last - 1, curve] <= 1e-3
        assert (changes[last:, curve] == 0).all()  # it rests while the others move on


def test_the_callback_sees_every_step_and_cannot_touch_the_curve():
    steps, path = [], []

    def watch(step, curves, change):
        steps.append(step)
        path.append(curves.copy())
        curves[:] = np.nan

    relaxed = paper_batch(iter_callback=watch)
    assert steps == list(range(1, relaxed.n_iter.max() + 1))
    np.testing.assert_array_equal(path[-1], relaxed.curve)
    np.testing.assert_array_equal(relaxed.curve, paper_batch().curve)
    moved = np.linalg.norm(path[1] - path[0], axis=(1, 2))
    second = []
    paper_batch(max_iter=2, iter_callback=lambda step, c, change: second.append(change))
    np.testing.assert_allclose(second[1], moved)


def test_ends_are_held_bit_for_bit_and_inputs_are_not_modified():
    start = cubic(GAPS, 0.2, 2.9, 21)
    slopes = slopes_of(GAPS, np.full(4, 0.2), np.full(4, 2.9), 21)
    pressure = np.full(4, 0.062)
    for array in (start, slopes, pressure):
        array.setflags(write=False)
    before = start.copy()
    relaxed = inflate(start, slopes, pressure=pressure)
    np.testing.assert_array_equal(start, before)
    np.testing.assert_array_equal(relaxed.start, before)
    np.testing.assert_array_equal(relaxed.curve[:, [0, -1]], start[:, [0, -1]])


def test_the_papers_settings_stop_after_about_the_papers_number_of_steps():
    """Tables 1 and 2: 31 to 147 steps, ||dc|| <= 1e-3, 21 snaxels, angles of 4 to 29 degrees."""
    theta0, theta1 = np.radians([4, 22, 12, 29]), np.radians([169, 156, 156, 143])
    relaxed = inflate(cubic(90.0, theta0, theta1, 21), slopes_of(np.full(4, 90.0), theta0, theta1, 21))
    assert relaxed.converged.all()
    assert 31 <= relaxed.n_iter.min() < 147  # the paper gives no gap width, so only the order of magnitude can agree
    assert relaxed.n_iter.max() < 2 * 147


def test_no_more_snaxels_are_moved_than_allowed_and_what_moved_on_is_not_at_rest():
    """Two curves of 21 snaxels: one rests at once, the other is stopped."""
    still = np.stack([np.linspace(0, 100, 21), np.zeros(21)], axis=1)
    slopes = np.array([[5.0, 0.0], [5.0, 0.0]])
    start, pressure = np.stack([still, still]), np.array([0.0, 0.01])
    free = inflate(start, slopes, pressure=pressure, tol=1e-9)
    assert free.converged.all() and free.n_iter[1] > 50 > free.n_iter[0]
    stopped = inflate(start, slopes, pressure=pressure, tol=1e-9, max_moves=21 * (free.n_iter[0] + 50))
    assert stopped.n_iter.sum() * 21 == 21 * (free.n_iter[0] + 50) and stopped.converged.tolist() == [True, False]
    enough = inflate(start, slopes, pressure=pressure, tol=1e-9, max_moves=21 * free.n_iter.sum())
    np.testing.assert_array_equal(enough.curve, free.curve)
    assert enough.converged.all()
