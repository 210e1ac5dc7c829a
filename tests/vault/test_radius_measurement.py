"""The radial chart of a spherical vault with a conical hole: every radius and every rim is known."""

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.opening import Opening
from cranio_nb.vault.radius_map import look, voxelise
from cranio_nb.volume import Volume

INNER, OUTER, HALF = 72.0, 80.0, 20.0  # mm, mm, degrees
EYE = np.array([-104.0, 33.0, -812.0])
TOWARDS = np.array([0.8, 0.3, 0.52]) / np.linalg.norm([0.8, 0.3, 0.52])


def head(spacing, bevel=0.0):
    """A hollow ball about the eye, its hole `bevel` degrees wider outside than inside, and the missing bone."""
    low = np.array([-30.0, -60.0, -50.0])  # (z, y, x) from the eye: the part around the hole
    shape = tuple((np.array([115.0, 145, 135]) / spacing).astype(int))
    affine = np.eye(4)
    affine[:3, :3] = np.eye(3)[:, ::-1] * spacing
    affine[:3, 3] = EYE + low[::-1]
    away = np.moveaxis(np.indices(shape), 0, -1) @ affine[:3, :3].T + low[::-1]
    radius = np.linalg.norm(away, axis=-1)
    angle = np.degrees(np.arccos(np.clip(away @ TOWARDS / np.maximum(radius, 1e-9), -1, 1)))
    whole = (radius >= INNER) & (radius <= OUTER)
    missing = whole & (angle < HALF + bevel * np.clip((radius - INNER) / (OUTER - INNER), 0, 1))
    sheet = (radius >= OUTER - 4) & (radius <= OUTER) & (angle < HALF)
    return Volume(whole & ~missing, affine), missing, Opening(Volume(sheet, affine), EYE)


def angles_of(chart):
    return np.degrees(np.arccos(np.clip(chart.directions @ TOWARDS, -1, 1)))


@pytest.fixture(scope="module", params=[(1.0, 1.0, 1.0), (3.0, 1.0, 1.0)], ids=["even", "thick planes"])
def case(request):
    bone, missing, opening = head(request.param)
    return bone, missing, look(bone, opening), max(request.param)


def test_radii_are_those_of_the_sphere(case):
    _, _, chart, step = case
    near = (angles_of(chart) > HALF + 4) & (angles_of(chart) < HALF + 25)
    assert np.isfinite(chart.outer[near]).all()
    for found, wanted in ((chart.outer, OUTER), (chart.inner, INNER)):
        off = found[near] - wanted
        assert abs(off.mean()) < 0.15 and np.sqrt((off**2).mean()) < 0.4 * step


def test_the_hole_is_the_cone(case):
    _, _, chart, step = case
    slack = np.degrees(1.5 * step / OUTER)
    angle = angles_of(chart)
    assert chart.hole[angle < HALF - slack].all()
    assert not chart.hole[angle > HALF + slack].any()


def test_directions_are_unit_vectors_about_the_opening_and_are_found_again(case):
    chart = case[2]
    np.testing.assert_allclose(np.linalg.norm(chart.directions, axis=-1), 1, atol=1e-12)
    np.testing.assert_allclose(chart.axes @ chart.axes.T, np.eye(3), atol=1e-9)
    assert chart.axes[2] @ TOWARDS > np.cos(np.radians(1))
    np.testing.assert_allclose(chart.locate(3.7 * chart.directions), np.indices(chart.outer.shape), atol=1e-6)


def test_the_true_radii_give_the_missing_bone_back(case):
    bone, missing, chart, step = case
    outer, inner = (np.where(chart.hole, radius, np.nan) for radius in (OUTER, INNER))
    patch = voxelise(chart, outer, inner, bone)
    assert not (patch & bone.voxels).any()
    assert 2 * (patch & missing).sum() / (patch.sum() + missing.sum()) > (0.97 if step == 1 else 0.96)


def test_a_bevelled_rim_belongs_to_the_hole_up_to_85_percent_of_the_thickness():
    bone, _, opening = head((1.0, 1.0, 1.0), bevel=4.0)
    chart = look(bone, opening)
    edge = angles_of(chart)[chart.hole ^ ndimage.binary_erosion(chart.hole)]
    assert np.median(edge) == pytest.approx(HALF + 0.85 * 4.0, abs=0.8)


def test_diploe_along_a_ray_is_not_the_end_of_the_bone():
    bone, _, opening = head((1.0, 1.0, 1.0))
    index = np.moveaxis(np.indices(bone.shape), 0, -1)
    radius = np.linalg.norm(bone.to_world(index) - EYE, axis=-1)
    spongy = Volume(bone.voxels & ~((radius > 75.0) & (radius < 77.0)), bone.affine)
    plain, chart = look(bone, opening), look(spongy, opening)
    near = (angles_of(chart) > HALF + 4) & (angles_of(chart) < HALF + 25)
    assert np.abs(chart.inner[near] - plain.inner[near]).mean() < 0.1


def test_a_turned_header_turns_the_chart_and_changes_no_radius():
    bone, _, opening = head((3.0, 3.0, 3.0))
    c, s = np.cos(0.4), np.sin(0.4)
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]), [70, -20, 500]
    there = Volume(bone.voxels, move @ bone.affine)
    eye = move[:3, :3] @ EYE + move[:3, 3]
    moved = look(there, Opening(there.with_voxels(opening.sheet.voxels), eye))
    here = look(bone, opening)
    np.testing.assert_allclose(moved.axes, here.axes @ move[:3, :3].T, atol=1e-9)
    np.testing.assert_allclose(moved.outer, here.outer, atol=1e-5)
    np.testing.assert_array_equal(moved.hole, here.hole)
