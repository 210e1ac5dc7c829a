"""A shape prior -> the bytes of a file, and back.

The file is a NumPy archive of plain arrays (mm of the mean head, single precision), about 3 MB for 30 skulls. It is
read without pickle: nothing in it is ever run. What it would inflate to is bounded before anything is inflated.
"""

from __future__ import annotations

import io
import zipfile
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import InputRefused
from .shape_prior import Prior
from .skull_points import SkullPoints
from .vault_radii import vault_rays

VERSION = 1
"""Of the file; another version is refused."""
MAX_BYTES = 2**28
"""Of its arrays together: some five thousand skulls."""
_MAX_HEADER = 1000  # bytes that say an array's type and shape
_REMEDY = "Make one with `cranio-nb prior learn`."


def pack_prior(prior: Prior) -> bytes:
    """Pack a prior.

    Parameters
    ----------
    prior : Prior

    Returns
    -------
    bytes
        Of the file.
    """
    outer, inner, radii = (np.asarray(a, np.float32) for a in (prior.mean.outer, prior.mean.inner, prior.radii))
    packed = io.BytesIO()
    np.savez_compressed(packed, version=np.int64(VERSION), inside=inner, outside=outer, radii=radii)
    return packed.getvalue()


def load_prior(path: Path) -> Prior:
    """Read a prior.

    Parameters
    ----------
    path : Path

    Returns
    -------
    Prior

    Raises
    ------
    InputRefused
        ``NoPrior`` when there is no such file, or when it is no sound prior of this version.
    """
    try:
        with open(path, "rb") as file, zipfile.ZipFile(file) as held:
            _check_bytes(held)
            version = int(_read_array(held, "version"))
            arrays = {name: _read_array(held, name) for name in ("inside", "outside", "radii")}
    except InputRefused:
        raise
    except OSError as error:
        raise InputRefused("NoPrior", "The prior cannot be opened; is the path right?", _REMEDY) from error
    except (ValueError, KeyError, TypeError, EOFError, NotImplementedError, RuntimeError, zlib.error) as error:
        raise InputRefused("NoPrior", "The file is not a shape prior.", _REMEDY) from error
    except zipfile.BadZipFile as error:
        raise InputRefused("NoPrior", "The file is not a shape prior, or it is damaged.", _REMEDY) from error
    if version != VERSION:
        message = f"The prior has version {version}; this program reads version {VERSION}."
        raise InputRefused("NoPrior", message, _REMEDY)
    return _checked(arrays)


def _check_bytes(held: zipfile.ZipFile) -> None:
    """Refuse an archive whose own list promises more than is read."""
    promised = sum(entry.file_size for entry in held.infolist())
    if promised > MAX_BYTES:
        message = f"The prior would take {promised / 1e6:.0f} MB; at most {MAX_BYTES / 1e6:.0f} MB are read."
        raise InputRefused("NoPrior", message, _REMEDY)


def _read_array(held: zipfile.ZipFile, name: str) -> NDArray:
    """An array of an archive: as large as the archive's list says, or refused before it is allocated."""
    entry = held.getinfo(f"{name}.npy")
    # no more is inflated than the list says; without pickle, none of it is run
    with held.open(entry) as stream:
        if np.lib.format.read_magic(stream) != (1, 0):
            raise ValueError("another form of array")
        shape, _, dtype = np.lib.format.read_array_header_1_0(stream, max_header_size=_MAX_HEADER)
        if not 0 <= entry.file_size - np.prod([float(n) for n in shape]) * dtype.itemsize <= _MAX_HEADER:
            raise ValueError("the array is not as large as it says")
    with held.open(entry) as stream:
        return np.lib.format.read_array(stream, allow_pickle=False, max_header_size=_MAX_HEADER)


def _checked(arrays: dict[str, NDArray]) -> Prior:
    """The prior in the arrays of a file, if they have the form of one."""
    shapes = {"inside": (None, 3), "outside": (None, 3), "radii": (None, 2, len(vault_rays()))}
    # None stands for any number above 0
    for name, shape in shapes.items():
        array = arrays.get(name, np.zeros(0))
        good = array.dtype == np.float32 and array.ndim == len(shape) and len(array) > 0
        if not good or array.shape[1:] != shape[1:] or not np.isfinite(array).all():
            raise InputRefused("NoPrior", f"The prior is damaged: its {name} part is not as it should be.", _REMEDY)
    outer, inner = (arrays[name].astype(float) for name in ("outside", "inside"))
    mean = SkullPoints(outer=outer, inner=inner, centre=np.zeros(3), axes=np.eye(3))
    return Prior(mean, arrays["radii"])
