"""DICOM series and case folders: what is written is read back, by pydicom, by SimpleITK and by nibabel."""

import numpy as np
import pydicom
import pytest
import SimpleITK as sitk

from data_synth import ORIENTATIONS, leaning, phantom_case, write_dicom

MARKER = (7, 9, 20)  # plane, row, col


@pytest.fixture
def small():
    """Noise with one bright marker on an oblique-free grid with three different steps."""
    hu = np.random.default_rng(0).integers(-1024, 3000, (12, 24, 30)).astype(np.int16)
    hu[MARKER] = 3071
    affine = np.array([[0, 0, 0.7, -31.5], [0, 0.9, 0, 12.25], [2.5, 0, 0, -410.0], [0, 0, 0, 1.0]])
    return hu, affine


def world(affine, index):
    return affine[:3, :3] @ np.asarray(index) + affine[:3, 3]


def read_pydicom(paths):
    """Marker's world position and HU of every plane, from the headers alone."""
    slices = [pydicom.dcmread(path) for path in paths]
    hu = [ds.pixel_array.astype(int) * int(ds.RescaleSlope) + int(ds.RescaleIntercept) for ds in slices]
    plane, row, col = (int(i) for i in np.unravel_index(np.argmax(hu), np.shape(hu)))
    ds = slices[plane]
    across, down = np.array(ds.ImageOrientationPatient, float).reshape(2, 3)
    rows, cols = (float(v) for v in ds.PixelSpacing)
    return np.array(hu), np.array(ds.ImagePositionPatient, float) + col * cols * across + row * rows * down


def read_sitk(folder):
    reader = sitk.ImageSeriesReader()
    reader.SetFileNames(reader.GetGDCMSeriesFileNames(str(folder)))
    image = reader.Execute()
    hu = sitk.GetArrayFromImage(image)
    index = [int(i) for i in np.unravel_index(np.argmax(hu), hu.shape)][::-1]
    return hu, np.array(image.TransformIndexToPhysicalPoint(index))


@pytest.mark.parametrize("syntax", ["explicit", "implicit", "deflated", "rle", "jpegls"])
def test_pixels_come_back_bit_exact(small, tmp_path, syntax):
    hu, affine = small
    paths = write_dicom(tmp_path / "ct", hu, affine, transfer_syntax=syntax)
    mine, place = read_pydicom(paths)
    np.testing.assert_array_equal(mine, hu)
    np.testing.assert_allclose(place, world(affine, MARKER), atol=1e-9)
    theirs, place = read_sitk(tmp_path / "ct")
    np.testing.assert_array_equal(theirs, hu)
    np.testing.assert_allclose(place, world(affine, MARKER), atol=1e-6)


@pytest.mark.parametrize("orientation", ORIENTATIONS)
def test_every_voxel_keeps_its_place(small, tmp_path, orientation):
    hu, affine = small
    paths = write_dicom(tmp_path / "ct", hu, affine, orientation=orientation, shuffle_names=True)
    for _, place in (read_pydicom(paths), read_sitk(tmp_path / "ct")):
        np.testing.assert_allclose(place, world(affine, MARKER), atol=1e-6)


def test_oblique_grid(small, tmp_path):
    hu, affine = small
    turn = np.linalg.qr(np.random.default_rng(1).standard_normal((3, 3)))[0]
    affine[:3, :3] = turn @ affine[:3, :3]
    paths = write_dicom(tmp_path / "ct", hu, affine)
    for _, place in (read_pydicom(paths), read_sitk(tmp_path / "ct")):
        np.testing.assert_allclose(place, world(affine, MARKER), atol=1e-6)


@pytest.mark.parametrize("tilt", [-18.5, 12.0])
def test_tilt_is_in_the_headers(small, tmp_path, tilt):
    hu, affine = small
    paths = write_dicom(tmp_path / "ct", hu, affine, tilt_deg=tilt)
    mine, place = read_pydicom(paths)
    np.testing.assert_array_equal(mine, hu)
    np.testing.assert_allclose(place, world(leaning(affine, tilt), MARKER), atol=1e-8)
    ds = pydicom.dcmread(paths[0])
    assert float(ds.GantryDetectorTilt) == pytest.approx(tilt, abs=1e-4)
    across, down = np.array(ds.ImageOrientationPatient, float).reshape(2, 3)
    assert np.cross(across, down)[2] == pytest.approx(np.cos(np.deg2rad(tilt)))


