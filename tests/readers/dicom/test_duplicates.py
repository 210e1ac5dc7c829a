"""Copies of slices are dropped; two scans at the same places are refused."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from dicom_series import head, read_folder, save, series

from cranio_nb.errors import InputRefused
from cranio_nb.readers.dicom.duplicates import keep_one_per_position
from data_synth.fault_edits import set_elements

SMALL = (9, 22, 26)


def test_slices_in_any_order_come_out_by_height(tmp_path: Path) -> None:
    headers = read_folder(save(tmp_path / "scan", series(head(SMALL))))
    shuffled = [headers[i] for i in np.random.default_rng(3).permutation(len(headers))]
    kept, findings = keep_one_per_position(shuffled)
    assert [header.file for header in kept] == list(range(9)) and not findings


def test_exact_copies_are_dropped_and_counted(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head(SMALL)))
    for number in (2, 5):
        shutil.copy(folder / f"image{number:04d}.dcm", folder / f"x{number}.dcm")
    kept, (finding,) = keep_one_per_position(read_folder(folder))
    assert len(kept) == 9 and finding.values == {"copies": 2}


@pytest.mark.parametrize(("name", "value"), [("AcquisitionNumber", 2), ("ConvolutionKernel", "H70h")])
def test_two_scans_at_one_place_are_refused_with_their_difference(name: str, value: object, tmp_path: Path) -> None:
    first, second = series(head(SMALL)), series(head(SMALL) + 1)
    set_elements(slice(None), **{name: value, "SeriesInstanceUID": first[0].SeriesInstanceUID})(second)
    with pytest.raises(InputRefused) as caught:
        keep_one_per_position(read_folder(save(tmp_path / "scan", [*first, *second])))
    assert caught.value.code == "AmbiguousSeries"
    assert ("acquisition" in caught.value.message) == (name == "AcquisitionNumber")
    assert ("kernel" in caught.value.message) == (name == "ConvolutionKernel")


def test_slices_without_pixels_leave_a_gap_only_where_that_is_allowed(tmp_path: Path) -> None:
    datasets = series(head(SMALL))
    set_elements(4, PixelData=None)(datasets)
    headers = read_folder(save(tmp_path / "scan", datasets))
    with pytest.raises(InputRefused) as caught:
        keep_one_per_position(headers)
    assert caught.value.code == "MissingSlices"
    kept, (finding,) = keep_one_per_position(headers, ("gap_fill",))
    assert len(kept) == 8 and finding.values == {"slices": [4]}
