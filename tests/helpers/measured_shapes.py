"""Masks and meshes that many tests measure: blocks on leaning grids, balls, boxes, shells."""

import numpy as np
import pytest

from cranio_nb.mesh import INNER, OUTER, Mesh
from cranio_nb.prosthesis import Prosthesis

EMPTY = np.zeros((6, 7, 8), bool)


def oblique(spacing=(2.5, 0.45, 0.6), flip=(1, 1, 1)):
    rotation = np.linalg.qr(np.array([[0.2, 0.1, 1], [0.3, 1, 0], [1, -0.2, 0.1]]))[0]
    affine = np.eye(4)
    affine[:3, :3] = rotation * flip * spacing
    affine[:3, 3] = (40.0, -95.0, 812.0)
    return affine


def block(start, size=(6, 20, 20), shape=(16, 40, 40)):
    voxels = np.zeros(shape, bool)
    voxels[tuple(slice(a, a + n) for a, n in zip(start, size, strict=True))] = True
    return voxels


def sphere(radius=1.0, centre=(0, 0, 0), subdivisions=4):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return Mesh(np.asarray(ball.vertices) + centre, np.asarray(ball.faces, np.intp))


def join(*meshes):
    offsets = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    faces = [m.faces + n for m, n in zip(meshes, offsets, strict=True)]
    return Mesh(np.concatenate([m.vertices for m in meshes]), np.concatenate(faces))


def weld(mesh):
    vertices, which = np.unique(mesh.vertices.round(9), axis=0, return_inverse=True)
    return Mesh(vertices, which.ravel()[mesh.faces])


def box(size=(1, 1, 1), centre=(0, 0, 0)):
    trimesh = pytest.importorskip("trimesh")
    made = trimesh.creation.box(extents=size)
    return Mesh(np.asarray(made.vertices) + centre, np.asarray(made.faces, np.intp))


def shell(outer, inner):
    out, within = sphere(outer), sphere(inner)
    mesh = join(out, Mesh(within.vertices, within.faces[:, ::-1]))
    sides = np.repeat(np.array([OUTER, INNER], np.uint8), [len(out.faces), len(within.faces)])
    return Prosthesis(mesh, sides, None, "none")
