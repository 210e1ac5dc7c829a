"""A shape prior -> a file, and back.

The file is a NumPy archive of plain arrays (mm of the mean head, single precision), about 3 MB for 30 skulls. It is
written whole or not at all, and read without pickle: nothing in it is ever run.
"""

from __future__ import annotations

import os
import tempfile
import zipfile
import zlib
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import CannotWrite, InputRefused
from .shape_prior import Prior
from .skull_points import SkullPoints
from .vault_radii import vault_rays

VERSION = 1
"""Of the file; another version is refused."""
_REMEDY = "Make one with `cranio-nb prior learn`."


def save_prior(prior: Prior, path: Path) -> None:
    """Write a prior, whole or not at all.

    Parameters
    ----------
    prior : Prior
    path : Path
        Of the file, in a folder that is there.

    Raises
    ------
    CannotWrite
        ``CannotWrite`` when the system refuses; what was there before is still there.
    """
    outer, inner, radii = (np.asarray(a, np.float32) for a in (prior.mean.outer, prior.mean.inner, prior.radii))
    # written beside its goal and moved there in one step
    try:
        with tempfile.TemporaryDirectory(prefix=".part-", dir=path.absolute().parent) as folder:
            part = Path(folder) / "prior.npz"
            np.savez_compressed(part, version=np.int64(VERSION), inside=inner, outside=outer, radii=radii)
            os.replace(part, path)
    except OSError as error:
        reason = error.strerror or type(error).__name__
        raise CannotWrite("CannotWrite", f"The prior could not be written: {reason}.") from error


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
    # without pickle: whatever the file holds, none of it is run
    try:
        with open(path, "rb") as file, np.load(file, allow_pickle=False) as held:
            version = int(held["version"])
            arrays = {name: held[name] for name in held.files}
    except OSError as error:
        raise InputRefused("NoPrior", "The prior cannot be opened; is the path right?", _REMEDY) from error
    except (ValueError, KeyError, TypeError, IndexError, AttributeError, EOFError, zlib.error) as error:
        raise InputRefused("NoPrior", "The file is not a shape prior.", _REMEDY) from error
    except zipfile.BadZipFile as error:
        raise InputRefused("NoPrior", "The file is not a shape prior, or it is damaged.", _REMEDY) from error
    if version != VERSION:
        message = f"The prior has version {version}; this program reads version {VERSION}."
        raise InputRefused("NoPrior", message, _REMEDY)
    return _checked(arrays)


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
