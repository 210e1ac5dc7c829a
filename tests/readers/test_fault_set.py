"""The whole fault set: every valid folder exactly, no faulty one in silence, no error that is not ours."""

from pathlib import Path

import numpy as np

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.volume import Volume
from data_synth.faults import FaultCase, fault_cases


def is_exact(volume: Volume, case: FaultCase) -> bool:
    """Whether every voxel of the truth is in the volume, at its own place."""
    index = np.stack(np.meshgrid(*map(np.arange, case.hu.shape), indexing="ij"), axis=-1).reshape(-1, 3)
    at = volume.to_voxel(index @ case.affine[:3, :3].T + case.affine[:3, 3])
    nearest = np.rint(at).astype(int)
    if volume.voxels.size != case.hu.size or np.abs(at - nearest).max() > 1e-2:
        return False
    inside = (nearest >= 0).all() and (nearest < volume.shape).all()
    return bool(inside) and np.array_equal(volume.voxels[tuple(nearest.T)], case.hu.ravel())


def test_valid_folders_are_read_exactly(tmp_path: Path) -> None:
    wrong = []
    for case, path in fault_cases(tmp_path, valid=True):
        try:
            volume, _ = read_ct(path)
        except InputRefused as error:
            wrong.append((case.name, error.code))
            continue
        if not is_exact(volume, case):
            wrong.append((case.name, "differs"))
    assert wrong == []


def test_no_fault_is_silent(tmp_path: Path) -> None:
    silent = []
    for case, path in fault_cases(tmp_path, valid=False):
        try:
            volume, report = read_ct(path)
        except InputRefused as error:
            assert error.code not in {"CorruptFile", "UnsupportedFile"}, case.name
            continue
        said = any(finding.severity != "info" for finding in report.findings)
        if not said and not (case.recovered and is_exact(volume, case)):
            silent.append(case.name)
    assert silent == []
