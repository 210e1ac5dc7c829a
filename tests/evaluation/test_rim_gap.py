"""Gaps between rims and blocks of bone that stand a known distance apart."""

import dataclasses

import numpy as np
import pytest
from measured_shapes import block, oblique

from cranio_nb.evaluation.rim_gap import distance_to_voxels, rim_gap
from cranio_nb.mesh import Mesh
from cranio_nb.volume import Volume


def test_distance_to_a_voxel_is_to_its_box():
    mask = Volume(block((4, 8, 8), (1, 1, 1)), oblique((2.5, 0.45, 0.6)))
    index = np.array([[4, 8, 8], [4.4, 8.5, 7.6], [5.5, 8, 8], [4, 9.5, 8], [4, 8.2, 5.5], [6.5, 10.5, 8]])
    wanted = [0, 0, 2.5, 0.45, 1.2, np.hypot(5, 0.9)]
    np.testing.assert_allclose(distance_to_voxels(mask.to_world(index), mask), wanted, atol=1e-9)


def test_gap_of_a_rim_that_stands_off_is_known():
    bone = Volume(block((0, 0, 0), (16, 40, 20)), np.eye(4))  # its face stands at column 19.5
    for gap in (0.0, 0.3, 1.5):
        wall = Mesh(np.array([[2, 2, 19.5 + gap], [12, 2, 19.5 + gap], [2, 30, 19.5 + gap]]), np.array([[0, 1, 2]]))
        found = rim_gap(wall, bone)
        np.testing.assert_allclose(dataclasses.astuple(found), gap, atol=1e-9)


def test_gap_is_weighted_by_area():
    bone = Volume(block((0, 0, 0), (16, 40, 20)), np.eye(4))
    near = [[2, 2, 19.5], [12, 2, 19.5], [2, 22, 19.5]]  # 100 mm2 that touch
    off = [[2, 2, 21.5], [4, 2, 21.5], [2, 3, 21.5]]  # 1 mm2 at 2 mm
    found = rim_gap(Mesh(np.array(near + off, float), np.array([[0, 1, 2], [3, 4, 5]])), bone)
    assert found.mean == pytest.approx(2 / 101)
    assert (found.p95, found.max) == (0, 2)


@pytest.mark.parametrize("away_mm", [0.0, 5.0, 30.0])
def test_distances_are_those_to_all_boxes_near_or_far(away_mm):
    rng = np.random.default_rng(5)
    mask = Volume(rng.random((12, 30, 30)) < 0.02, oblique((2.5, 0.45, 0.6)))
    points = mask.to_world(rng.uniform((0, 0, 0), (12, 12, 12), (40, 3))) + np.array([away_mm, 0, 0])
    apart = mask.to_voxel(points)[:, None] - np.argwhere(mask.voxels)
    wanted = np.linalg.norm((apart - np.clip(apart, -0.5, 0.5)) @ mask.edges, axis=2).min(axis=1)
    found = distance_to_voxels(points, mask)
    # the nearest box is looked for among the eight nearest centres: seldom another one, never a nearer one
    assert (found >= wanted - 1e-9).all() and np.isclose(found, wanted).mean() > 0.9
