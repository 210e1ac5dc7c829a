"""Where voxels stand: affine maps, axis orders, crops."""

from dataclasses import FrozenInstanceError
from itertools import permutations, product

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.grid import AxisOrder, canonical_order
from cranio_nb.volume import Volume, check_same_grid, same_grid

ORDERS = [AxisOrder(axes, flips) for axes in permutations(range(3)) for flips in product((False, True), repeat=3)]


def turn(axis, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    i, j = [k for k in range(3) if k != axis]
    matrix = np.eye(3)
    matrix[[i, i, j, j], [i, j, i, j]] = c, -s, s, c
    return matrix


def oblique(shape=(4, 5, 6), spacing=(3.0, 0.8, 0.5), origin=(-104.5, 33.25, -812.0), degrees=17.0):
    """Every voxel its own number, on a leaning, unequal grid far from the origin; planes up, rows back, cols left."""
    affine = np.eye(4)
    upright = np.eye(3)[:, ::-1] * spacing
    affine[:3, :3] = turn(0, degrees) @ turn(2, -degrees / 2) @ upright
    affine[:3, 3] = origin
    return Volume(np.arange(np.prod(shape)).reshape(shape), affine)


def places(volume):
    """World place of every voxel, in the order of the numbers the voxels carry."""
    index = np.argwhere(np.ones(volume.shape, bool))
    return volume.to_world(index)[np.argsort(volume.voxels.ravel())]


@pytest.mark.parametrize("order", ORDERS, ids=str)
def test_every_one_of_48_axis_orders_comes_back_to_one_canonical_grid(order):
    wanted = oblique()
    stored = wanted.reorder(order)
    np.testing.assert_allclose(places(stored), places(wanted), atol=1e-9)
    np.testing.assert_array_equal(stored.canonical().voxels, wanted.voxels)
    np.testing.assert_allclose(stored.canonical().affine, wanted.affine, atol=1e-9)


@pytest.mark.parametrize("order", ORDERS, ids=str)
def test_an_axis_order_and_its_inverse_cancel(order):
    v = oblique()
    for back in (v.reorder(order).reorder(order.inverse), v.reorder(order.inverse).reorder(order)):
        np.testing.assert_array_equal(back.voxels, v.voxels)
        np.testing.assert_allclose(back.affine, v.affine, atol=1e-9)
    assert order.inverse.inverse == order


@pytest.mark.parametrize("degrees", [-40, -20, 0, 20, 40])
def test_canonical_axes_rise_to_the_top_the_back_and_the_left(degrees):
    directions = oblique(degrees=degrees).reorder(ORDERS[13]).canonical().affine[:3, :3]
    up, back, left = (directions / np.linalg.norm(directions, axis=0)).T
    assert up[2] > 0.5 and back[1] > 0.5 and left[0] > 0.5


def test_canonical_leaves_a_canonical_volume_as_it_is():
    v = oblique()
    assert canonical_order(v.affine) == AxisOrder((0, 1, 2), (False, False, False))
    assert np.shares_memory(v.canonical().voxels, v.voxels)  # permuted and flipped, never resampled


def test_world_and_voxel_are_inverse_and_affine():
    v, rng = oblique(), np.random.default_rng(0)
    index = rng.uniform(-50, 50, (7, 11, 3))
    np.testing.assert_allclose(v.to_voxel(v.to_world(index)), index, atol=1e-10)
    np.testing.assert_array_equal(v.to_world([0, 0, 0]), v.affine[:3, 3])
    np.testing.assert_allclose(v.to_world([0, 2, 0]) - v.to_world([0, 0, 0]), 2 * v.affine[:3, 1])


def test_spacing_and_voxel_volume_of_a_leaning_and_of_a_sheared_grid():
    v = oblique(spacing=(3.0, 0.8, 0.5))
    np.testing.assert_allclose(v.spacing, [3.0, 0.8, 0.5])
    assert v.voxel_volume == pytest.approx(1.2)
    tilted = v.affine.copy()
    tilted[:3, 0] += 0.7 * v.affine[:3, 1] / 0.8  # planes slide 0.7 mm along the rows: same gap, longer step
    sheared = Volume(v.voxels, tilted)
    assert sheared.voxel_volume == pytest.approx(1.2)
    assert sheared.spacing[0] == pytest.approx(np.hypot(3.0, 0.7))


@pytest.mark.parametrize("box", [np.s_[1:3, :, 2:], np.s_[-2:, 1:-1, :-3], np.s_[:, :, :], np.s_[3:4, 4:5, 5:6]])
def test_a_crop_stands_at_the_same_place(box):
    v = oblique()
    part = v.crop(box)
    np.testing.assert_array_equal(part.voxels, v.voxels[box])
    np.testing.assert_allclose(places(part), places(v)[np.sort(part.voxels.ravel())], atol=1e-9)


def test_a_crop_of_a_crop_is_one_crop():
    v = oblique()
    twice, once = v.crop(np.s_[1:, 1:, 1:]).crop(np.s_[1:, :2, 2:]), v.crop(np.s_[2:, 1:3, 3:])
    np.testing.assert_array_equal(twice.voxels, once.voxels)
    np.testing.assert_allclose(twice.affine, once.affine, atol=1e-9)


def test_nothing_modifies_the_volume_it_came_from():
    v = oblique()
    voxels, affine = v.voxels.copy(), v.affine.copy()
    v.crop(np.s_[1:, 1:, 1:]).affine[:] = 0
    v.reorder(ORDERS[29]).affine[:] = 0
    v.canonical()
    np.testing.assert_array_equal(v.voxels, voxels)
    np.testing.assert_array_equal(v.affine, affine)
    with pytest.raises(FrozenInstanceError):
        v.voxels = voxels


def test_other_voxels_keep_the_grid_or_are_refused():
    v = oblique()
    mask = v.with_voxels(v.voxels > 3)
    assert mask.voxels.dtype == bool and same_grid(mask, v)
    with pytest.raises(InputRefused, match=r"\(4, 5, 5\).*\(4, 5, 6\)") as refused:
        v.with_voxels(v.voxels[:, :, 1:])
    assert refused.value.code == "GridMismatch"


@pytest.mark.parametrize("shape", [(), (3,), (3, 4), (2, 3, 4, 5)])
def test_voxels_must_have_three_dimensions(shape):
    with pytest.raises(InputRefused, match=f"{len(shape)} dimensions; 3") as refused:
        Volume(np.zeros(shape), np.eye(4))
    assert refused.value.code == "BadShape"


@pytest.mark.parametrize(
    "affine",
    [np.eye(3), np.diag([1, 0, 1, 1]), np.diag([1, np.nan, 1, 1]), np.diag([1, 1, np.inf, 1]), np.ones((4, 4))],
    ids=["3 x 3", "flat", "nan", "inf", "singular"],
)
def test_an_affine_must_be_finite_and_invertible(affine):
    with pytest.raises(InputRefused) as refused:
        Volume(np.zeros((2, 2, 2)), affine)
    assert refused.value.code == "BadGeometry"


def test_same_grid_looks_at_the_corners():
    v = oblique()
    moved = v.affine.copy()
    moved[0, 3] += 0.04
    assert same_grid(v, Volume(v.voxels, moved))
    assert not same_grid(v, Volume(v.voxels, moved), tol=0.03)
    stretched = v.affine.copy()
    stretched[:3, 0] *= 1.01  # the first corner agrees, the last is 3 * 3 mm * 1 % = 0.09 mm off
    assert not same_grid(v, Volume(v.voxels, stretched))
    assert not same_grid(v, v.crop(np.s_[:3, :, :]))
    assert not same_grid(v, v.reorder(AxisOrder((0, 1, 2), (True, False, False))))


def test_a_value_is_that_of_the_voxel_around_the_point():
    v = oblique()
    index = np.argwhere(np.ones(v.shape, bool))
    nudge = np.random.default_rng(4).uniform(-0.45, 0.45, index.shape)
    np.testing.assert_array_equal(v.at(v.to_world(index + nudge), outside=-1), v.voxels.ravel())
    assert (v.at(v.to_world(index + np.array(v.shape)), outside=-1) == -1).all()


def test_steps_and_axes_undo_each_other():
    v = oblique()
    np.testing.assert_allclose(np.linalg.norm(v.axes, axis=1), 1)
    np.testing.assert_allclose(v.axes * v.spacing[:, None], v.edges)
    np.testing.assert_allclose(v.steps(v.edges), np.eye(3), atol=1e-12)
    away = np.array([3.0, -4.0, 1.0])
    np.testing.assert_allclose(v.to_voxel(v.to_world([1, 2, 3]) + away), np.array([1, 2, 3]) + v.steps(away), atol=1e-9)


def test_the_box_of_a_mask_is_the_least_that_holds_it():
    mask = np.zeros((6, 7, 8), bool)
    mask[2:4, 5, 1:7] = True
    v = Volume(mask, np.eye(4))
    assert v.crop(v.box()).voxels.shape == (2, 1, 6) and v.crop(v.box()).voxels.all()
    assert v.box((0, 9, 1)) == (slice(2, 4), slice(0, 7), slice(0, 8))
    assert v.crop(v.with_voxels(~mask & mask).box()).voxels.size == 0


def test_volumes_on_other_grids_are_refused_by_name():
    v = oblique()
    check_same_grid(v, v.with_voxels(v.voxels * 2), "patch and bone")
    with pytest.raises(InputRefused, match="patch and bone") as refused:
        check_same_grid(v, v.crop(np.s_[1:, :, :]), "patch and bone")
    assert refused.value.code == "GridMismatch"


def test_grids_of_one_shape_are_told_apart_by_voxel_and_corner():
    v = Volume(np.zeros((2, 3, 4), bool), np.diag([2.5, 0.9, 0.9, 1.0]))
    thinner = Volume(v.voxels, np.diag([2.0, 0.9, 0.9, 1.0]))
    with pytest.raises(InputRefused, match=r"\[2\.5 0\.9 0\.9\] mm .* \[2\. +0\.9 0\.9\] mm"):
        check_same_grid(v, thinner, "patch and bone")
