"""Boundary, spine, hull and gap ends of drawn rings whose gaps are known, and lines and paths in closed form."""

import numpy as np
import pytest
from skimage.morphology import skeletonize

from cranio_nb.errors import CranioError
from cranio_nb.stages.feature_extraction import (
    SliceProblem,
    extract_features,
    find_gap_ends,
    find_longest_path,
    fit_line,
    select_tangent_points,
)

CENTRE = np.array([250.0, 250.0])
INNER, OUTER = 182.0, 202.0
LARGE = {"centre": CENTRE, "shape": (501, 501)}


def polar(points, towards=0.0):
    """Radius in px and angle in degrees from `towards`, 0 up the slice."""
    p = np.asarray(points) - CENTRE
    return np.hypot(*p.T), (np.degrees(np.arctan2(p[:, 1], -p[:, 0])) - towards + 180) % 360 - 180


def into_gap(angles, towards):
    """Unit tangents of a circle at angles from `towards`, pointing to angle 0."""
    at = np.radians(angles + towards)
    return np.stack([np.sin(at), np.cos(at)], axis=1) * -np.sign(angles)[:, None]


def degrees_between(a, b):
    return np.degrees(np.arccos(np.clip((a * b).sum(axis=1), -1, 1)))


@pytest.mark.parametrize("towards", [0, 37, 90, 200])
@pytest.mark.parametrize("half_gap", [10, 30])
def test_gap_ends_lie_on_both_boundaries_beside_the_gap(ring, half_gap, towards):
    seen = extract_features(ring(INNER, OUTER, half_gap=half_gap, towards=towards, **LARGE))
    assert not seen.closed
    for ends, radius in zip(find_gap_ends(seen, skip_px=10, reach_px=40), (OUTER, INNER), strict=True):
        found, angle = polar(ends.points, towards)
        np.testing.assert_allclose(found, radius, atol=1.0)
        assert np.sign(angle).sum() == 0
        beside = (np.abs(angle) - half_gap) * np.pi / 180 * radius
        # from `skip` to `skip` and half the bone's thickness: the spine ends before the cut face
        assert (beside > 10 - 3).all() and (beside < 10 + 10 + 4).all()
        np.testing.assert_allclose(np.linalg.norm(ends.tangents, axis=1), 1, atol=1e-12)


@pytest.mark.parametrize("towards", [0, 37, 90, 200])
def test_the_tangent_is_that_at_the_middle_of_the_neighbourhood(ring, towards):
    reach = 40.0
    seen = extract_features(ring(INNER, OUTER, half_gap=20, towards=towards, **LARGE))
    for ends, radius in zip(find_gap_ends(seen, skip_px=10, reach_px=reach), (OUTER, INNER), strict=True):
        _, angle = polar(ends.points, towards)
        lag = np.degrees(reach / 2 / ((INNER + OUTER) / 2))  # reach is measured on the spine
        middle = angle + np.sign(angle) * lag
        assert degrees_between(ends.tangents, into_gap(middle, towards)).max() < 2.0, radius


def test_a_line_fitted_to_an_arc_has_the_direction_of_its_middle():
    """So over a neighbourhood `reach` on a circle of radius R, the tangent lags by reach / (2 R)."""
    at = 0.3 + np.linspace(0, 0.5, 51)
    centre, tangent = fit_line(100 * np.stack([np.cos(at), np.sin(at)], axis=1))
    middle = 0.3 + 0.25
    assert abs(tangent @ [-np.sin(middle), np.cos(middle)]) == pytest.approx(1, abs=1e-12)
    assert np.hypot(*centre) == pytest.approx(100 * np.sin(0.25) / 0.25, rel=1e-3)


def test_a_line_is_fitted_across_its_scatter_whatever_its_slope():
    along = np.linspace(-5, 5, 11)
    for angle in np.radians([0, 30, 90, 135]):
        d, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        points = along[:, None] * d + 0.3 * (-1) ** np.arange(11)[:, None] * across + [7, 8]
        _, tangent = fit_line(points)
        assert abs(tangent @ d) == pytest.approx(1, abs=1e-3)


def test_the_hull_of_the_skeleton_parts_outer_from_inner_boundary(ring):
    seen = extract_features(ring(INNER, OUTER, half_gap=20, **LARGE))
    for points, wanted in ((seen.outer, OUTER), (seen.inner, INNER)):
        radius, angle = polar(points)
        away = np.abs(angle) > 27  # beside the cut face
        np.testing.assert_allclose(radius[away], wanted, atol=1.0)
        assert np.ptp(angle[away]) > 300
    assert len(seen.outer) + len(seen.inner) == len(seen.boundary)


