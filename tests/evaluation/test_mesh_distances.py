"""Distances between surfaces whose distance is known; thickness of shells."""

from dataclasses import replace

import numpy as np
import pytest
from measured_shapes import box, join, oblique, shell, sphere

from cranio_nb.errors import InputRefused
from cranio_nb.evaluation.mesh_distances import (
    distance_stats,
    in_voxels,
    signed_distance,
    surface_distance,
    thickness,
    thickness_error,
    thickness_rmse,
)
from cranio_nb.mesh import INNER, OUTER, Mesh
from cranio_nb.volume import Volume


def test_nodes_of_a_sphere_lie_the_difference_of_radii_from_another():
    found = distance_stats(surface_distance(sphere(10).vertices, sphere(8)))
    assert found.min == pytest.approx(2, abs=1e-9)
    assert 2 <= found.mean <= found.max < 2.03
    assert found.std < 0.01


def test_one_way_distance_is_zero_where_the_other_surface_is_larger():
    whole = sphere(5)
    part = Mesh(whole.vertices, whole.faces[whole.centres[:, 2] > 0])
    used = np.unique(part.faces)
    np.testing.assert_allclose(surface_distance(whole.vertices[used], part), 0, atol=1e-12)
    assert surface_distance(whole.vertices, part).max() > 5


def test_a_few_long_faces_among_many_small_ones_are_not_missed():
    far_plate = Mesh(np.array([[-500, -500, -3.0], [500, -500, -3], [0, 800, -3]]), np.array([[0, 1, 2]]))
    mesh = join(sphere(1), far_plate)
    points = np.array([[0, 0, 1.5], [100, 0, 0], [0, 0, -2.5]])
    np.testing.assert_allclose(surface_distance(points, mesh), (0.5, 3, 0.5), atol=0.01)


def test_sign_tells_outside_from_inside_at_faces_edges_and_corners():
    rng = np.random.default_rng(2)
    points = rng.uniform(-2, 2, (2000, 3))
    outside = np.maximum(np.abs(points) - 0.5, 0)
    wanted = np.linalg.norm(outside, axis=1) - np.maximum(0.5 - np.abs(points).max(axis=1), 0)
    np.testing.assert_allclose(signed_distance(points, box()), wanted, atol=1e-12)


def test_distances_in_voxels_do_not_depend_on_the_grid_in_the_world():
    grid = Volume(np.zeros((2, 2, 2), bool), oblique((2.5, 0.45, 0.45)))
    inner, outer = (in_voxels(Mesh(grid.to_world(m.vertices), m.faces), grid) for m in (sphere(8), sphere(10)))
    np.testing.assert_allclose(surface_distance(outer.vertices, inner), 2, atol=0.03)


def test_thickness_of_ashell():
    thin, thick = (shell(10, inner) for inner in (8.0, 7.5))
    np.testing.assert_allclose(thickness(thin), 2, atol=0.03)
    assert thickness_rmse(thin, thin) == 0
    assert thickness_rmse(thin, thick) == pytest.approx(0.5, abs=0.03)


def test_no_surface_is_refused():
    nothing = Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
    for measure in (lambda: surface_distance(np.zeros((1, 3)), nothing), lambda: distance_stats(np.zeros(0))):
        with pytest.raises(InputRefused) as refusal:
            measure()
        assert refusal.value.code == "EmptyMesh" and "no" in refusal.value.message


@pytest.mark.parametrize("bare", [0, 1])
def test_a_prosthesis_without_an_outer_side_has_no_thickness_to_compare(bare):
    pair = [shell(10, 8), shell(10, 8)]
    pair[bare] = replace(pair[bare], sides=np.full_like(pair[bare].sides, INNER))
    values = [np.ones(len(one.surface(OUTER).vertices)) for one in pair]
    with pytest.raises(InputRefused, match="without an outer side") as refusal:
        thickness_error(pair[0], values[0], pair[1], values[1])
    assert refusal.value.code == "EmptyMesh"


def test_thickness_is_compared_at_the_nearest_true_node():
    one = shell(10, 8)
    values = np.arange(len(one.surface(OUTER).vertices), dtype=float)
    assert thickness_error(one, values, one, values) == 0
    assert thickness_error(one, values + 3, one, values) == pytest.approx(3)
    assert thickness_error(one, values, one, values[::-1]) == pytest.approx(
        np.sqrt(((values - values[::-1]) ** 2).mean())
    )
