"""The fault set: enough folders, each with its truth, one at a time; valid ones hold it by plain reading."""

from pathlib import Path

import numpy as np
import pydicom

from data_synth.faults import fault_cases


def test_there_are_enough_of_both_kinds(tmp_path: Path) -> None:
    cases = [case for case, _ in fault_cases(tmp_path)]
    names = [case.name for case in cases]
    assert len(set(names)) == len(names)
    assert sum(case.valid for case in cases) >= 80 and sum(not case.valid for case in cases) >= 80
    assert list(tmp_path.iterdir()) == []


def test_one_folder_is_there_at_a_time(tmp_path: Path) -> None:
    for _, path in fault_cases(tmp_path, every=20):
        assert [entry for entry in tmp_path.iterdir()] == [path] and any(path.iterdir())


def test_the_truth_is_what_the_plain_files_hold(tmp_path: Path) -> None:
    case, path = next(fault_cases(tmp_path, valid=True))
    for k, file in enumerate(sorted(path.iterdir())):
        ds = pydicom.dcmread(file)
        np.testing.assert_array_equal(ds.pixel_array + float(ds.RescaleIntercept), case.hu[k])
        np.testing.assert_allclose(
            np.array(ds.ImagePositionPatient, float), case.affine[:3, :3] @ [k, 0, 0] + case.affine[:3, 3]
        )
