"""What was read -> a digest that tells two inputs apart and says nothing of whose they are.

It is of the voxels and their place alone: no text of a header, no name of a file and no path goes into it.
"""

from __future__ import annotations

import hashlib

import numpy as np

from ..volume import Volume

_MM = 1e-3  # places are told apart by so much


def digest_volume(volume: Volume) -> str:
    """SHA-256 of a volume: its shape, kind of numbers, place and voxels.

    Parameters
    ----------
    volume : Volume

    Returns
    -------
    str
        64 hex digits. Equal for a scan read as DICOM and as NIfTI, where both hold the same numbers.

    Examples
    --------
    >>> volume = Volume(np.zeros((2, 2, 2), np.int16), np.eye(4))
    >>> digest_volume(volume)[:8], digest_volume(volume) == digest_volume(volume.with_voxels(volume.voxels + 1))
    ('...', False)
    """
    place = np.rint(volume.affine / _MM).astype("<i8")
    found = hashlib.sha256(f"{volume.shape} {volume.voxels.dtype.name}".encode() + place.tobytes())
    for plane in volume.voxels:  # a copy of one plane at a time, where the planes are views
        found.update(np.ascontiguousarray(plane).data)
    return found.hexdigest()


def case_label(digest: str) -> str:
    """A short name for a scan, made from its digest: the same in every report on that scan.

    Parameters
    ----------
    digest : str
        Of the scan.

    Returns
    -------
    str

    Examples
    --------
    >>> case_label("3f2a9c1b77d0")
    '3f2a-9c1b'
    """
    return f"{digest[:4]}-{digest[4:8]}"
