"""A mesh survives its file, or there is no file."""

import io
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.geometry.mesh_check import check_mesh
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


def test_a_file_with_other_faces_is_not_kept(tmp_path, monkeypatch):
    other = mesh_files._trimesh(join(ball(), ball((3, 0, 0))))
    monkeypatch.setattr(mesh_files, "_trimesh", lambda mesh: other)
    with pytest.raises(CannotWrite, match="another one"):
        write_mesh(ball(), tmp_path / "implant.ply")
    assert not list(tmp_path.iterdir())


def test_faces_may_start_at_another_corner(tmp_path, monkeypatch):
    mesh, make = ball(), mesh_files._trimesh
    turns = np.arange(len(mesh.faces))[:, None] % 3
    turned = np.take_along_axis(mesh.faces, (turns + np.arange(3)) % 3, axis=1)
    monkeypatch.setattr(mesh_files, "_trimesh", lambda mesh: make(Mesh(mesh.vertices, turned)))
    write_mesh(mesh, tmp_path / "implant.ply")
    assert read_back(tmp_path / "implant.ply").is_volume


def _longer(data):
    return data + b"\0"


def _one_face_less(data):
    return data[:80] + (int.from_bytes(data[80:84], "little") - 1).to_bytes(4, "little") + data[84:-50]


def _moved_corner(data):
    return data[:96] + np.float32(9).tobytes() + data[100:]


def _no_number(data):
    return data[:96] + np.float32(np.nan).tobytes() + data[100:]


@pytest.mark.parametrize("spoil", [_longer, _one_face_less, _moved_corner, _no_number])
def test_an_stl_file_that_reads_back_otherwise_is_not_kept(tmp_path, monkeypatch, spoil):
    honest = mesh_files._stl_bytes
    monkeypatch.setattr(mesh_files, "_stl_bytes", lambda mesh: spoil(honest(mesh)))
    with pytest.raises(CannotWrite, match="another one"):
        write_mesh(ball(), tmp_path / "implant.stl")
    assert not list(tmp_path.iterdir())


def test_what_is_a_solid_only_in_memory_is_not_kept(tmp_path):
    # two cubes side by side along an edge, each with its own vertices: by places alone four faces meet there
    trimesh = pytest.importorskip("trimesh")
    cube = trimesh.creation.box()
    one, other = (Mesh(cube.vertices + move, np.asarray(cube.faces, np.intp)) for move in ((0, 0, 0), (1, 1, 0)))
    validate(join(one, other), n_parts=2)
    with pytest.raises(CannotWrite, match="another one"):
        write_mesh(join(one, other), tmp_path / "implant.stl", n_parts=2)
    assert not list(tmp_path.iterdir())


def test_an_stl_file_holds_the_normals_of_its_faces(tmp_path, solid):
    write_mesh(solid, tmp_path / "a.stl")
    from trimesh.exchange.stl import load_stl_binary

    with (tmp_path / "a.stl").open("rb") as file:
        np.testing.assert_allclose(load_stl_binary(file)["face_normals"], solid.normals, atol=1e-6)


@pytest.mark.parametrize("name", ["implant.3mf", "implant.3MF"])
def test_3mf_in_another_unit_is_not_kept(tmp_path, monkeypatch, name):
    make = mesh_files._trimesh
    monkeypatch.setattr(mesh_files, "_trimesh", lambda mesh: _InInches(make(mesh)))
    with pytest.raises(CannotWrite, match="millimetre") as refusal:
        write_mesh(ball(), tmp_path / name)
    assert refusal.value.code == "MeshInvalid"
    assert not list(tmp_path.iterdir())


class _InInches:
    """A mesh whose 3MF says inch."""

    def __init__(self, made):
        self.made, self.is_volume = made, made.is_volume

    def export(self, file_type):
        packed = io.BytesIO()
        with (
            zipfile.ZipFile(io.BytesIO(self.made.export(file_type=file_type))) as old,
            zipfile.ZipFile(packed, "w") as new,
        ):
            for name in old.namelist():
                new.writestr(name, old.read(name).replace(b'unit="millimeter"', b'unit="inch"'))
        return packed.getvalue()


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        ({"n_faces": 0}, "no faces"),
        ({"n_unclear": 1}, "1 faces are not finite, have no area or are there twice"),
        ({"n_open_edges": 1}, "1 edges do not join two faces"),
        ({"n_flipped_edges": 1}, "1 edges join faces of opposite winding"),
        ({"n_pinches": 1}, "pinched at 1 vertices"),
        ({"n_parts": 2}, "2 parts and 1 are wanted"),
        ({"volume": 0.0}, "volume is 0 mm3"),
        ({"volume": np.nan}, "volume is nan mm3"),
        ({"n_crossings": 1}, "1 pairs of faces pass through each other"),
    ],
)
def test_one_fault_in_the_report_is_enough_and_is_said(tmp_path, fault, said):
    report = replace(check_mesh(ball()), **fault)
    for refuse in (validate, lambda mesh, report: write_mesh(mesh, tmp_path / "implant.stl", report=report)):
        with pytest.raises(CannotWrite) as refusal:
            refuse(ball(), report=report)
        assert refusal.value.code == "MeshInvalid" and said in refusal.value.message
        assert "design it again" in refusal.value.remedy


def test_a_small_solid_is_one_and_its_own_report_comes_back():
    report = check_mesh(ball(radius=0.1))
    assert 0 < report.volume < 1
    assert validate(ball(radius=0.1), report=report) is report


@pytest.mark.parametrize("fault", [_open, _inverted])
def test_another_library_is_asked_too(fault):
    with pytest.raises(CannotWrite, match="manifold3d"):
        validate(fault(ball()), report=check_mesh(ball()))


def test_as_many_parts_are_written_as_are_wanted(tmp_path):
    write_mesh(join(ball(), ball((3, 0, 0))), tmp_path / "implant.stl", n_parts=2)
    assert read_back(tmp_path / "implant.stl").body_count == 2


@pytest.mark.parametrize("name", ["implant.obj", "implant", "implant.nii"])
def test_an_unknown_mesh_suffix_is_refused(tmp_path, name):
    with pytest.raises(CannotWrite) as refusal:
        write_mesh(ball(), tmp_path / name)
    assert refusal.value.code == "BadFormat"
    assert name in refusal.value.message and ".stl, .ply, .3mf" in refusal.value.message