def test_the_boundary_is_the_bone_that_touches_what_is_not_bone(ring):
    bone = ring(60, 75, half_gap=25)
    neighbours = [np.roll(bone, shift, axis) for axis in (0, 1) for shift in (-1, 1)]
    wanted = bone & ~np.logical_and.reduce(neighbours)
    found = np.zeros_like(bone)
    found[tuple(extract_features(bone).boundary.astype(int).T)] = True
    np.testing.assert_array_equal(found, wanted)


def test_bone_at_the_edge_of_the_image_has_its_boundary_there():
    bone = np.zeros((60, 60), bool)
    bone[:40, 10:16], bone[34:40, 10:50], bone[:40, 44:50] = True, True, True
    assert [0.0, 12.0] in extract_features(bone).boundary.tolist()


def test_a_square_cut_forks_the_skeleton_and_the_spine_does_not_follow(ring):
    bone = ring(INNER, OUTER, half_gap=20, **LARGE)
    thin = skeletonize(bone)
    around = sum(np.roll(thin, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)) - thin
    assert (thin & (around == 1)).sum() >= 3  # the trap is there
    (spine,) = extract_features(bone).skeleton
    radius, _ = polar(spine)
    middle = (INNER + OUTER) / 2
    np.testing.assert_allclose(radius, middle, atol=0.25 * (OUTER - INNER))
    assert (np.hypot(*np.diff(spine, axis=0).T) < 1.5).all()  # one path, in order


def test_bone_that_is_thin_beside_the_gap_belongs_to_the_spine(ring):
    """As at a temple: 12 px beside the gap, 20 px elsewhere."""
    bone = ring(190, OUTER, half_gap=10, **LARGE) | ring(INNER, OUTER, half_gap=60, **LARGE)
    for ends in find_gap_ends(extract_features(bone), skip_px=10, reach_px=40):
        _, angle = polar(ends.points)
        assert (np.abs(angle) < 10 + np.degrees(30 / 190)).all()


def changed(ring, bone):
    """Gap ends of the plain ring and of a changed one."""
    plain = extract_features(ring(INNER, OUTER, half_gap=20, **LARGE))
    return [find_gap_ends(seen, skip_px=10, reach_px=40) for seen in (plain, extract_features(bone))]


def test_a_spur_beside_the_rim_does_not_move_the_ends(ring):
    bone = ring(INNER, OUTER, half_gap=20, **LARGE)
    row, col = np.indices(bone.shape)
    spur = (np.abs(row - 250) < 4) & (col > 250 + OUTER - 5) & (col < 250 + OUTER + 25)
    for a, b in zip(*changed(ring, bone | spur), strict=True):
        np.testing.assert_allclose(b.points, a.points, atol=1.5)
        assert degrees_between(b.tangents, a.tangents).max() < 1.0


def test_a_hole_in_the_bone_makes_a_loop_and_the_ends_stay(ring):
    bone = ring(INNER, OUTER, half_gap=20, **LARGE)
    row, col = np.indices(bone.shape)
    hole = np.hypot(row - 250, col - 250 - 192) < 5
    assert bone[hole].all()
    seen = extract_features(bone & ~hole)
    assert len(seen.skeleton) == 1
    for a, b in zip(*changed(ring, bone & ~hole), strict=True):
        np.testing.assert_allclose(b.points, a.points, atol=1.5)
        assert degrees_between(b.tangents, a.tangents).max() < 1.0


def test_islands_are_left_out(ring):
    bone = ring(INNER, OUTER, half_gap=20, **LARGE)
    bone[240:260, 240:260] = True
    for a, b in zip(*changed(ring, bone), strict=True):
        np.testing.assert_array_equal(b.points, a.points)
        np.testing.assert_array_equal(b.tangents, a.tangents)


def test_turning_the_slice_by_90_degrees_turns_the_boundary_and_about_the_ends(ring):
    """The boundary turns exactly; thinning takes pixels off in a fixed order, so a fork is left earlier or later."""
    bone = ring(INNER, OUTER, half_gap=20, towards=13, **LARGE)
    here, there = extract_features(bone), extract_features(np.rot90(bone))
    np.testing.assert_array_equal(
        np.unique(there.boundary, axis=0),
        np.unique(np.stack([500 - here.boundary[:, 1], here.boundary[:, 0]], axis=1), axis=0),
    )
    turn = np.array([[0, -1], [1, 0]])
    for a, b in zip(
        find_gap_ends(here, skip_px=10, reach_px=40), find_gap_ends(there, skip_px=10, reach_px=40), strict=True
    ):
        wanted = (a.points - CENTRE) @ turn.T + CENTRE
        order = np.argmin(np.linalg.norm(wanted[:, None] - b.points, axis=2), axis=1)
        assert sorted(order) == [0, 1]
        np.testing.assert_allclose(b.points[order], wanted, atol=6.0)
        assert degrees_between(b.tangents[order], a.tangents @ turn.T).max() < 2.5


