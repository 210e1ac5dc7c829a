"""The report leads back to the file, and holds no patient text."""

from pathlib import Path

import numpy as np
from dicom_series import SPACING, STEP, head, save, series

from cranio_nb.readers import read_ct


def test_report_holds_no_patient_text(tmp_path: Path) -> None:
    _, report = read_ct(save(tmp_path / "Nobody", series(head())))
    for secret in ("SECRET", "Nobody", "script", "touch", "1900", str(tmp_path)):
        assert secret not in repr(report)


def test_report_leads_back_to_the_stored_grid(tmp_path: Path) -> None:
    iop = (0.0, 1.0, 0.0, 0.0, 0.0, -1.0)
    volume, report = read_ct(save(tmp_path / "scan", series(head(), orientation=iop)))
    stored = volume.reorder(report.order.inverse)
    np.testing.assert_allclose(stored.affine, report.stored_affine, atol=1e-9)
    cols, rows, slices = stored.affine[:3, :3].T
    np.testing.assert_allclose(cols, np.array(iop[:3]) * SPACING[1], atol=1e-9)
    np.testing.assert_allclose(rows, np.array(iop[3:]) * SPACING[0], atol=1e-9)
    assert abs(np.linalg.norm(slices) - STEP) < 1e-9
