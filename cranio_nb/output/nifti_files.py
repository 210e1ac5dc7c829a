"""Masks and CTs -> NIfTI, on the input's own grid, read back and compared.

Frame: a `Volume` is in world mm, DICOM LPS; NIfTI holds the same places in RAS.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from zlib_ng import gzip_ng, zlib_ng

from ..errors import CannotWrite
from ..grid import AxisOrder
from ..volume import Volume
from .files import write_whole

_AFFINE_TOLERANCE_MM = 1e-3
_TYPES = ("uint8", "int16", "int32", "float32", "float64")
_VOXELS_AT = 352  # bytes: the header, and that nothing extends it
_GZIP = 31  # a window of 32 kB within gzip, in the words of zlib
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
    voxels = stored.voxels.view(np.uint8) if stored.voxels.dtype == bool else stored.voxels
    if voxels.dtype.name not in _TYPES:
        raise CannotWrite("BadFormat", f"Voxels of {voxels.dtype} cannot be stored; use {', '.join(_TYPES)}.")
    affine = _LPS_TO_RAS @ stored.affine
    # no time stamp in the compressed file: equal volumes give equal files
    parts = _nifti_bytes(voxels, affine)
    data = _packed(parts) if path.name.lower().endswith(".gz") else b"".join(parts)
    write_whole(path, data, lambda part: _check_nifti_file(part, voxels, affine))


def _nifti_bytes(voxels: NDArray, affine: NDArray[np.float64]) -> Iterator[bytes]:
    """A NIfTI-1 file with both of its affines, mm, and no text: its header, then plane by plane, never all of it."""
    import nibabel

    header = nibabel.Nifti1Header()
    header.set_data_dtype(voxels.dtype)
    header.set_data_shape(voxels.shape)
    header.set_sform(affine, code=1)
    header.set_qform(affine, code=1)
    header.set_xyzt_units("mm")
    header["magic"], header["vox_offset"] = b"n+1", _VOXELS_AT
    yield header.binaryblock.ljust(_VOXELS_AT, b"\0")
    # the first axis runs fastest
    yield from (plane.tobytes() for plane in voxels.T)


def _packed(parts: Iterable[bytes]) -> bytes:
    """The same as gzip, without a time stamp."""
    packer = zlib_ng.compressobj(wbits=_GZIP)
    return b"".join([*(packer.compress(part) for part in parts), packer.flush()])


def _check_nifti_file(part: Path, voxels: NDArray, affine: NDArray[np.float64]) -> None:
    """Read a NIfTI file back and compare it, plane by plane."""
    import nibabel

    packed = part.name.lower().endswith(".gz")
    with gzip_ng.open(part) if packed else part.open("rb") as file:
        head = nibabel.Nifti1Header.from_fileobj(file)
        file.seek(_VOXELS_AT)
        same = head.get_data_shape() == voxels.shape and head.get_data_dtype() == voxels.dtype
        same = same and all(file.read(plane.nbytes) == plane.tobytes() for plane in voxels.T) and not file.read(1)
    if not same or np.abs(head.get_best_affine() - affine).max() > _AFFINE_TOLERANCE_MM:
        raise CannotWrite("CannotWrite", "The volume does not survive its file: it reads back as another one.")
