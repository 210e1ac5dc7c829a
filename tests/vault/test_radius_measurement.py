"""The radius map of a spherical vault with a conical hole: every radius and every rim is known."""

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.opening import Opening
from cranio_nb.vault import radius_measurement
from cranio_nb.vault.radius_measurement import measure_around
from cranio_nb.vault.radius_voxels import voxels_between
from cranio_nb.volume import Volume

INNER, OUTER, HALF = 72.0, 80.0, 20.0  # mm, mm, degrees
CENTRE = np.array([-104.0, 33.0, -812.0])
TOWARDS = np.array([0.8, 0.3, 0.52]) / np.linalg.norm([0.8, 0.3, 0.52])


def head(spacing, bevel=0.0):
    """A hollow ball about a centre, its hole `bevel` degrees wider outside than inside, and the missing bone."""
    low = np.array([-30.0, -60.0, -50.0])  # (z, y, x) from the centre: the part around the hole
    shape = tuple((np.array([115.0, 145, 135]) / spacing).astype(int))
    affine = np.eye(4)
    affine[:3, :3] = np.eye(3)[:, ::-1] * spacing
    affine[:3, 3] = CENTRE + low[::-1]
    away = np.moveaxis(np.indices(shape), 0, -1) @ affine[:3, :3].T + low[::-1]
    radius = np.linalg.norm(away, axis=-1)
    angle = np.degrees(np.arccos(np.clip(away @ TOWARDS / np.maximum(radius, 1e-9), -1, 1)))
    whole = (radius >= INNER) & (radius <= OUTER)
    missing = whole & (angle < HALF + bevel * np.clip((radius - INNER) / (OUTER - INNER), 0, 1))
    sheet = (radius >= OUTER - 4) & (radius <= OUTER) & (angle < HALF)
    return Volume(whole & ~missing, affine), missing, Opening(Volume(sheet, affine), CENTRE)


def angles_of(radius_map):
    return np.degrees(np.arccos(np.clip(radius_map.grid.directions @ TOWARDS, -1, 1)))


@pytest.fixture(scope="module", params=[(1.0, 1.0, 1.0), (3.0, 1.0, 1.0)], ids=["even", "thick planes"])
def case(request):
    bone, missing, opening = head(request.param)
    return bone, missing, measure_around(bone, opening), max(request.param)


def test_radii_are_those_of_the_sphere(case):
    _, _, radius_map, step = case
    near = (angles_of(radius_map) > HALF + 4) & (angles_of(radius_map) < HALF + 25)
    assert np.isfinite(radius_map.outer[near]).all()
    for found, wanted in ((radius_map.outer, OUTER), (radius_map.inner, INNER)):
        off = found[near] - wanted
        assert abs(off.mean()) < 0.15 and np.sqrt((off**2).mean()) < 0.4 * step


def test_the_hole_is_the_cone(case):
    _, _, radius_map, step = case
    slack = np.degrees(1.5 * step / OUTER)
    angle = angles_of(radius_map)
    assert radius_map.hole[angle < HALF - slack].all()
    assert not radius_map.hole[angle > HALF + slack].any()


def test_directions_are_unit_vectors_about_the_opening_and_are_found_again(case):
    radius_map = case[2]
    np.testing.assert_allclose(np.linalg.norm(radius_map.grid.directions, axis=-1), 1, atol=1e-12)
    np.testing.assert_allclose(radius_map.grid.axes @ radius_map.grid.axes.T, np.eye(3), atol=1e-9)
    assert radius_map.grid.axes[2] @ TOWARDS > np.cos(np.radians(1))
    np.testing.assert_allclose(
        radius_map.grid.locate(3.7 * radius_map.grid.directions), np.indices(radius_map.outer.shape), atol=1e-6
    )


def test_the_true_radii_give_the_missing_bone_back(case):
    bone, missing, radius_map, step = case
    outer, inner = (np.where(radius_map.hole, radius, np.nan) for radius in (OUTER, INNER))
    patch = voxels_between(radius_map, bone, outer=outer, inner=inner)
    assert not (patch & bone.voxels).any()
    assert 2 * (patch & missing).sum() / (patch.sum() + missing.sum()) > (0.97 if step == 1 else 0.96)


def test_a_bevelled_rim_belongs_to_the_hole_up_to_85_percent_of_the_thickness():
    bone, _, opening = head((1.0, 1.0, 1.0), bevel=4.0)
    radius_map = measure_around(bone, opening)
    edge = angles_of(radius_map)[radius_map.hole ^ ndimage.binary_erosion(radius_map.hole)]
    assert np.median(edge) == pytest.approx(HALF + 0.85 * 4.0, abs=0.8)


def test_diploe_along_a_ray_is_not_the_end_of_the_bone():
    bone, _, opening = head((1.0, 1.0, 1.0))
    index = np.moveaxis(np.indices(bone.shape), 0, -1)
    radius = np.linalg.norm(bone.to_world(index) - CENTRE, axis=-1)
    spongy = Volume(bone.voxels & ~((radius > 75.0) & (radius < 77.0)), bone.affine)
    plain, radius_map = measure_around(bone, opening), measure_around(spongy, opening)
    near = (angles_of(radius_map) > HALF + 4) & (angles_of(radius_map) < HALF + 25)
    assert np.abs(radius_map.inner[near] - plain.inner[near]).mean() < 0.1


def test_a_turned_header_turns_the_map_and_changes_no_radius():
    bone, _, opening = head((3.0, 3.0, 3.0))
    c, s = np.cos(0.4), np.sin(0.4)
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), [70, -20, 500]
    there = Volume(bone.voxels, move @ bone.affine)
    centre = move[:3, :3] @ CENTRE + move[:3, 3]
    moved = measure_around(there, Opening(there.with_voxels(opening.sheet.voxels), centre))
    here = measure_around(bone, opening)
    np.testing.assert_allclose(moved.grid.axes, here.grid.axes @ move[:3, :3].T, atol=1e-9)
    np.testing.assert_allclose(moved.outer, here.outer, atol=1e-5)
    np.testing.assert_array_equal(moved.hole, here.hole)


def test_a_skull_that_is_measured_again_is_not_taken_for_another():
    bone, _, opening = head((3.0, 3.0, 3.0))
    first = measure_around(bone, opening)
    assert measure_around(Volume(bone.voxels.copy(), bone.affine), opening) is first
    with pytest.raises(ValueError, match="read-only"):
        first.hole[0, 0] = True
    bone.voxels[:10] = False  # the same array, another skull
    changed = measure_around(bone, opening)
    assert np.isfinite(changed.outer).sum() < np.isfinite(first.outer).sum()


def test_only_the_newest_maps_are_kept(monkeypatch):
    monkeypatch.setattr(radius_measurement, "_maps", kept := {})
    monkeypatch.setattr(radius_measurement, "_KEPT", 1)
    bone, _, opening = head((3.0, 3.0, 3.0))
    first = measure_around(bone, opening)
    assert list(kept.values()) == [first]
    second = measure_around(bone.with_voxels(np.roll(bone.voxels, 1, axis=1)), opening)
    assert list(kept.values()) == [second]
