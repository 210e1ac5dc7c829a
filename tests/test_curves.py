"""The chord frame, the paper's cubic and the Euler spiral against closed forms and independent integration."""

import numpy as np
import pytest

from cranio_nb.curves import ChordFrame, GapEnds, SliceFeatures, arc_length, cubic, normals, resample, spiral

ANGLES = np.radians([[4, 176], [22, 156], [29, 143], [5, 160], [60, 130], [100, 95], [-10, 170], [-15, 200], [0, 180]])
LENGTHS = np.array([30.0, 60, 90, 120, 160, 45, 50, 70, 200])


def arc_ends(half, radius=189.0, centre=(210.0, 190.0), towards=0.7):
    """Ends of an arc of half angle `half` about a direction of the slice, tangents into the gap, and its centre."""
    centre = np.array(centre)
    at = towards + np.array([-half, half])
    points = centre + radius * np.stack([-np.cos(at), np.sin(at)], axis=1)
    onward = np.stack([np.sin(at), np.cos(at)], axis=1)
    return GapEnds(points, onward * [[1], [-1]]), centre


def test_cubic_is_equation_3_zero_at_both_ends_with_the_slopes_of_the_angles():
    n = 2001
    curve = cubic(LENGTHS, *ANGLES.T, n)
    np.testing.assert_allclose(curve[:, [0, -1], 0], np.stack([np.zeros(9), LENGTHS], axis=1))
    np.testing.assert_allclose(curve[:, [0, -1], 1], 0, atol=1e-9)
    steep = np.tan(ANGLES)
    scaled = curve[..., 1] / LENGTHS[:, None]
    h = 1 / (n - 1)
    np.testing.assert_allclose((scaled[:, :3] @ [-1.5, 2, -0.5]) / h, steep[:, 0], atol=1e-4 * np.abs(steep).max())
    np.testing.assert_allclose((scaled[:, -3:] @ [0.5, -2, 1.5]) / h, steep[:, 1], atol=1e-4 * np.abs(steep).max())
    np.testing.assert_allclose(np.diff(curve[:, ::100], 4, axis=1), 0, atol=1e-9)  # a cubic


def test_cubic_bulges_outward_for_an_obtuse_second_angle():
    assert (cubic(100, np.radians(15), np.radians(160), 21)[1:-1, 1] > 0).all()


@pytest.mark.parametrize("half", np.radians([0.01, 4, 25, 45, 80, 89.9, 90, 120]))
def test_spiral_of_equal_ends_is_an_exact_arc(half):
    length, n = 120.0, 33
    points, curvature = spiral(length, half, np.pi - half, n)
    radius = length / (2 * np.sin(half))
    centre = np.array([length / 2, -radius * np.cos(half)])
    at = np.linspace(-half, half, n)
    arc = centre + radius * np.stack([np.sin(at), np.cos(at)], axis=1)
    np.testing.assert_allclose(points, arc, atol=1e-9)
    np.testing.assert_allclose(curvature, 1 / radius, rtol=1e-9)


def test_spiral_of_flat_ends_is_the_chord():
    points, curvature = spiral(50.0, 0.0, np.pi, 11)
    np.testing.assert_allclose(points, np.stack([np.linspace(0, 50, 11), np.zeros(11)], axis=1), atol=1e-12)
    np.testing.assert_allclose(curvature, 0, atol=1e-15)


