import numpy as np
import pytest
from spherical_cap import CENTRE, HALF_ANGLE, RADIUS, spherical_cap

from cranio_nb.geometry.face_sides import label_faces
from cranio_nb.mesh import INNER, OUTER, RIM
from cranio_nb.stages.surface_reconstruction import extract_surface
from cranio_nb.volume import Volume


@pytest.mark.parametrize("spacing", [(0.9, 0.8, 0.8), (2.5, 0.8, 0.8)])
@pytest.mark.parametrize("thickness", [3.5, 6.0])
def test_sides_of_a_cap_are_those_of_its_geometry(spacing, thickness):
    patch, bone, towards = spherical_cap(spacing, thickness=thickness)
    mesh = extract_surface(patch)
    sides = label_faces(mesh, bone, CENTRE)
    assert sides.shape == (len(mesh.faces),) and sides.dtype == np.uint8
    offset = mesh.centres - CENTRE
    radius = np.linalg.norm(offset, axis=1)
    from_rim = np.abs(np.radians(HALF_ANGLE) - np.arccos(np.clip(offset @ towards / radius, -1, 1))) * radius
    away = np.stack([np.abs(radius - RADIUS), np.abs(radius - RADIUS + thickness), from_rim])
    order = np.sort(away, axis=0)
    clear = order[1] - order[0] > 1.0  # the edge between two sides belongs to either
    truth = np.array([OUTER, INNER, RIM])[away.argmin(axis=0)]
    assert np.average(sides[clear] == truth[clear], weights=mesh.areas[clear]) > 0.999


def test_a_wall_that_leans_is_rim_where_bone_lies_against_it():
    voxels = np.zeros((24, 40, 40), bool)
    bone = voxels.copy()
    plane, row, _ = np.indices(voxels.shape)
    plate = (plane >= 8) & (plane < 16)
    voxels[plate & (row >= 14 + plane // 2)] = True  # a wall at 26 deg to the way up
    bone[plate & ~voxels] = True
    affine = np.array([[0, 0, 1, 0], [0, 1, 0, 0], [1, 0, 0, 0], [0, 0, 0, 1.0]])
    mesh = extract_surface(Volume(voxels, affine))
    sides = label_faces(mesh, Volume(bone, affine), np.array([20.0, 20.0, -60.0]))
    x, y, z = mesh.centres.T
    wall = (np.abs(y - (13.5 + z / 2)) < 1) & (z > 9) & (z < 14) & (x > 2) & (x < 37)
    assert wall.sum() > 50
    assert (sides[wall] == RIM).all()
