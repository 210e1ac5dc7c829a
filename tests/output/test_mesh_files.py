"""A mesh survives its file, or there is no file."""

import zipfile

import numpy as np
import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.mesh import Mesh
from cranio_nb.output import mesh_files
from cranio_nb.output.mesh_files import MESH_FORMATS, validate, write_mesh
from cranio_nb.stages.surface_reconstruction import extract_surface
from cranio_nb.volume import Volume


@pytest.fixture
def solid():
    """A rounded block far from the origin, in a tilted frame."""
    plane, row, col = np.indices((9, 14, 12))
    inside = ((plane - 4) / 4.2) ** 2 + ((row - 6.5) / 6) ** 2 + ((col - 5.5) / 5) ** 2 < 1
    affine = np.array([[0, 0.1, 0.45, 812], [0, 0.44, -0.1, -95], [2.5, 0, 0, 33], [0, 0, 0, 1.0]])
    return extract_surface(Volume(inside, affine))


def ball(centre=(0, 0, 0), radius=1.0):
    trimesh = pytest.importorskip("trimesh")
    made = trimesh.creation.icosphere(subdivisions=2, radius=radius)
    return Mesh(np.asarray(made.vertices) + centre, np.asarray(made.faces, np.intp))


def join(a, b):
    return Mesh(np.vstack([a.vertices, b.vertices]), np.vstack([a.faces, b.faces + len(a.vertices)]))


def read_back(path):
    trimesh = pytest.importorskip("trimesh")
    return trimesh.load_mesh(path)


@pytest.mark.parametrize("suffix", [*MESH_FORMATS, ".STL"])
def test_a_mesh_survives_its_file_in_place_and_size(tmp_path, solid, suffix):
    path = tmp_path / f"implant{suffix}"
    write_mesh(solid, path)
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    back = read_back(path)
    assert back.is_volume and len(back.faces) == len(solid.faces)
    np.testing.assert_allclose(back.volume, solid.volume, rtol=1e-4)
    np.testing.assert_allclose(np.asarray(back.triangles).mean(axis=1), solid.centres, atol=1e-4)


def test_stl_is_binary_and_3mf_says_millimetre(tmp_path, solid):
    write_mesh(solid, tmp_path / "a.stl")
    assert (tmp_path / "a.stl").stat().st_size == 84 + 50 * len(solid.faces)
    write_mesh(solid, str(tmp_path / "a.3mf"))
    with zipfile.ZipFile(tmp_path / "a.3mf") as package:
        assert b'unit="millimeter"' in package.read("3D/3dmodel.model")


def _open(mesh):
    return Mesh(mesh.vertices, mesh.faces[1:])


def _inverted(mesh):
    return Mesh(mesh.vertices, mesh.faces[:, ::-1])


def _one_flipped(mesh):
    return Mesh(mesh.vertices, np.vstack([mesh.faces[:1, ::-1], mesh.faces[1:]]))


def _doubled_face(mesh):
    return Mesh(mesh.vertices, np.vstack([mesh.faces, mesh.faces[:1]]))


def _not_finite(mesh):
    return Mesh(np.where(np.arange(len(mesh.vertices))[:, None] == 0, np.nan, mesh.vertices), mesh.faces)


def _spiked(mesh):
    return Mesh(np.where(np.arange(len(mesh.vertices))[:, None] == 0, -3 * mesh.vertices, mesh.vertices), mesh.faces)


def _no_faces(mesh):
    return Mesh(mesh.vertices, mesh.faces[:0])


def _two_apart(mesh):
    return join(mesh, Mesh(mesh.vertices + 5, mesh.faces))


FAULTS = [_open, _inverted, _one_flipped, _doubled_face, _not_finite, _spiked, _no_faces, _two_apart]


@pytest.mark.parametrize("fault", FAULTS)
def test_a_mesh_that_is_not_a_solid_is_refused_and_leaves_no_file(tmp_path, fault):
    with pytest.raises(CannotWrite) as refusal:
        write_mesh(fault(ball()), tmp_path / "implant.stl")
    assert refusal.value.code == "MeshInvalid"
    assert not list(tmp_path.iterdir())


def test_two_balls_through_each_other_are_refused_though_two_parts_are_wanted():
    validate(join(ball(), ball((3, 0, 0))), n_parts=2)
    with pytest.raises(CannotWrite, match="pass through each other"):
        validate(join(ball(), ball((0.7, 0.1, 0.2))), n_parts=2)


def test_a_mesh_too_fine_for_its_format_is_refused(tmp_path):
    far = ball((1e7, 0, 0), radius=0.5)  # single precision stands 1 mm apart out there
    with pytest.raises(CannotWrite) as refusal:
        write_mesh(far, tmp_path / "implant.stl")
    assert refusal.value.code == "MeshInvalid"
    assert not list(tmp_path.iterdir())


def test_a_file_that_reads_back_otherwise_is_not_kept(tmp_path, monkeypatch):
    path = tmp_path / "implant.ply"
    write_mesh(ball(), path)
    before = path.read_bytes()
    monkeypatch.setattr(mesh_files, "_trimesh", _squeezed(mesh_files._trimesh))
    with pytest.raises(CannotWrite, match="another one"):
        write_mesh(ball(), path)
    assert path.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["implant.ply"]


def _squeezed(make):
    def squeezed(mesh):
        made = make(mesh)
        return made.apply_scale(0.9)

    return squeezed


@pytest.mark.parametrize("name", ["implant.obj", "implant", "implant.nii"])
def test_an_unknown_mesh_suffix_is_refused(tmp_path, name):
    with pytest.raises(CannotWrite) as refusal:
        write_mesh(ball(), tmp_path / name)
    assert refusal.value.code == "BadFormat"