def test_the_opening_says_which_gap_is_meant(ring):
    bone = ring(60, 75, half_gap=20) & ring(60, 75, half_gap=12, towards=180)
    seen = extract_features(bone)
    assert len(seen.skeleton) == 2
    for towards, half_gap in ((0, 20), (180, 12)):
        opening = ring(66, 69) & ~ring(66, 69, half_gap=half_gap, towards=towards)
        for ends in find_gap_ends(seen, opening, skip_px=3, reach_px=12):
            p = ends.points - 100
            off = (np.degrees(np.arctan2(p[:, 1], -p[:, 0])) - towards + 180) % 360 - 180
            assert np.sign(off).sum() == 0 and (np.abs(off) < half_gap + 20).all()


def test_used_points_are_chosen_by_arc_length_along_the_spine():
    """A hook: points near the end by straight distance but far along the spine are not used."""
    spine = np.array(
        [[0.0, c] for c in range(31)] + [[r, 30.0] for r in range(1, 31)] + [[30.0, c] for c in range(29, -1, -1)]
    )
    boundary = np.add(spine, [1.0, 0.0])
    used = select_tangent_points(boundary, spine, skip_px=5.0, reach_px=10.0)
    np.testing.assert_array_equal(np.flatnonzero(used), np.arange(5, 16))


def test_the_longest_path_through_a_tree_leaves_its_branches_out():
    trunk = {(0, c) for c in range(20)}
    branch = {(r, 8) for r in range(1, 6)}
    fork = {(-1 - i, -1 - i) for i in range(4)} | {(1 + i, -1 - i) for i in range(7)}
    path = find_longest_path(np.array(sorted(trunk | branch | fork)))
    wanted = [(7 - i, -7 + i) for i in range(7)] + [(0, c) for c in range(20)]
    assert path.tolist() in ([list(map(float, p)) for p in wanted], [list(map(float, p)) for p in wanted[::-1]])


def test_a_diagonal_step_is_longer_than_a_straight_one():
    straight = [(0, c) for c in range(1, 6)]  # 5 px
    diagonal = [(i, -i) for i in range(1, 5)]  # 4 steps of 1.41 px
    stem = [(r, 0) for r in range(0, -20, -1)]
    path = find_longest_path(np.array(straight + diagonal + stem))
    assert [4.0, -4.0] in path[[0, -1]].tolist()


def test_the_longest_path_of_one_pixel_is_that_pixel():
    np.testing.assert_array_equal(find_longest_path(np.array([[3, 4]])), [[3.0, 4.0]])


def test_a_closed_ring_is_known_and_has_no_ends(ring):
    seen = extract_features(ring(60, 75))
    assert seen.closed
    with pytest.raises(SliceProblem, match="closed ring") as problem:
        find_gap_ends(seen)
    assert problem.value.code == "ClosedRing"
    assert isinstance(problem.value, CranioError)


def test_a_dented_ring_is_still_closed_and_a_slit_opens_it(ring):
    dented = ring(60, 75) & ~(ring(68, 75) & ~ring(68, 75, half_gap=20))
    assert extract_features(dented).closed
    assert not extract_features(ring(60, 75, half_gap=1.5)).closed


@pytest.mark.parametrize(
    ("box", "code"),
    [(np.s_[0:0, 0:0], "NoBoneInSlice"), (np.s_[5:8, 5:8], "NoSkeleton"), (np.s_[5:6, 5:40], "NoSkeleton")],
)
def test_a_slice_without_a_spine_says_so(box, code):
    bone = np.zeros((50, 50), bool)
    bone[box] = True
    with pytest.raises(SliceProblem) as problem:
        extract_features(bone)
    assert problem.value.code == code


def test_a_straight_diagonal_is_no_vault():
    with pytest.raises(SliceProblem) as problem:
        extract_features(np.eye(50, dtype=bool))
    assert problem.value.code == "NoSkeleton"


def test_too_little_bone_to_fit_a_tangent_says_so(ring):
    seen = extract_features(ring(60, 75, half_gap=20))
    with pytest.raises(SliceProblem) as problem:
        find_gap_ends(seen, skip_px=1000, reach_px=10)
    assert problem.value.code == "FewPoints"


def test_bone_on_one_side_only_says_so(ring):
    bone = ring(60, 75, half_gap=150, towards=180)  # a short piece at the top
    opening = np.zeros_like(bone)
    opening[100:104, 160:200] = True
    with pytest.raises(SliceProblem) as problem:
        find_gap_ends(extract_features(bone), opening)
    assert problem.value.code == "OneEnd"


def test_inputs_are_not_modified(ring):
    bone = ring(60, 75, half_gap=20)
    bone[100:102, 100:102] = True  # an island to drop
    bone.setflags(write=False)
    before = bone.copy()
    find_gap_ends(extract_features(bone))
    np.testing.assert_array_equal(bone, before)