def test_a_tilted_phantom_is_the_same_head():
    """Bone seen on leaning planes is bone of the upright closed form, so a tilt moves no truth."""
    case = phantom_case("tiny", "unilateral", 3, tilt_deg=15.0)
    index = np.argwhere(case.complete)[::97]
    p = index @ case.affine[:3, :3].T + case.affine[:3, 3] - case.head.centre
    assert case.head.inside_bone(p).all()
    straight = phantom_case("tiny", "unilateral", 3)
    assert case.head.outer_radius([0.6, 0.0, 0.8]) == straight.head.outer_radius([0.6, 0.0, 0.8])


def test_uneven_positions(small, tmp_path):
    hu, affine = small
    positions = np.cumsum([0, 2.5, 2.5, 5, 1, 1, 2.5, 2.5, 7, 2.5, 2.5, 2.5])
    paths = write_dicom(tmp_path / "ct", hu, affine, positions=positions)
    z = [float(pydicom.dcmread(path).ImagePositionPatient[2]) for path in paths]
    np.testing.assert_allclose(z, positions - 410.0, atol=1e-9)


def test_far_hu_need_sixteen_bits(small, tmp_path):
    hu, affine = small
    hu[0, 0, :2] = [-3024, 20000]
    hu[MARKER] = 32767
    paths = write_dicom(tmp_path / "ct", hu, affine, transfer_syntax="rle")
    np.testing.assert_array_equal(read_pydicom(paths)[0], hu)


def test_headers_are_one_valid_fictional_series(small, tmp_path):
    hu, affine = small
    paths = write_dicom(tmp_path / "ct", hu, affine, shuffle_names=True, series_description="SOFT")
    slices = [pydicom.dcmread(path) for path in paths]
    for name in ("StudyInstanceUID", "SeriesInstanceUID", "FrameOfReferenceUID", "PatientName", "SeriesDescription"):
        assert len({str(ds[name].value) for ds in slices}) == 1
    assert len({ds.SOPInstanceUID for ds in slices}) == len(slices)
    assert all(ds.file_meta.MediaStorageSOPInstanceUID == ds.SOPInstanceUID for ds in slices)
    assert sorted(ds.InstanceNumber for ds in slices) == list(range(1, 13))
    assert [path.name for path in paths] != sorted(path.name for path in paths)
    assert slices[0].PatientName == "Phantom^Head" and slices[0].StudyDate == "20000102"
    assert slices[0].SeriesDescription == "SOFT"


def test_same_case_same_files(small, tmp_path):
    for name in ("a", "b"):
        write_dicom(tmp_path / name, *small)
    for path in (tmp_path / "a").iterdir():
        assert path.read_bytes() == (tmp_path / "b" / path.name).read_bytes()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"orientation": "upside"}, "no orientation"),
        ({"transfer_syntax": "zip"}, "no transfer syntax"),
        ({"positions": [0.0, 1.0]}, "one value for each of 12 planes"),
    ],
)
def test_wrong_options_write_nothing(small, tmp_path, options, words):
    with pytest.raises(ValueError, match=words):
        write_dicom(tmp_path / "ct", *small, **options)
    assert not (tmp_path / "ct").exists()


def test_a_failing_write_leaves_nothing(small, tmp_path, monkeypatch):
    hu, affine = small
    done = []

    def save(self, path, **_):
        done.append(path)
        if len(done) == 3:
            raise OSError("disk full")
        path.write_bytes(b"x")

    monkeypatch.setattr(pydicom.Dataset, "save_as", save)
    with pytest.raises(OSError, match="disk full"):
        write_dicom(tmp_path / "ct", hu, affine)
    assert list(tmp_path.iterdir()) == []
