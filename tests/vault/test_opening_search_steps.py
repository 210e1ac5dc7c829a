"""What the steps of the opening search give on a hollow ball whose every length is known."""

from dataclasses import replace

import numpy as np
import pytest
from hollow_ball import CENTRE, INNER, OUTER, STEP, ball, radius_and_cone

from cranio_nb.vault import opening_search
from cranio_nb.vault.head_frame import HeadFrame, find_head_frame
from cranio_nb.vault.opening_search import find_openings, survey_openings
from cranio_nb.vault.outermost_bone import STEP_DEG, OutermostBone, vertex_rays
from cranio_nb.vault.ray_grid import RayGrid
from cranio_nb.vault.thin_bone import Material

WALL = OUTER - INNER
TOP, LEFT = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])


def rays_of_ball(hole=TOP, half_deg=15.0, seen=OUTER + 6):
    """The ball in closed form: rays about the vertex, the outer radius along them, and the rays through the hole."""
    grid = RayGrid(CENTRE, np.eye(3), np.radians(STEP_DEG), 153)
    through = grid.directions @ hole >= np.cos(np.radians(half_deg))
    radius = np.where(through, np.nan, OUTER)
    return OutermostBone(grid, radius, np.full(radius.shape, seen)), through


def signs_of(bone, scan=None, hole=TOP, half_deg=15.0):
    outermost, rays = rays_of_ball(hole, half_deg)
    frame = HeadFrame(CENTRE, np.eye(3), np.eye(3), 0.7, 0.0, 0.0, "")
    material = Material.of(bone, scan, CENTRE, outermost.grid.directions[~rays])
    return opening_search._signs(bone, outermost, rays, np.full(rays.shape, OUTER), material, frame)


@pytest.mark.parametrize("half_deg", [6.0, 15.0, 25.0])
def test_signs_of_a_round_hole_at_the_vertex(half_deg):
    bone, _ = ball(TOP, half_deg)
    signs = signs_of(bone, half_deg=half_deg)
    # distances from the middle of the map are arcs; the hole is counted in rays of 2 mm
    assert signs.diameter_mm == pytest.approx(2 * np.radians(half_deg) * OUTER, abs=1.0)
    assert (signs.across_mm, signs.on_vault, signs.two_walls) == (0, 1, 0)
    assert signs.rim_mm == pytest.approx(WALL, abs=STEP)  # half a voxel at each end
    assert (signs.frame, signs.plain, signs.with_hu) == (0.7, True, False)


@pytest.mark.parametrize(("first", "last", "across"), [(-3, 0, 3), (3, 4.5, 1.5), (9, 10.5, 0), (-25, -15, 0)])
def test_bone_counts_as_lying_across_up_to_where_the_head_may_bulge(first, last, across):
    """Above a hole of 42 mm: 2 mm, and a fifth of half its width."""
    bone, _ = ball(TOP, 15.0, room_mm=12.0)
    radius, cone = radius_and_cone(bone, TOP, 15.0)
    closed = bone.with_voxels(bone.voxels | (cone & (radius >= OUTER + first) & (radius < OUTER + last)))
    assert signs_of(closed).across_mm == pytest.approx(across, abs=STEP / 2)


def test_only_the_middle_of_an_opening_says_whether_bone_lies_across():
    """A shelf of bone along the rim, to 11 of 15 degrees: seven tenths of the way lie free."""
    bone, _ = ball(TOP, 15.0)
    radius, cone = radius_and_cone(bone, TOP, 15.0)
    film = cone & (radius <= OUTER) & (radius >= OUTER - 3)
    _, middle = radius_and_cone(bone, TOP, 11.0)
    assert signs_of(bone.with_voxels(bone.voxels | (film & ~middle))).across_mm == 0
    _, beside = radius_and_cone(bone, TOP - LEFT, 40.0)
    assert (film & beside).any()  # but over less than half of the middle
    assert signs_of(bone.with_voxels(bone.voxels | (film & beside))).across_mm == 0


def test_with_hu_thin_bone_counts_by_what_it_attenuates():
    bone, _ = ball(TOP, 15.0)
    radius, cone = radius_and_cone(bone, TOP, 15.0)
    hu = np.where(bone.voxels, 1040, 40)
    hu[cone & (radius >= OUTER - 3) & (radius < OUTER)] = 540  # half of it bone
    signs = signs_of(bone, bone.with_voxels(hu.astype(np.int16)))
    assert signs.across_mm == pytest.approx(1.5, abs=STEP / 2) and signs.with_hu


