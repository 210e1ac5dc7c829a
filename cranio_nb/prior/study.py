"""A folder of scans -> the intact skulls in it; a shape prior -> how well it predicts skulls it was not given.

Frame: mean head (see `mean_frame`); radii in mm of the mean head.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import CranioError, InputRefused
from ..readers import read_ct, warnings_of
from ..stages.segmentation import bone_of
from ..volume import Volume
from .learning import check_intact
from .shape_prior import Prior, conditional_mean
from .vault_radii import vault_rays

_FILES = (".nii", ".nii.gz", ".nrrd")
_HOLES = ((0.0, 1.0, 0.5), (0.0, 0.1, 1.0), (0.8, 0.4, 0.6), (0.3, -0.8, 0.7))  # occipital, vertex, parietal, frontal
_HALF_RAD, _BESIDE_RAD = np.radians(25.0), np.radians(3.0)  # a hole of 70 mm, and the rim beside it that is not trusted


@dataclass(frozen=True)
class Accuracy:
    """Error of a prior in holes cut into skulls it was not given.

    Parameters
    ----------
    n_skulls : int
        How many skulls it was given.
    outer, inner : float
        Mean absolute error of the radii inside the holes, mm of the mean head.
    """

    n_skulls: int
    outer: float
    inner: float


def list_scans(folder: Path) -> list[Path]:
    """What may be scans in a folder: NIfTI and NRRD files, and subfolders of DICOM files.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    list of Path
        By name.

    Raises
    ------
    InputRefused
        ``NoScans`` when there is none.
    """
    if not folder.is_dir():
        raise InputRefused("NoScans", "There is no such folder of scans.", "Give a folder with one scan of each head.")
    # by name, so that every run takes the scans in one order; hidden files are no scans
    found = [p for p in sorted(folder.iterdir()) if p.is_dir() or p.name.lower().endswith(_FILES)]
    found = [p for p in found if not p.name.startswith(".")]
    if not found:
        message = "The folder holds no NIfTI or NRRD file and no subfolder."
        raise InputRefused("NoScans", message, "Give a folder with one scan of each head.")
    return found


def read_intact_skulls(
    scans: list[Path],
    *,
    threshold: float | None = None,
    skipped: Callable[[str, str], None],
    warned: Callable[[str, str], None],
    progress: Callable[[str, float], None] | None = None,
) -> Iterator[Volume]:
    """Bone masks of those scans that show a whole, closed skull, one at a time.

    Parameters
    ----------
    scans : list of Path
        See `list_scans`.
    threshold : float, optional
        Lowest HU of bone in a CT; the package's default when not given.
    skipped : callable
        Called with (name, why) for every other scan.
    warned : callable
        Called with (name, sentence) for all that a scan warns of.
    progress : callable, optional
        Called with (step, fraction).

    Yields
    ------
    Volume
        Bool mask.
    """
    for i, path in enumerate(scans):
        if progress:
            progress("reading", i / len(scans))
        # a scan that cannot be used is told about, and the next one read
        try:
            scan, load = read_ct(path)
            bone = bone_of(scan, None if scan.voxels.dtype == bool else threshold)
            check_intact(bone, scan)
        except CranioError as error:
            skipped(path.name, error.message)
            continue
        for one in warnings_of(load.findings):
            warned(path.name, one.message)
        yield bone


def measure_learning_curve(
    prior: Prior, sizes: tuple[int, ...] = (5, 10, 20), progress: Callable[[str, float], None] | None = None
) -> tuple[Accuracy, ...]:
    """How the error falls with the number of skulls: each skull in turn is left out, opened and closed again.

    Parameters
    ----------
    prior : Prior
        Of at least 3 skulls.
    sizes : tuple of int
        Numbers of skulls to learn from; those that are too large are left out, and all but one is added.
    progress : callable, optional
        Called with (step, fraction).

    Returns
    -------
    tuple of Accuracy
        By rising number of skulls.

    Notes
    -----
    One hole of 70 mm a skull, at four places in turn. The skull that is left out had its part in the mean head on which
    all were laid, and lies on it as the intact skull does: the error on new skulls with real holes is a little larger.
    """
    # learn from some of the others, predict the one left out
    n = len(prior.radii)
    counts = sorted({size for size in sizes if size < n - 1} | {n - 1})
    rows = []
    for round_, count in enumerate(counts):
        errors = []
        for one in range(n):
            if progress:
                progress("checking", (round_ + one / n) / len(counts))
            # as many of the others as asked for, and a hole in the one left out
            others = np.random.default_rng(one).permutation(np.delete(np.arange(n), one))[:count]
            place = np.array(_HOLES[one % len(_HOLES)])
            errors.append(_error(prior.subset(others), prior.radii[one].astype(float), place))
        outer, inner = np.mean(errors, axis=0)
        rows.append(Accuracy(count, float(outer), float(inner)))
    return tuple(rows)


def _error(prior: Prior, truth: NDArray[np.float64], place: NDArray[np.float64]) -> NDArray[np.float64]:
    """Mean absolute error of the outer and the inner radius in a round hole, shape (2,)."""
    # a cap of the vault is taken away, with a ring beside it as if its rim were bevelled
    away = np.arccos(np.clip(vault_rays() @ place / np.linalg.norm(place), -1, 1))
    hole = away < _HALF_RAD
    known = np.where(away < _HALF_RAD + _BESIDE_RAD, np.nan, truth)
    return np.abs(conditional_mean(prior, known, hole) - truth[:, hole]).mean(axis=1)
