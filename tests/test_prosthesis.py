"""The nouns that go into a design and come out of it, and the errors' common shape."""

import numpy as np
import pytest

from cranio_nb import errors
from cranio_nb.mesh import INNER, OUTER, RIM, Mesh
from cranio_nb.opening import Opening
from cranio_nb.prosthesis import Prosthesis
from cranio_nb.volume import Volume


@pytest.fixture
def opening():
    """A box of opening on planes 2 to 4, on a grid that is unequal, mirrored and far from the origin."""
    affine = np.array([[0, 0, -0.5, 40.0], [0, 0.8, 0, -141.5], [3.0, 0, 0, -862.75], [0, 0, 0, 1.0]])
    voxels = np.zeros((8, 10, 12), bool)
    voxels[2:5, 1:4, 6:9] = True
    return Opening(Volume(voxels, affine), np.array([37.0, -139.9, -900.0]))


def test_planes_of_an_opening_are_half_open(opening):
    assert opening.planes == (2, 5)
    assert opening.sheet.voxels[slice(*opening.planes)].any(axis=(1, 2)).all()


def test_centre_and_direction_of_an_opening_are_in_the_world(opening):
    np.testing.assert_allclose(opening.centre, [40 - 0.5 * 7, -141.5 + 0.8 * 2, -862.75 + 3 * 3])
    towards = np.array([-0.5, 0.0, 46.25])
    np.testing.assert_allclose(opening.direction, towards / np.linalg.norm(towards), atol=1e-12)


def test_direction_does_not_depend_on_where_the_head_lies(opening):
    shift = np.array([120.0, -35.0, 800.0])
    affine = opening.sheet.affine.copy()
    affine[:3, 3] += shift
    moved = Opening(Volume(opening.sheet.voxels, affine), opening.head_centre + shift)
    np.testing.assert_allclose(moved.direction, opening.direction, atol=1e-12)


def test_the_three_sides_share_out_the_surface():
    rng = np.random.default_rng(5)
    mesh = Mesh(rng.normal(size=(30, 3)), rng.permuted(np.tile(np.arange(30), (40, 1)), axis=1)[:, :3])
    sides = rng.integers(0, 3, 40).astype(np.uint8)
    prosthesis = Prosthesis(mesh, sides, None, "none")
    for side in (OUTER, INNER, RIM):
        part = prosthesis.surface(side)
        np.testing.assert_array_equal(part.corners, mesh.corners[sides == side])
        np.testing.assert_array_equal(np.unique(part.faces), np.arange(len(part.vertices)))
    assert len({OUTER, INNER, RIM}) == 3


def test_a_side_without_faces_is_an_empty_mesh():
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    part = Prosthesis(mesh, np.array([OUTER], np.uint8), None, "none").surface(INNER)
    assert part.vertices.shape == (0, 3) and part.faces.shape == (0, 3)


def test_every_prosthesis_has_its_own_record():
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    first, second = (Prosthesis(mesh, np.zeros(1, np.uint8), None, "none") for _ in range(2))
    first.record["slices"] = []
    assert second.record == {}


@pytest.mark.parametrize(
    ("kind", "exit_code"), [(errors.InputRefused, 3), (errors.NoOpening, 4), (errors.CannotWrite, 5)]
)
def test_an_error_says_what_and_what_to_do(kind, exit_code):
    error = kind("SomeCode", "This was found.", "Try that.")
    assert str(error) == "This was found. Try that."
    assert (error.code, error.message, error.remedy) == ("SomeCode", "This was found.", "Try that.")
    assert kind.exit_code == exit_code
    assert isinstance(error, errors.CranioError) and isinstance(error, ValueError)
    assert str(kind("SomeCode", "This was found.")) == "This was found."