@pytest.mark.parametrize(("length", "ends"), list(zip(LENGTHS, ANGLES, strict=True)))
def test_spiral_is_g1_its_curvature_linear_and_its_points_the_integral_of_both(length, ends):
    n = 4001
    points, curvature = spiral(length, *ends, n)
    np.testing.assert_allclose(np.diff(curvature, 2), 0, atol=1e-12)
    total = arc_length(points)[-1]
    s = np.linspace(0, total, n)
    bend = (curvature[-1] - curvature[0]) / total
    heading = ends[0] - curvature[0] * s - bend * s**2 / 2
    assert heading[-1] == pytest.approx(ends[1] - np.pi, abs=1e-6)
    walk = np.stack([np.cos(heading), np.sin(heading)], axis=1)
    trapezium = np.cumsum((walk[1:] + walk[:-1]) / 2 * np.diff(s)[:, None], axis=0)
    np.testing.assert_allclose(points[1:], trapezium, atol=2e-7 * length)
    np.testing.assert_allclose(points[[0, -1]], [[0, 0], [length, 0]], atol=1e-9)


def test_spiral_points_are_evenly_spaced_and_do_not_depend_on_how_many():
    fine, _ = spiral(90.0, 0.4, 2.6, 81)
    coarse, curvature = spiral(90.0, 0.4, 2.6, 21)
    np.testing.assert_allclose(fine[::4], coarse, atol=1e-9)
    steps = np.hypot(*np.diff(fine, axis=0).T)
    assert np.ptp(steps) < 2e-4 * steps.mean()  # chords of equal arcs, a little shorter where it bends more
    assert curvature.shape == (21,)


def test_mirrored_ends_give_the_mirrored_curve():
    length = LENGTHS[:, None]
    for curve in (cubic, lambda *a: spiral(*a)[0]):
        points = curve(LENGTHS, *ANGLES.T, 25)
        mirrored = curve(LENGTHS, *(np.pi - ANGLES[:, ::-1]).T, 25)
        wanted = np.stack([length - points[:, ::-1, 0], points[:, ::-1, 1]], axis=-1)
        np.testing.assert_allclose(mirrored, wanted, atol=1e-7)


def test_inward_ends_give_the_curve_upside_down():
    for curve in (cubic, lambda *a: spiral(*a)[0]):
        np.testing.assert_allclose(
            curve(LENGTHS, -ANGLES[:, 0], 2 * np.pi - ANGLES[:, 1], 25),
            curve(LENGTHS, *ANGLES.T, 25) * [1, -1],
            atol=1e-7,
        )


