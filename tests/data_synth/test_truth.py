"""The gaps of a slice in closed form: on the surfaces, between the cuts, and where the voxels are missing."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth import phantom_case
from data_synth.truth import gaps_in_slice


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