@pytest.mark.parametrize("degrees", [80.0, 88.0, 96.0])
def test_share_of_an_opening_above_the_base(degrees):
    """At the side of the head the base begins 88 degrees from the vertex."""
    side = np.array([np.sin(np.radians(degrees)), 0.0, np.cos(np.radians(degrees))])
    bone, _ = ball(side, 12.0)
    # of a disk, the part within a distance of its middle; a row of rays more or less
    t = np.clip((88.0 - degrees) / 12.0, -1, 1)
    share = 0.5 + (t * np.sqrt(1 - t**2) + np.arcsin(t)) / np.pi
    assert signs_of(bone, hole=side, half_deg=12.0).on_vault == pytest.approx(share, abs=1.5 / 24 + 0.02)


def test_walls_behind_the_rim_are_another_wall_from_16_mm_on():
    bone, _ = ball(TOP, 15.0)
    radius, left = radius_and_cone(bone, LEFT, 90.0)

    def with_wall(first, last, where=True):
        return signs_of(bone.with_voxels(bone.voxels | (where & (radius >= OUTER - last) & (radius <= OUTER - first))))

    half = with_wall(25, 30, left)
    assert half.two_walls == pytest.approx(0.5, abs=0.08)  # a line of rays along the border
    assert half.rim_mm == pytest.approx(WALL, abs=STEP)
    # nearer it is taken for the diploe, and for a part of the rim; 60 mm are looked at
    near = with_wall(10, 14.5)
    assert near.two_walls == 0 and near.rim_mm == pytest.approx(WALL + 4.5, abs=STEP)
    assert with_wall(65, 68).two_walls == 0


def test_a_membrane_continues_what_is_linear_and_leaves_the_bone():
    outermost, rays = rays_of_ball(half_deg=12.0)
    v, u = outermost.grid.offsets
    _, other = rays_of_ball(np.array([np.sin(0.9), 0.0, np.cos(0.9)]), 9.0)
    slope = 70 + 8 * v - 5 * u
    known = OutermostBone(outermost.grid, np.where(rays | other, np.nan, slope), outermost.seen)
    radius = opening_search._bridged_radius(known, [rays, other])
    np.testing.assert_array_equal(radius[~(rays | other)], slope[~(rays | other)])
    # what 200 rounds leave of the nearest rim's radius: the slowest wave of a disk of 8 rays fades to 1e-4
    assert np.abs(radius - slope).max() < 0.02


@pytest.mark.parametrize("seen", [OUTER + 6, OUTER - 9])
def test_a_sheet_fills_the_opening_below_the_outer_surface_or_the_edge_of_the_image(seen):
    bone, _ = ball(TOP, 15.0)
    radius, _ = radius_and_cone(bone, TOP, 15.0)
    outermost, rays = rays_of_ball(seen=seen)
    voxels = opening_search._sheet(bone, outermost, rays, np.full(rays.shape, OUTER)).voxels
    top, half = min(seen, OUTER), STEP * np.sqrt(3) / 2
    assert radius[voxels].max() <= top + half and radius[voxels].min() >= top - 4.0 - half
    assert not (voxels & bone.voxels).any()
    # half a ray more or less at the border
    _, wide = radius_and_cone(bone, TOP, 15.0 + STEP_DEG)
    _, narrow = radius_and_cone(bone, TOP, 15.0 - STEP_DEG)
    assert not (voxels & ~wide & (np.abs(radius - top + 2) < 1)).any()
    assert voxels[narrow & (radius <= top) & (radius >= top - 4.0)].all()


def test_pores_that_were_filled_are_those_that_the_scan_shows_soft():
    bone, _ = ball(TOP, 15.0)
    assert opening_search.unfilled_bone(bone, None) is bone
    before = bone.voxels.copy()
    hu = np.full(bone.shape, 1000, np.int16)
    soft = np.argwhere(bone.voxels)[::5]
    hu[tuple(soft.T)], hu[tuple(soft[::2].T)] = 150, 149
    kept = opening_search.unfilled_bone(bone, bone.with_voxels(hu))
    np.testing.assert_array_equal(kept.voxels, bone.voxels & (hu >= 150))
    mask = bone.with_voxels(hu >= 150)
    np.testing.assert_array_equal(opening_search.unfilled_bone(bone, mask).voxels, kept.voxels)
    np.testing.assert_array_equal(bone.voxels, before)


def test_an_opening_holds_where_rays_start_how_the_head_lies_and_its_room_in_the_image():
    bone, _ = ball(LEFT, 14.0)
    frame = replace(find_head_frame(bone), confidence=0.25)
    (one,) = survey_openings(bone, frame=frame)
    np.testing.assert_array_equal(one.opening.head_centre, vertex_rays(bone, frame.trusted_axes).centre)
    np.testing.assert_array_equal(one.opening.head_axes, frame.ray_axes)
    edge = bone.to_world(np.array(bone.shape) - 1) - CENTRE
    assert one.room_mm == pytest.approx(edge[0] - OUTER, abs=STEP)
    assert one.verdict.confidence == pytest.approx(0.6 + 0.4 * 0.25)
    (found,) = find_openings(bone, frame=frame)
    np.testing.assert_array_equal(found.sheet.voxels, one.opening.sheet.voxels)
