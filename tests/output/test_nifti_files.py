"""A volume returns to its own grid, voxel by voxel and place by place."""

import numpy as np
import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.grid import canonical_order
from cranio_nb.output import nifti_files
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.volume import Volume


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
    assert int(image.header["sform_code"]) == int(image.header["qform_code"]) == 1  # places as the scanner gave them
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
    data = (tmp_path / "a.nii.gz").read_bytes()
    assert data == (tmp_path / "b.nii.gz").read_bytes()
    assert data[4:8] == bytes(4)  # RFC 1952: no time stamp is available


TYPES = "uint8, int16, int32, float32, float64"


@pytest.mark.parametrize(
    ("name", "dtype", "found", "wanted"),
    [
        ("patch.nrrd", bool, "patch.nrrd", ".nii or .nii.gz"),
        ("patch.nii.txt", bool, "patch.nii.txt", ".nii or .nii.gz"),
        ("patch.nii", np.int64, "int64", TYPES),
    ],
)
def test_what_nifti_cannot_hold_is_refused(tmp_path, name, dtype, found, wanted):
    with pytest.raises(CannotWrite) as refusal:
        write_nifti(Volume(np.zeros((2, 2, 2), dtype), np.eye(4)), tmp_path / name)
    assert refusal.value.code == "BadFormat"
    assert found in refusal.value.message and wanted in refusal.value.message
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["ct.nii", "ct.nii.gz"])
@pytest.mark.parametrize(
    "spoil",
    [
        lambda voxels, affine: (voxels + voxels.dtype.type(1), affine),
        lambda voxels, affine: (voxels[:, :, :1], affine),
        lambda voxels, affine: (voxels, affine + 2e-3 * np.eye(4, k=3)),
    ],
    ids=["voxels", "shape", "places"],
)
def test_a_file_that_reads_back_otherwise_is_not_kept(tmp_path, monkeypatch, name, spoil):
    volume = Volume(np.zeros((3, 4, 5), np.int16), np.eye(4))
    honest = nifti_files._nifti_bytes
    monkeypatch.setattr(nifti_files, "_nifti_bytes", lambda voxels, affine: honest(*spoil(voxels, affine)))
    with pytest.raises(CannotWrite, match="reads back as another one") as refusal:
        write_nifti(volume, tmp_path / name)
    assert refusal.value.code == "CannotWrite"
    assert not list(tmp_path.iterdir())


def test_places_may_be_rounded_within_the_tolerance(tmp_path, monkeypatch):
    honest = nifti_files._nifti_bytes
    monkeypatch.setattr(
        nifti_files, "_nifti_bytes", lambda voxels, affine: honest(voxels, affine + 5e-4 * np.eye(4, k=3))
    )
    nifti_files.write_nifti(Volume(np.zeros((3, 4, 5), np.int16), np.eye(4)), tmp_path / "ct.nii")
    assert (tmp_path / "ct.nii").exists()
