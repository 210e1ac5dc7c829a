"""The outer surface of a block and of a phantom, along rays from inside."""

import numpy as np

from cranio_nb.vault.orientation import head_centre
from cranio_nb.vault.outer_surface import measure_outer_surface, outermost_edge
from cranio_nb.volume import Volume


def test_the_surface_lies_where_the_blended_mask_falls_through_a_half():
    """On a block, whose faces are half a voxel beyond its outermost voxels, seen along the grid's axes."""
    voxels = np.zeros((60, 70, 80), bool)
    voxels[5:50, 8:60, 6:70] = True
    bone = Volume(voxels, np.array([[0, 0, 1.5, 0], [0, 1.7, 0, 0], [2.1, 0, 0, 0], [0, 0, 0, 1.0]]))
    centre = bone.to_world(np.array([25.0, 33.5, 38.0]))
    raw = outermost_edge(bone, centre, np.array([[1.0, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]]))
    np.testing.assert_allclose(raw, [31.5 * 1.5, 32.5 * 1.5, 26 * 1.7, 26 * 1.7, 24.5 * 2.1], atol=1e-5)


def test_radii_and_normals_are_those_of_the_phantom(phantom, skull):
    case, surface = phantom("unilateral"), measure_outer_surface(skull("unilateral"), head_centre(skull("unilateral")))
    p = surface.grid.centre + surface.offsets - case.head.centre
    away = np.linalg.norm(p, axis=1)
    off = away - case.head.outer_radius(p / away[:, None])
    assert abs(np.median(off)) < 0.5 and np.percentile(np.abs(off), 95) < 1.5  # voxels are 3 mm high
    gradients = case.head.gradients(p)[0]
    normals = gradients / np.linalg.norm(gradients, axis=1, keepdims=True)
    lean = np.einsum("ni,ni->n", normals, surface.normals[surface.known])
    assert np.median(lean) > np.cos(np.radians(3))


def test_the_surface_lies_on_itself_and_points_beyond_it_outside(skull):
    surface = measure_outer_surface(skull("unilateral"), head_centre(skull("unilateral")))
    deep = (surface.interior > 0)[surface.known]
    distance, normals = surface.distances(surface.offsets)
    np.testing.assert_allclose(distance[deep], 0, atol=1e-9)
    np.testing.assert_allclose(normals[deep], surface.normals[surface.known][deep], atol=1e-9)
    longer = surface.distances(surface.offsets * 1.02)[0]
    assert (longer[deep] > 0).all()
