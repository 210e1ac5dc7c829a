"""Real scans: the right series, the true size, bit-exact decoding, and clear refusals."""

from pathlib import Path

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.parse import parse_file
from cranio_nb.readers.dicom.pixel_data import check_format, read_pixels
from cranio_nb.readers.dicom.rescale import apply_rescale
from cranio_nb.readers.dicom.slice_header import read_headers
from cranio_nb.volume import Volume

pytestmark = pytest.mark.real


def vault_size(volume: Volume) -> np.ndarray:
    """Width and length in mm of the largest piece of bone (400 HU or more) within 50 mm below its top."""
    labels, _ = ndimage.label(volume.voxels >= 400)
    largest = np.bincount(labels.ravel())[1:].argmax() + 1
    bone = volume.to_world(np.argwhere(labels == largest))
    return np.ptp(bone[bone[:, 2] > bone[:, 2].max() - 50][:, :2], axis=0)


def test_thin_series_of_a_whole_exam_is_chosen(real_data: Path) -> None:
    volume, report = read_ct(real_data / "dicom/dryskull_multiseries")
    assert volume.shape == (140, 512, 512) and volume.voxels.dtype == np.int16
    np.testing.assert_allclose(volume.spacing, (1.0, 0.451171875, 0.451171875))
    np.testing.assert_allclose(volume.affine[:3, 3], (-115.5, -1.85, 694.21), atol=1e-6)
    chosen = [f for f in report.findings if f.code == "SeriesChosen"]
    assert [f.values["slices"] for f in chosen] == [140] and "202" in chosen[0].message
    assert {"SeriesSkipped", "ImagesSkipped", "FilesSkipped"} <= {f.code for f in report.findings}
    assert {f.severity for f in report.findings} == {"info"}


def test_tilted_scan_of_the_same_skull_has_the_same_size(real_data: Path) -> None:
    upright, _ = read_ct(real_data / "dicom/dryskull_multiseries/S2020")
    tilted, report = read_ct(real_data / "dicom/dryskull_tilt")
    tilt = next(f for f in report.findings if f.code == "GantryTilt")
    assert tilt.severity == "corrected" and tilt.values["degrees"] == pytest.approx(18.5, abs=0.01)
    np.testing.assert_allclose(vault_size(tilted), vault_size(upright), atol=1.0)


def test_thick_slices_are_read_where_nothing_else_is_there(real_data: Path) -> None:
    volume, _ = read_ct(real_data / "dicom/dryskull_multiseries/S2010")
    assert volume.shape == (28, 512, 512) and volume.spacing[0] == pytest.approx(5.0)


def test_jpeg2000_series_is_read(real_data: Path) -> None:
    volume, _ = read_ct(real_data / "dicom/jpeg2000")
    assert volume.shape == (20, 512, 512) and volume.spacing[0] == pytest.approx(2.0)
    assert volume.voxels.min() == -1024


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("human_uneven_tilt", "SlicesTooFarApart"),
        ("broken/all_at_one_position", "BadGeometry"),
        ("broken/missing_slice", "MissingSlices"),
        ("broken/mixed_orientation", "WrongModality"),
        ("broken/single_files", "MixedPatients"),
        ("broken/tilt_without_tag", "TooFewSlices"),
        ("broken/two_slices", "WrongModality"),
        ("broken/uneven_tilt", "MissingSlices"),
        ("compressed_single", "MixedPatients"),
        ("dryskull_multiseries/S4010", "NoImages"),
        ("dryskull_multiseries/S1000", "NoImages"),
        ("dryskull_multiseries/S2020/I10", "TooFewSlices"),
    ],
)
def test_broken_scans_are_refused(name: str, code: str, real_data: Path) -> None:
    with pytest.raises(InputRefused) as caught:
        read_ct(real_data / "dicom" / name)
    assert caught.value.code == code
    assert str(real_data) not in str(caught.value)


def decoded(path: Path) -> np.ndarray:
    scanned = parse_file(path, 0)
    assert scanned is not None
    (header,) = read_headers(*scanned, 0)
    check_format(header, 0)
    assert header.slope is not None and header.intercept is not None
    return apply_rescale(read_pixels(header, 0), header, header.slope, header.intercept)[0]


@pytest.mark.parametrize("scan_name", ["CT1", "CT2"])
@pytest.mark.parametrize("coding", ["J2KR", "JLSL", "JPLL", "RLE"])
def test_lossless_codings_are_bit_exact(scan_name: str, coding: str, real_data: Path) -> None:
    folder = real_data / "dicom/compressed_single"
    raw, other = decoded(folder / f"{scan_name}_UNC"), decoded(folder / f"{scan_name}_{coding}")
    np.testing.assert_array_equal(raw, other)


def test_near_lossless_coding_stays_near(real_data: Path) -> None:
    folder = real_data / "dicom/compressed_single"
    raw, near = decoded(folder / "CT2_UNC"), decoded(folder / "CT2_JLSN")
    assert np.abs(raw.astype(int) - near).max() <= 4


def test_masks_of_one_case_share_their_grid(real_data: Path) -> None:
    case = real_data / "skullfix/cases/000"
    skull, report = read_ct(case / "defective.nrrd")
    implant, _ = read_ct(case / "implant.nrrd")
    assert report.kind == "mask" and skull.voxels.dtype == bool
    np.testing.assert_array_equal(skull.affine, implant.affine)
    assert not (skull.voxels & implant.voxels).any() and implant.voxels.any()
