"""Exams of several series: the head CT in thin axial slices is chosen, and no choice is made between equals."""

from pathlib import Path

import numpy as np
import pytest
from dicom_series import STEP, head, save, series
from pydicom.uid import (
    generate_uid,
)

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from data_synth.fault_edits import set_elements


def test_the_thin_axial_series_is_chosen(tmp_path: Path) -> None:
    thick = series(head()[::3], step=3 * STEP)
    coronal = series(head().transpose(1, 0, 2)[:, ::-1], orientation=(1, 0, 0, 0, 0, -1), step=0.9)
    set_elements(slice(None), ImageType=["DERIVED", "SECONDARY", "MPR"], SeriesNumber=7)(coronal)
    thin = series(head())
    for k, group in enumerate((thick, coronal, thin)):
        set_elements(slice(None), StudyInstanceUID="1.2.3", SeriesNumber=k + 5)(group)
        save(tmp_path / "exam" / str(k), group)
    volume, report = read_ct(tmp_path / "exam")
    np.testing.assert_array_equal(volume.voxels, head())
    assert [f.code for f in report.findings] == ["SeriesChosen", "SeriesSkipped", "SeriesSkipped"]
    assert report.findings[0].values["series"] == 7


def test_the_soft_kernel_is_chosen_among_equals(tmp_path: Path) -> None:
    soft, sharp = series(head()), series(head() + 1)
    set_elements(slice(None), ConvolutionKernel="H70h")(sharp)
    for name, group in (("a", sharp), ("b", soft)):
        set_elements(slice(None), StudyInstanceUID="1.2.3")(group)
        save(tmp_path / "exam" / name, group)
    volume, _ = read_ct(tmp_path / "exam")
    np.testing.assert_array_equal(volume.voxels, head())


@pytest.mark.parametrize(
    ("change", "code"), [("series", "AmbiguousSeries"), ("study", "AmbiguousSeries"), ("patient", "MixedPatients")]
)
def test_two_equal_scans_are_not_chosen_from(change: str, code: str, tmp_path: Path) -> None:
    for name in ("a", "b"):
        group = series(head())
        study = "1.2.3" if change != "study" else generate_uid()
        set_elements(slice(None), StudyInstanceUID=study)(group)
        if change == "patient" and name == "b":
            set_elements(slice(None), PatientID="SECRET-2")(group)
        save(tmp_path / "exam" / name, group)
    with pytest.raises(InputRefused) as caught:
        read_ct(tmp_path / "exam")
    assert caught.value.code == code and "SECRET" not in str(caught.value)
