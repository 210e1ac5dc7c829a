"""Altered NIfTI and NRRD files: refused in one sentence, or read as a sound CT. DICOM: see `dicom/test_damage.py`.

`benchmarks/fuzz.py` searches longer, led by the branches that are reached.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from image_files import stored_head, write_nifti, write_nrrd

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct

BYTES = st.one_of(st.sampled_from((0, 1, 0x7F, 0x80, 0xFF, ord("-"), ord("9"), ord("\n"))), st.integers(0, 255))
EDITS = st.lists(st.tuples(st.integers(0, 400), BYTES), min_size=1, max_size=6)  # both headers end before byte 400
MANY = settings(max_examples=max(60, settings.default.max_examples))


@pytest.mark.parametrize("kind", ["nii", "nii.gz", "nrrd"])
@MANY
@given(edits=EDITS, keep=st.one_of(st.just(1.0), st.floats(0, 1)))
def test_altered_image_files_are_refused_or_read_soundly(kind, edits, keep):
    voxels, lps = stored_head()
    with TemporaryDirectory() as folder:
        write = write_nrrd if kind == "nrrd" else write_nifti
        path = write(Path(folder) / f"a.{kind}", voxels, lps)
        altered = bytearray(path.read_bytes())
        for at, byte in edits:
            altered[at] = byte
        path.write_bytes(altered[: int(len(altered) * keep)])
        try:
            volume, report = read_ct(path)
        except InputRefused as error:
            assert str(error) and folder not in str(error)
            return
    assert volume.voxels.ndim == 3 and volume.voxels.size <= 4 * voxels.size
    assert np.isfinite(volume.voxels).all() and np.isfinite(volume.affine).all()
    assert np.linalg.det(volume.affine[:3, :3]) != 0
    assert (volume.canonical().affine == volume.affine).all()
    assert np.isfinite(report.stored_affine).all()
