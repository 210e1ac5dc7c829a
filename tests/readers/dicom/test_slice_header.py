"""What images say about themselves, in classic and in multi-frame files."""

import random
from pathlib import Path

import numpy as np
import pytest
from dicom_series import (
    AXIAL,
    SPACING,
    head,
    patch,
    read_folder,
    refusal,
    save,
    series,
    truth,
)
from pydicom.dataset import Dataset
from pydicom.sequence import Sequence
from pydicom.uid import (
    JPEGLSLossless,
)

from cranio_nb.readers import read_ct

SMALL = (9, 22, 26)


def enhanced(hu: np.ndarray, order: list[int], shared_rescale: bool) -> Dataset:
    """All planes in one multi-frame file, its frames in any order."""
    slices = series(hu)
    ds = slices[0]
    ds.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2.1"
    ds.NumberOfFrames = len(hu)
    ds.PixelData = b"".join(slices[k].PixelData for k in order)
    frames = []
    for k in order:
        place, item = Dataset(), Dataset()
        place.ImagePositionPatient = slices[k].ImagePositionPatient
        item.PlanePositionSequence = Sequence([place])
        if not shared_rescale:
            item.PixelValueTransformationSequence = Sequence([rescale()])
        frames.append(item)
    shared, turn, measures = Dataset(), Dataset(), Dataset()
    turn.ImageOrientationPatient, measures.PixelSpacing = list(AXIAL), list(SPACING)
    shared.PlaneOrientationSequence, shared.PixelMeasuresSequence = Sequence([turn]), Sequence([measures])
    if shared_rescale:
        shared.PixelValueTransformationSequence = Sequence([rescale()])
    ds.SharedFunctionalGroupsSequence = Sequence([shared])
    ds.PerFrameFunctionalGroupsSequence = Sequence(frames)
    for name in ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing", "RescaleSlope", "RescaleIntercept"):
        del ds[name]
    return ds


def rescale() -> Dataset:
    ds = Dataset()
    ds.RescaleSlope, ds.RescaleIntercept, ds.RescaleType = 1, -1024, "HU"
    return ds


@pytest.mark.parametrize("shared_rescale", [False, True])
@pytest.mark.parametrize("compressed", [False, True])
def test_multi_frame_file_is_read_by_its_positions(shared_rescale: bool, compressed: bool, tmp_path: Path) -> None:
    hu = head(SMALL)
    ds = enhanced(hu, random.Random(2).sample(range(len(hu)), len(hu)), shared_rescale)
    if compressed:
        ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
    folder = save(tmp_path / "scan", [ds])
    for path in (folder, folder / "image0000.dcm"):
        volume, _ = read_ct(path)
        np.testing.assert_array_equal(volume.voxels, hu)
        np.testing.assert_allclose(volume.affine, truth(), atol=1e-9)


def test_nan_text_in_a_position_is_refused(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    patch(folder / "image0005.dcm", b"-22\\-18.5\\", b"nan\\-18.5\\")
    assert refusal(folder).code == "BadGeometry"


def test_absent_values_are_none_and_wrong_ones_are_nan(tmp_path: Path) -> None:
    (dataset, *_) = series(head(SMALL))
    del dataset.PixelSpacing, dataset.RescaleSlope
    dataset.ImagePositionPatient = [1, 2]
    (header,) = read_folder(save(tmp_path / "scan", [dataset]))
    assert header.spacing is None and header.slope is None
    assert header.position is not None and np.isnan(header.position).all()


def test_a_person_is_known_by_digests_only(tmp_path: Path) -> None:
    (header, *others) = read_folder(save(tmp_path / "scan", series(head(SMALL))))
    assert {other.person for other in others} == {header.person}
    assert not {"SECRET-1", "Nobody^At^All", "19000101"} & set(header.person)