def test_twice_the_chord_gives_twice_the_curve_and_half_the_curvature():
    points, curvature = spiral(LENGTHS, *ANGLES.T, 25)
    larger, flatter = spiral(2 * LENGTHS, *ANGLES.T, 25)
    np.testing.assert_allclose(larger, 2 * points, rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(flatter, curvature / 2, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(cubic(2 * LENGTHS, *ANGLES.T, 25), 2 * cubic(LENGTHS, *ANGLES.T, 25))


def test_a_batch_is_its_members():
    for curve in (cubic, lambda *a: spiral(*a)[0], lambda *a: spiral(*a)[1]):
        one_by_one = [curve(length, *ends, 17) for length, ends in zip(LENGTHS, ANGLES, strict=True)]
        np.testing.assert_allclose(curve(LENGTHS, *ANGLES.T, 17), one_by_one, atol=1e-12)
        grid = curve(LENGTHS.reshape(3, 3), *np.moveaxis(ANGLES.reshape(3, 3, 2), -1, 0), 17)
        np.testing.assert_allclose(grid.reshape(9, *grid.shape[2:]), one_by_one, atol=1e-12)


@pytest.mark.parametrize("half", np.radians([2, 15, 45, 90, 110]))
@pytest.mark.parametrize("towards", [-2.5, 0.0, 0.7, np.pi])
def test_end_angles_of_an_arc_are_its_half_angle(half, towards):
    ends, centre = arc_ends(half, towards=towards)
    frame = ChordFrame.of(ends, centre - np.array([-np.cos(towards), np.sin(towards)]) * 189)
    assert frame.end_angles(ends) == pytest.approx((half, np.pi - half), abs=1e-12)
    assert frame.length == pytest.approx(2 * 189 * np.sin(half))


def test_angles_grow_smoothly_through_a_flat_end():
    for dip in (-0.1, 0.0, 0.1):
        ends = GapEnds(
            np.array([[0.0, 0.0], [0.0, 10.0]]), np.array([[-np.sin(dip), np.cos(dip)], [-np.sin(dip), -np.cos(dip)]])
        )
        assert ChordFrame.of(ends, (5.0, 5.0)).end_angles(ends) == pytest.approx((dip, np.pi - dip))


def test_chord_frame_puts_the_ends_on_the_axis_and_out_away_from_the_inside():
    rng = np.random.default_rng(1)
    for _ in range(50):
        ends = GapEnds(rng.uniform(0, 512, (2, 2)), np.eye(2))
        inside = rng.uniform(0, 512, 2)
        frame = ChordFrame.of(ends, inside)
        np.testing.assert_allclose(frame.to_chord(ends.points), [[0, 0], [frame.length, 0]], atol=1e-10)
        np.testing.assert_allclose(frame.axes @ frame.axes.T, np.eye(2), atol=1e-12)
        assert frame.to_chord(inside)[1] < 0
        points = rng.uniform(-100, 600, (4, 5, 2))
        np.testing.assert_allclose(frame.to_slice(frame.to_chord(points)), points, atol=1e-10)
        np.testing.assert_allclose(
            np.linalg.norm(frame.to_chord(points[0]) - frame.to_chord(points[1]), axis=-1),
            np.linalg.norm(points[0] - points[1], axis=-1),
        )


def test_the_curve_of_an_arc_lies_on_the_arc_in_the_slice():
    ends, centre = arc_ends(0.4)
    frame = ChordFrame.of(ends, centre)
    curve = frame.to_slice(spiral(frame.length, *frame.end_angles(ends), 41)[0])
    np.testing.assert_allclose(np.hypot(*(curve - centre).T), 189, atol=1e-9)


def test_arc_length_and_even_points_of_a_polyline():
    bend = np.array([[0.0, 0], [3, 4], [3, 10], [11, 16]])
    np.testing.assert_allclose(arc_length(bend), [0, 5, 11, 21])
    np.testing.assert_allclose(resample(bend, 4), [[0, 0], [3, 6], [5.4, 11.8], [11, 16]])
    np.testing.assert_array_equal(resample(bend, 7)[[0, -1]], bend[[0, -1]])


def test_normals_of_a_chord_point_out_and_those_of_an_arc_along_its_radii():
    chord = np.stack([np.linspace(0, 50, 11), np.zeros(11)], axis=1)
    np.testing.assert_allclose(normals(chord), np.tile([0.0, 1.0], (11, 1)), atol=1e-15)
    at, step = np.linspace(-0.5, 0.5, 21, retstep=True)
    radial = np.stack([np.sin(at), np.cos(at)], axis=1)
    found = normals(np.stack([7 * radial, 3 * radial]))
    np.testing.assert_allclose(found[:, 1:-1], np.stack([radial, radial])[:, 1:-1], atol=1e-12)
    one_sided = [[np.sin(a), np.cos(a)] for a in (at[0] + step / 2, at[-1] - step / 2)]
    np.testing.assert_allclose(found[0][[0, -1]], one_sided, atol=1e-12)


def test_normals_of_a_curve_that_stands_still_are_finite():
    assert np.isfinite(normals(np.zeros((5, 2)))).all()


def test_the_hull_splits_the_boundary_into_outer_and_inner():
    square = np.array([[1, 0, -10.0], [-1, 0, 0], [0, 1, -10], [0, -1, 0]])  # 0 <= row, col <= 10
    boundary = np.array([[5.0, 5], [10, 3], [10, 10], [11, 3], [-0.5, 2], [4, 12]])
    seen = SliceFeatures(boundary, (), square, False)
    np.testing.assert_array_equal(seen.inner, boundary[:3])
    np.testing.assert_array_equal(seen.outer, boundary[3:])
