"""A scan that loses its end, or slices inside, to another kind, class, direction or series is not read as whole."""

import copy
from pathlib import Path

import numpy as np
import pytest
from dicom_series import SHAPE, codes, head, refusal, save, series
from pydicom.uid import generate_uid

from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.continuation import agree
from data_synth.fault_edits import set_elements

TURN = 0.01
TURNED = [np.cos(TURN), np.sin(TURN), 0, -np.sin(TURN), np.cos(TURN), 0]
LOSSES = {
    "modality": {"Modality": "MR"},
    "class": {"SOPClassUID": "1.2.840.10008.5.1.4.1.1.7"},
    "kind": {"ImageType": ["DERIVED", "SECONDARY", "AXIAL"]},
    "direction": {"ImageOrientationPatient": TURNED},
    "colour": {"SamplesPerPixel": 3, "PhotometricInterpretation": "RGB"},
    "scout": {"ImageType": ["ORIGINAL", "PRIMARY", "LOCALIZER"]},
}


@pytest.mark.parametrize("name", LOSSES)
@pytest.mark.parametrize("count", [1, 3, 4, 6])
@pytest.mark.parametrize("end", ["top", "bottom"])
def test_a_lost_end_is_refused_however_small(name: str, count: int, end: str, tmp_path: Path) -> None:
    datasets = series(head())
    set_elements(slice(-count, None) if end == "top" else slice(0, count), **LOSSES[name])(datasets)
    assert refusal(save(tmp_path / "scan", datasets)).code == "MissingSlices"


@pytest.mark.parametrize("count", [4, 12])
def test_a_scan_in_two_series_is_refused(count: int, tmp_path: Path) -> None:
    datasets = series(head())
    set_elements(slice(-count, None), SeriesInstanceUID=generate_uid())(datasets)
    assert refusal(save(tmp_path / "scan", datasets)).code == "AmbiguousSeries"


def test_every_other_slice_in_another_series_is_refused(tmp_path: Path) -> None:
    datasets = series(head())
    set_elements(slice(0, None, 2), SeriesInstanceUID=generate_uid())(datasets)
    assert refusal(save(tmp_path / "scan", datasets)).code == "AmbiguousSeries"


def test_slices_that_are_series_of_their_own_are_joined(tmp_path: Path) -> None:
    datasets = series(head())
    for ds in datasets:
        ds.SeriesInstanceUID = generate_uid()
    volume, report = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, head())
    assert "SeriesJoined" in codes(report)


def test_a_cut_slice_of_joined_series_is_missed(tmp_path: Path) -> None:
    datasets = series(head())
    for ds in datasets:
        ds.SeriesInstanceUID = generate_uid()
    folder = save(tmp_path / "scan", datasets)
    victim = folder / f"image{SHAPE[0] - 1:04d}.dcm"
    victim.write_bytes(victim.read_bytes()[:-500])
    assert refusal(folder).code == "CorruptPixelData"


def test_other_reconstructions_of_the_same_places_do_not_matter(tmp_path: Path) -> None:
    datasets = series(head())
    twins = copy.deepcopy(datasets)
    set_elements(slice(None), SeriesInstanceUID=generate_uid(), ConvolutionKernel="H70s", SeriesNumber=3)(twins)
    for ds in twins:
        ds.SOPInstanceUID = generate_uid()
    volume, _ = read_ct(save(tmp_path / "scan", datasets + twins))
    np.testing.assert_array_equal(volume.voxels, head())


def test_vectors_agree_within_rounding_only() -> None:
    assert agree(np.ones(3), np.ones(3) + 1e-5) and not agree(np.ones(3), np.ones(3) + 1e-3)
    assert agree(None, None) and not agree(np.ones(3), None)
