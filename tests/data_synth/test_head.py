"""The phantom's closed forms: volumes, radii, gradients, gaps and tangents."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth import DEFECTS, phantom_case, scan
from data_synth.defect import plan_cutters
from data_synth.head import head_shape
from data_synth.truth import gaps_in_slice


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


def world_offsets(case, plane, points):
    index = np.column_stack([np.full(len(points), plane), points])
    return index @ case.affine[:3, :3].T + case.affine[:3, 3] - case.head.centre


@pytest.mark.parametrize(
    ("defect", "tilt"),
    [("unilateral", 0.0), ("unilateral", 14.0), ("bilateral", 0.0), ("ragged", 0.0), ("partial", 14.0)],
)
def test_gap_curves_lie_on_the_surfaces_and_end_at_the_cut(defect, tilt):
    case = phantom_case("tiny", defect, 1, tilt_deg=tilt)
    planes = np.flatnonzero(case.implant.any((1, 2)))
    truths = case.slice_truth(int(planes[len(planes) // 2]))
    assert truths
    for truth in truths:
        for gap, radius in ((truth.outer, case.head.outer_radius), (truth.inner, case.head.inner_radius)):
            if gap is None:
                continue
            p = world_offsets(case, truth.plane, gap.curve)
            length = np.linalg.norm(p, axis=1)
            d = p / length[:, None]
            np.testing.assert_allclose(length, radius(d), atol=1e-8)
            cutter = case.head.cutters[truth.defect]
            inside = cutter.distance(p, case.head.inner_radius(d), case.head.outer_radius(d))
            np.testing.assert_allclose(inside[[0, -1]], 0, atol=1e-5)
            np.testing.assert_array_equal(gap.curve[[0, -1]], gap.ends)
            if defect != "ragged":  # a ragged rim may come back into the gap
                assert (inside[1:-1] > 0).all()


def test_tangents_match_finite_differences_of_the_curve():
    case = phantom_case("tiny", "unilateral", 4)
    for plane in range(12, 26, 3):
        for truth in case.slice_truth(plane):
            for gap in filter(None, (truth.outer, truth.inner)):
                inwards = np.array([gap.curve[:3], gap.curve[:-4:-1]])
                slope = -1.5 * inwards[:, 0] + 2 * inwards[:, 1] - 0.5 * inwards[:, 2]
                slope /= np.linalg.norm(slope, axis=1, keepdims=True)
                np.testing.assert_allclose(gap.tangents, slope, atol=2e-3)
                np.testing.assert_allclose(np.linalg.norm(gap.tangents, axis=1), 1)


def test_a_gap_is_where_the_voxels_are_missing():
    case = phantom_case("class", "unilateral", 2)
    plane = int(np.argwhere(case.implant).mean(0)[0].round())
    (truth,) = case.slice_truth(plane)
    outline = np.concatenate([truth.outer.curve, truth.inner.curve])
    missing = np.argwhere(case.implant[plane])
    assert np.abs(missing.min(0) - outline.min(0)).max() < 1.0
    assert np.abs(missing.max(0) - outline.max(0)).max() < 1.0


def test_slices_without_a_defect_have_no_gap():
    case = phantom_case("tiny", "unilateral", 0)
    assert case.slice_truth(2) == ()
    assert case.slice_truth(43) == ()  # above the head


def test_the_papers_lesion_is_met_by_the_full_size():
    """Around 23 slices, 20 of them open; outer chords of 45 to 65 mm and outer angles like those of Table 1."""
    full = np.array([[0, 0, 0.45, -104.25], [0, 0.45, 0, -141.5], [2.5, 0, 0, -862.75], [0, 0, 0, 1]])
    for seed in (1, 2):
        head = replace(phantom_case("tiny", "unilateral", seed).head, centre=np.array([13.0, -32.6, -795.65]))
        truths = [t for plane in range(24, 54) for t in gaps_in_slice(head, full, plane)]
        assert 21 <= len(truths) <= 26
        closed = [t for t in truths if not t.is_open]
        assert 2 <= len(closed) <= 6
        middle = max((t.outer for t in truths if t.is_open), key=lambda gap: gap.chord)
        assert 45 <= middle.chord * 0.45 <= 70
        assert 4 < middle.angles[0] < 24
        assert 156 < middle.angles[1] < 176


def test_every_defect_opens_or_thins_the_skull_where_it_says():
    for defect in ("frontal", "occipital", "vertex", "multiple", "partial"):
        case, specs = phantom_case("tiny", defect, 5), DEFECTS[defect]
        assert len(case.head.cutters) == len(specs)
        for cutter in case.head.cutters:
            d = cutter.axes[2]
            p = d * (case.head.outer_radius(d) - 0.5 * cutter.depth * case.head.bone_thickness(d))
            at = np.linalg.solve(case.affine[:3, :3], p + case.head.centre - case.affine[:3, 3])
            assert case.implant[tuple(at.round().astype(int))], defect


@pytest.mark.parametrize("defect", DEFECTS)
def test_every_defect_can_be_planned_for_any_seed(defect):
    for seed in range(50):
        for cutter in plan_cutters(defect, np.random.default_rng(seed), lambda d: 75.0):
            np.testing.assert_allclose(cutter.axes @ cutter.axes.T, np.eye(3), atol=1e-12)
            assert np.linalg.det(cutter.axes) == pytest.approx(1)
            assert cutter.distance(cutter.axes[2] * 75.0, 69.0, 75.0) > 0
            assert cutter.distance(cutter.axes[2] * -75.0, 69.0, 75.0) < 0
