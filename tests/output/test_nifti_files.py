"""A volume returns to its own grid, voxel by voxel and place by place."""

import numpy as np
import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.grid import canonical_order
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
