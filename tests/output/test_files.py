import dataclasses
import errno
import json
import os
import zipfile
from pathlib import Path

import numpy as np
import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.grid import AxisOrder, canonical_order
from cranio_nb.mesh import Mesh
from cranio_nb.output import files
from cranio_nb.output.files import MESH_FORMATS, jsonable, output_folder, validate, write_json, write_mesh, write_nifti
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
    monkeypatch.setattr(files, "_trimesh", _squeezed(files._trimesh))
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


def oblique():
    affine = np.eye(4)
    affine[:3, :3] = np.linalg.qr(np.array([[1, 0.2, 0.1], [-0.2, 1, 0.3], [0, -0.3, 1]]))[0] * (0.45, 0.45, -2.5)
    affine[:3, 3] = (-110, 95.5, 812)
    return affine


@pytest.mark.parametrize("suffix", [".nii", ".nii.gz"])
def test_a_patch_returns_to_the_inputs_own_grid(tmp_path, suffix):
    nibabel = pytest.importorskip("nibabel")
    stored = Volume(np.random.default_rng(0).random((5, 6, 7)) < 0.5, oblique())
    order = canonical_order(stored.affine)
    path = tmp_path / f"patch{suffix}"
    write_nifti(stored.reorder(order), path, order)
    image = nibabel.load(path)
    data = np.asanyarray(image.dataobj)
    assert data.dtype == np.uint8
    np.testing.assert_array_equal(data, stored.voxels)
    ras = np.diag([-1, -1, 1, 1]) @ stored.affine
    for affine in (image.affine, image.get_sform(), image.get_qform()):
        np.testing.assert_allclose(affine, ras, atol=1e-4)
    assert image.header.get_xyzt_units()[0] == "mm"
    assert bytes(image.header["descrip"]).strip(b"\0") == bytes(image.header["db_name"]).strip(b"\0") == b""
    assert [p.name for p in tmp_path.iterdir()] == [path.name]


def test_without_an_order_every_voxel_keeps_its_place(tmp_path):
    nibabel = pytest.importorskip("nibabel")
    volume = Volume(np.arange(60, dtype=np.int16).reshape(3, 4, 5), oblique())
    write_nifti(volume, tmp_path / "ct.nii.gz")
    image = nibabel.load(tmp_path / "ct.nii.gz")
    np.testing.assert_array_equal(np.asanyarray(image.dataobj), volume.voxels)
    at = np.array([2, 1, 3])
    np.testing.assert_allclose((image.affine @ [*at, 1])[:3] * (-1, -1, 1), volume.to_world(at), atol=1e-3)


def test_peer_reads_the_same_places(tmp_path):
    sitk = pytest.importorskip("SimpleITK")
    volume = Volume(np.zeros((3, 4, 5), bool), oblique())
    write_nifti(volume, tmp_path / "patch.nii")
    image = sitk.ReadImage(str(tmp_path / "patch.nii"))
    for at in ((0, 0, 0), (2, 1, 3)):
        np.testing.assert_allclose(image.TransformIndexToPhysicalPoint(at), volume.to_world(at), atol=1e-3)


def test_equal_volumes_give_equal_files(tmp_path):
    volume = Volume(np.ones((3, 4, 5), bool), np.eye(4))
    for name in ("a.nii.gz", "b.nii.gz"):
        write_nifti(volume, tmp_path / name)
    assert (tmp_path / "a.nii.gz").read_bytes() == (tmp_path / "b.nii.gz").read_bytes()


@pytest.mark.parametrize("name, dtype", [("patch.nrrd", bool), ("patch.nii.txt", bool), ("patch.nii", np.int64)])
def test_what_nifti_cannot_hold_is_refused(tmp_path, name, dtype):
    with pytest.raises(CannotWrite) as refusal:
        write_nifti(Volume(np.zeros((2, 2, 2), dtype), np.eye(4)), tmp_path / name)
    assert refusal.value.code == "BadFormat"
    assert not list(tmp_path.iterdir())


def test_json_is_strict_and_holds_dataclasses_and_arrays(tmp_path):
    data = {"order": AxisOrder((2, 0, 1), (True, False, False)), "gap": np.float32(0.25), "path": (np.inf, np.nan)}
    write_json(tmp_path / "a.json", data)
    found = json.loads((tmp_path / "a.json").read_text(), parse_constant=pytest.fail)
    assert found == {
        "order": dataclasses.asdict(data["order"]) | {"axes": [2, 0, 1], "flips": [True, False, False]},
        "gap": 0.25,
        "path": [None, None],
    }
    with pytest.raises(CannotWrite):
        jsonable({"what": object()})


def test_text_is_utf8(tmp_path):
    files.write_text(tmp_path / "a.txt", "Schädel µm\n")
    assert (tmp_path / "a.txt").read_bytes().decode("utf-8") == "Schädel µm\n"


class TestFoldersAndFailures:
    def test_a_folder_is_made_with_its_parents(self, tmp_path):
        folder = output_folder(tmp_path / "a" / "b")
        assert folder.is_dir() and not list(folder.iterdir())
        assert output_folder(str(folder)) == folder

    @pytest.mark.parametrize("inside", ["", "deeper"])
    def test_a_file_in_the_way_is_refused(self, tmp_path, inside):
        (tmp_path / "results").write_text("mine")
        with pytest.raises(CannotWrite, match="in the way") as refusal:
            output_folder(tmp_path / "results" / inside)
        assert str(tmp_path) not in str(refusal.value)
        assert (tmp_path / "results").read_text() == "mine"

    def test_a_folder_that_may_not_be_written_is_refused(self, tmp_path, monkeypatch):
        def refuse(*args, **kwargs):
            raise PermissionError(errno.EACCES, "Permission denied", str(tmp_path))

        monkeypatch.setattr(files.tempfile, "TemporaryFile", refuse)
        with pytest.raises(CannotWrite) as refusal:
            output_folder(tmp_path / "results")
        assert refusal.value.code == "CannotWrite" and refusal.value.exit_code == 5
        assert "Permission denied" in str(refusal.value) and str(tmp_path) not in str(refusal.value)

    def test_a_read_only_system_is_refused_in_words_without_the_path(self, tmp_path, monkeypatch):
        def refuse(self, *args, **kwargs):
            raise OSError(errno.EROFS, "Read-only file system", str(self))

        monkeypatch.setattr(Path, "open", refuse)
        with pytest.raises(CannotWrite) as refusal:
            files.write_text(tmp_path / "a.txt", "text")
        assert "a.txt" in str(refusal.value) and "Read-only file system" in str(refusal.value)
        assert str(tmp_path) not in str(refusal.value)

    def test_a_full_disk_keeps_the_old_file_and_leaves_nothing(self, tmp_path, monkeypatch):
        files.write_text(tmp_path / "a.txt", "old")

        def full(handle):
            raise OSError(errno.ENOSPC, "No space left on device")

        monkeypatch.setattr(os, "fsync", full)
        with pytest.raises(CannotWrite, match="No space left"):
            files.write_text(tmp_path / "a.txt", "new")
        assert [p.name for p in tmp_path.iterdir()] == ["a.txt"]
        assert (tmp_path / "a.txt").read_text() == "old"

    @pytest.mark.parametrize("write", [lambda p: files.write_text(p, ""), lambda p: write_mesh(ball(), p)])
    def test_a_folder_that_is_not_there_is_refused(self, tmp_path, write):
        with pytest.raises(CannotWrite) as refusal:
            write(tmp_path / "nowhere" / "a.stl")
        assert refusal.value.code == "CannotWrite" and str(tmp_path) not in str(refusal.value)
