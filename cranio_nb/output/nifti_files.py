"""Masks and CTs -> NIfTI, on the input's own grid, read back and compared.

Frame: a `Volume` is in world mm, DICOM LPS; NIfTI holds the same places in RAS.
"""

from __future__ import annotations

import gzip
import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import CannotWrite
from ..grid import AxisOrder
from ..volume import Volume
from .files import write_whole

_AFFINE_TOLERANCE_MM = 1e-3
_TYPES = ("uint8", "int16", "int32", "float32", "float64")
_LPS_TO_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])


def write_nifti(volume: Volume, path: str | Path, order: AxisOrder | None = None) -> None:
    """Write a mask or a CT as NIfTI (.nii or .nii.gz).

    Parameters
    ----------
    volume : Volume
        Bool is stored as uint8 0 / 1; uint8, int16, int32, float32 and float64 as they are.
    path : str or Path
        File name.
    order : AxisOrder, optional
        How the input's stored axes became (plane, row, col), from its `LoadReport`. With it the file stands on
        the input's own grid, axis by axis; without it the axes are (plane, row, col).

    Raises
    ------
    CannotWrite
        If the suffix or the type of the voxels is another one (BadFormat), or the file cannot be written.

    Examples
    --------
    >>> import nibabel
    >>> write_nifti(Volume(np.ones((2, 3, 4), bool), np.eye(4)), "mask.nii.gz")
    >>> nibabel.load("mask.nii.gz").shape
    (2, 3, 4)
    """
    path = Path(path)
    if not path.name.lower().endswith((".nii", ".nii.gz")):
        raise CannotWrite("BadFormat", f"{path.name} has no NIfTI suffix; use .nii or .nii.gz.")
    # stored as the input was, axis by axis, in RAS as the format asks
    stored = volume if order is None else volume.reorder(order.inverse)
    voxels = stored.voxels.astype(np.uint8) if stored.voxels.dtype == bool else stored.voxels
    if voxels.dtype.name not in _TYPES:
        raise CannotWrite("BadFormat", f"Voxels of {voxels.dtype} cannot be stored; use {', '.join(_TYPES)}.")
    affine = _LPS_TO_RAS @ stored.affine
    # no time stamp in the compressed file: equal volumes give equal files
    data = _nifti_bytes(voxels, affine)
    if path.name.lower().endswith(".gz"):
        data = gzip.compress(data, compresslevel=4, mtime=0)
    write_whole(path, data, lambda part: _check_nifti_file(part, voxels, affine))


def _nifti_bytes(voxels: NDArray, affine: NDArray[np.float64]) -> bytes:
    """A NIfTI-1 file with both of its affines, mm, and no text."""
    import nibabel

    image = nibabel.Nifti1Image(voxels, None)
    image.set_sform(affine, code=1)
    image.set_qform(affine, code=1)
    image.header.set_xyzt_units("mm")
    return image.to_bytes()


def _check_nifti_file(part: Path, voxels: NDArray, affine: NDArray[np.float64]) -> None:
    """Read a NIfTI file back and compare it."""
    import nibabel

    data = part.read_bytes()
    plain = gzip.decompress(data) if part.name.lower().endswith(".gz") else data
    back = nibabel.Nifti1Image.from_stream(io.BytesIO(plain))
    same = back.shape == voxels.shape and np.array_equal(np.asanyarray(back.dataobj), voxels)
    if not same or np.abs(back.affine - affine).max() > _AFFINE_TOLERANCE_MM:
        raise CannotWrite("CannotWrite", "The volume does not survive its file: it reads back as another one.")
