"""Patches of drawn gaps whose area is known."""

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.stages.prosthesis_volume import between, main_piece, partial_loss, patch

INNER, OUTER = 60.0, 75.0


def arc(radius, half, towards=0.0, n=41, centre=100.0):
    at = np.radians(towards + np.linspace(-half, half, n))
    return centre + radius * np.stack([-np.cos(at), np.sin(at)], axis=1)


@pytest.mark.parametrize(("half", "towards"), [(15, 0), (25, 37), (40, 200)])
def test_the_patch_of_a_ring_is_the_missing_sector(ring, half, towards):
    bone = ring(INNER, OUTER, half_gap=half, towards=towards)
    sector = ring(INNER, OUTER) & ~bone
    found = patch(arc(OUTER, half + 3, towards), arc(INNER, half + 3, towards), bone)
    assert found.sum() == pytest.approx(np.radians(half) * (OUTER**2 - INNER**2), rel=0.02)
    assert 2 * (found & sector).sum() / (found.sum() + sector.sum()) > 0.98
    assert not (found & bone).any()


def test_the_area_between_two_curves_is_that_of_the_polygon():
    outer, inner = arc(OUTER, 30), arc(INNER, 30)
    row, col = np.concatenate([outer, inner[::-1]]).T
    area = abs(row @ np.roll(col, 1) - col @ np.roll(row, 1)) / 2
    region = between(outer, inner, (201, 201))
    assert region.sum() == pytest.approx(area, rel=0.01)
    np.testing.assert_array_equal(between(inner, outer, (201, 201)), region)
    np.testing.assert_array_equal(between(outer[::-1], inner[::-1], (201, 201)), region)


def test_curves_that_leave_the_slice_are_cut_at_its_edge():
    inside = between(arc(OUTER, 30), arc(INNER, 30), (201, 201))
    np.testing.assert_array_equal(between(arc(OUTER, 30), arc(INNER, 30), (35, 120)), inside[:35, :120])


def test_curves_that_run_through_bone_leave_it_alone(ring):
    bone = ring(INNER, OUTER, half_gap=20)
    bone[20:40, 98:103] = True  # a fragment in the gap
    found = patch(arc(OUTER + 2, 40), arc(INNER - 2, 40), bone)
    assert found.any()
    assert not (found & bone).any()


def test_only_pieces_that_reach_from_curve_to_curve_are_kept(ring):
    """Two hollows under the outer curve beside the gap are cut off from it, and touch one curve only."""
    bone = ring(INNER, OUTER, half_gap=15)
    dent = ring(69, OUTER, half_gap=20) ^ ring(69, OUTER, half_gap=40)
    found = patch(arc(OUTER, 45), arc(INNER, 45), bone & ~dent)
    sector = patch(arc(OUTER, 18), arc(INNER, 18), bone)
    assert sector.sum() > 0
    n = ndimage.label(found, np.ones((3, 3)))[1]
    assert n == 1
    assert not (found & dent).any()
    assert 2 * (found & sector).sum() / (found.sum() + sector.sum()) > 0.97


def test_slivers_along_the_bone_are_opened_away(ring):
    bone = ring(INNER, OUTER, half_gap=20)
    found = patch(arc(OUTER + 1, 60), arc(INNER, 60), bone)
    off = ring(INNER - 5, OUTER + 5, half_gap=24)
    assert not (found & off).any()


def test_without_a_gap_there_is_no_patch(ring):
    assert not patch(arc(OUTER - 1, 20), arc(INNER + 1, 20), ring(INNER, OUTER)).any()


@pytest.mark.parametrize("towards", [0, 45, 130])
def test_a_dented_ring_is_restored_to_its_hull(ring, towards):
    """The hull spans the dent by its chord, so what lay beyond the chord stays missing."""
    large = {"centre": (250.0, 250.0), "shape": (501, 501)}
    whole = ring(150, 180, **large)
    dent = ring(160, 181, **large) & ~ring(160, 181, half_gap=18, towards=towards, **large)
    found = partial_loss(whole & ~dent, min_area=40)
    angle, chord = np.radians(36), 2 * 180 * np.sin(np.radians(18))
    wanted = angle / 2 * (180**2 - 160**2) - 180**2 / 2 * (angle - np.sin(angle))
    assert abs(found.sum() - wanted) < 0.5 * chord  # half a pixel along the chord
    assert not (found & ~dent).any()


def test_a_whole_disk_ring_needs_nothing_but_pixels(ring):
    assert not partial_loss(ring(INNER, OUTER), min_area=16).any()


def test_small_dents_and_those_outside_the_region_stay(ring):
    whole = ring(INNER, OUTER)
    here, there = (ring(65, OUTER + 1) & ~ring(65, OUTER + 1, half_gap=18, towards=towards) for towards in (0, 180))
    bone = whole & ~here & ~there
    both = partial_loss(bone, min_area=4)
    assert (both & here).any() and (both & there).any()
    near = np.zeros_like(bone)
    near[:100] = True
    only_here = partial_loss(bone, min_area=4, region=near)
    np.testing.assert_array_equal(only_here, both & near)
    size = int((both & here).sum())
    assert partial_loss(bone, min_area=size, region=near).any()
    assert not partial_loss(bone, min_area=size + 1, region=near).any()


def test_the_main_piece_fills_most_of_the_opening_even_if_another_is_larger():
    patch_3d, opening = np.zeros((2, 5, 20, 20), bool)
    patch_3d[1:4, 2:6, 2:6] = True
    patch_3d[:, 10:20, 10:20] = True
    opening[1:4, 3:5, 3:5] = True
    opening[2, 12, 12] = True
    kept = main_piece(patch_3d, opening)
    np.testing.assert_array_equal(kept, patch_3d & (np.indices(patch_3d.shape)[1] < 8))


def test_the_main_piece_off_the_opening_is_the_largest_and_one_piece_is_itself():
    two = np.zeros((3, 10, 10), bool)
    two[:, 1:3, 1:3], two[:, 5:9, 5:9] = True, True
    off = np.zeros_like(two)
    off[0, 4, 4] = True
    assert main_piece(two, off).sum() == 3 * 16
    one = two & (np.indices(two.shape)[1] < 4)
    np.testing.assert_array_equal(main_piece(one, off), one)
    assert not main_piece(np.zeros_like(two), off).any()


def test_inputs_are_not_modified(ring):
    bone = ring(INNER, OUTER, half_gap=20)
    outer, inner = arc(OUTER, 25), arc(INNER, 25)
    before = [a.copy() for a in (bone, outer, inner)]
    patch(outer, inner, bone)
    partial_loss(bone, min_area=4)
    main_piece(np.stack([bone]), np.stack([bone]))
    for a, b in zip((bone, outer, inner), before, strict=True):
        np.testing.assert_array_equal(a, b)
