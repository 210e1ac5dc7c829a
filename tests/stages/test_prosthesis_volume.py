"""Patches of drawn gaps whose area is known."""

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.stages.prosthesis_volume import fill_gap, fill_partial_loss, pixels_between

INNER, OUTER = 60.0, 75.0


def arc(radius, half, towards=0.0, n=41, centre=100.0):
    at = np.radians(towards + np.linspace(-half, half, n))
    return centre + radius * np.stack([-np.cos(at), np.sin(at)], axis=1)


@pytest.mark.parametrize(("half", "towards"), [(15, 0), (25, 37), (40, 200)])
def test_the_patch_of_a_ring_is_the_missing_sector(ring, half, towards):
    bone = ring(INNER, OUTER, half_gap=half, towards=towards)
    sector = ring(INNER, OUTER) & ~bone
    found = fill_gap(arc(OUTER, half + 3, towards), arc(INNER, half + 3, towards), bone)
    assert found.sum() == pytest.approx(np.radians(half) * (OUTER**2 - INNER**2), rel=0.02)
    assert 2 * (found & sector).sum() / (found.sum() + sector.sum()) > 0.98
    assert not (found & bone).any()


def test_the_area_between_two_curves_is_that_of_the_polygon():
    outer, inner = arc(OUTER, 30), arc(INNER, 30)
    row, col = np.concatenate([outer, inner[::-1]]).T
    area = abs(row @ np.roll(col, 1) - col @ np.roll(row, 1)) / 2
    region = pixels_between(outer, inner, (201, 201))
    assert region.sum() == pytest.approx(area, rel=0.01)
    np.testing.assert_array_equal(pixels_between(inner, outer, (201, 201)), region)
    np.testing.assert_array_equal(pixels_between(outer[::-1], inner[::-1], (201, 201)), region)


def test_curves_that_leave_the_slice_are_cut_at_its_edge():
    inside = pixels_between(arc(OUTER, 30), arc(INNER, 30), (201, 201))
    np.testing.assert_array_equal(pixels_between(arc(OUTER, 30), arc(INNER, 30), (35, 120)), inside[:35, :120])


def test_curves_that_run_through_bone_leave_it_alone(ring):
    bone = ring(INNER, OUTER, half_gap=20)
    bone[20:40, 98:103] = True  # a fragment in the gap
    found = fill_gap(arc(OUTER + 2, 40), arc(INNER - 2, 40), bone)
    assert found.any()
    assert not (found & bone).any()


def test_only_pieces_that_reach_from_curve_to_curve_are_kept(ring):
    """Two hollows under the outer curve beside the gap are cut off from it, and touch one curve only."""
    bone = ring(INNER, OUTER, half_gap=15)
    dent = ring(69, OUTER, half_gap=20) ^ ring(69, OUTER, half_gap=40)
    found = fill_gap(arc(OUTER, 45), arc(INNER, 45), bone & ~dent)
    sector = fill_gap(arc(OUTER, 18), arc(INNER, 18), bone)
    assert sector.sum() > 0
    n = ndimage.label(found, np.ones((3, 3)))[1]
    assert n == 1
    assert not (found & dent).any()
    assert 2 * (found & sector).sum() / (found.sum() + sector.sum()) > 0.97


def test_slivers_along_the_bone_are_opened_away(ring):
    bone = ring(INNER, OUTER, half_gap=20)
    found = fill_gap(arc(OUTER + 1, 60), arc(INNER, 60), bone)
    off = ring(INNER - 5, OUTER + 5, half_gap=24)
    assert not (found & off).any()


def test_without_a_gap_there_is_no_patch(ring):
    assert not fill_gap(arc(OUTER - 1, 20), arc(INNER + 1, 20), ring(INNER, OUTER)).any()


@pytest.mark.parametrize("towards", [0, 45, 130])
def test_a_dented_ring_is_restored_to_its_hull(ring, towards):
    """The hull spans the dent by its chord, so what lay beyond the chord stays missing."""
    large = {"centre": (250.0, 250.0), "shape": (501, 501)}
    whole = ring(150, 180, **large)
    dent = ring(160, 181, **large) & ~ring(160, 181, half_gap=18, towards=towards, **large)
    found = fill_partial_loss(whole & ~dent, min_area_px=40)
    angle, chord = np.radians(36), 2 * 180 * np.sin(np.radians(18))
    wanted = angle / 2 * (180**2 - 160**2) - 180**2 / 2 * (angle - np.sin(angle))
    assert abs(found.sum() - wanted) < 0.5 * chord  # half a pixel along the chord
    assert not (found & ~dent).any()


def test_a_whole_disk_ring_needs_nothing_but_pixels(ring):
    assert not fill_partial_loss(ring(INNER, OUTER), min_area_px=16).any()


def test_small_dents_and_those_outside_the_region_stay(ring):
    whole = ring(INNER, OUTER)
    here, there = (ring(65, OUTER + 1) & ~ring(65, OUTER + 1, half_gap=18, towards=towards) for towards in (0, 180))
    bone = whole & ~here & ~there
    both = fill_partial_loss(bone, min_area_px=4)
    assert (both & here).any() and (both & there).any()
    near = np.zeros_like(bone)
    near[:100] = True
    only_here = fill_partial_loss(bone, min_area_px=4, region=near)
    np.testing.assert_array_equal(only_here, both & near)
    size = int((both & here).sum())
    assert fill_partial_loss(bone, min_area_px=size, region=near).any()
    assert not fill_partial_loss(bone, min_area_px=size + 1, region=near).any()


def test_inputs_are_not_modified(ring):
    bone = ring(INNER, OUTER, half_gap=20)
    outer, inner = arc(OUTER, 25), arc(INNER, 25)
    before = [a.copy() for a in (bone, outer, inner)]
    fill_gap(outer, inner, bone)
    fill_partial_loss(bone, min_area_px=4)
    for a, b in zip((bone, outer, inner), before, strict=True):
        np.testing.assert_array_equal(a, b)
