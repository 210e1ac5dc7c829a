"""The file with the mask of the missing bone of a scan -> the mask, once it is sure that it belongs to the scan."""

from __future__ import annotations

from os import PathLike

from ..errors import InputRefused
from ..readers import Finding, read_ct, warnings_of
from ..volume import Volume, same_grid


def read_truth(path: str | PathLike[str], scan: Volume) -> tuple[Volume, tuple[Finding, ...]]:
    """Read the mask of the missing bone of a scan.

    Parameters
    ----------
    path : path
        NIfTI or NRRD file or DICOM folder: each nonzero voxel is missing bone.
    scan : Volume
        The scan, on whose grid the mask has to be.

    Returns
    -------
    truth : Volume
        Bool mask, not empty.
    warnings : tuple of Finding
        What the file warns of.

    Raises
    ------
    InputRefused
        What cannot be read safely; ``GridMismatch`` or ``EmptyMask``.
    """
    truth, load = read_ct(path, mask=True)
    if not same_grid(scan, truth):
        message = f"The truth has shape {truth.shape}, the scan {scan.shape}, or they lie at different places."
        raise InputRefused("GridMismatch", message, "Give a truth mask on the scan's own grid.")
    if not truth.voxels.any():
        raise InputRefused("EmptyMask", "The truth mask is empty; there is nothing to compare with.")
    return truth, warnings_of(load.findings, "The truth")
