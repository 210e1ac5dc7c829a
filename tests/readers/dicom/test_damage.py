"""Damaged or hostile DICOM files: cut, mislabelled, inflated, nested or altered; refused, and never misread."""

from pathlib import Path

import numpy as np
from dicom_series import head, save, series

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct


def test_damaged_headers_are_refused_reported_or_harmless(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head((10, 16, 18))))
    whole, _ = read_ct(folder)
    victim = folder / "image0004.dcm"
    good = victim.read_bytes()
    pixels = good.index(b"\xe0\x7f\x10\x00OW")
    rng = np.random.default_rng(11)
    for _ in range(250):
        bad = bytearray(good)
        for at in rng.integers(128, pixels, rng.integers(1, 4)):
            bad[at] = rng.integers(256)
        victim.write_bytes(bad)
        try:
            volume, report = read_ct(folder)
        except InputRefused as error:
            assert error.code not in {"CorruptFile", "UnsupportedFile"}
            continue
        same = np.array_equal(volume.voxels, whole.voxels) and np.allclose(volume.affine, whole.affine)
        assert same or {f.severity for f in report.findings} - {"info"}
