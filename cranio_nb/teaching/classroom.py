"""What the lessons work on: a synthetic head or somebody's own scan, a slice of it, folders to write to.

Frames: a lesson's slices are (row, col) px of one plane of the scan; `LessonCase.px` is the size of a pixel in mm.

Everything is made on the spot from a seed, so a lesson needs no network and no data. Where the lesson is run on
somebody's own scan there is no truth, and what is drawn or measured against it is left out.
"""

from __future__ import annotations

import os
import shutil
import tempfile
import warnings
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from skimage.morphology import skeletonize

from ..curves import GapEnds
from ..errors import InputRefused
from ..opening import Opening
from ..readers import read_ct, warnings_of
from ..stages import feature_extraction
from ..volume import Volume

if TYPE_CHECKING:
    from data_synth import Case, Gap


@dataclass(frozen=True, eq=False)
class LessonCase:
    """A scan to work on, with what is known about it.

    Parameters
    ----------
    ct : Volume
        HU.
    truth : Volume or None
        Bool mask of the missing bone; None for a scan of one's own.
    phantom : data_synth.Case or None
        The synthetic head behind it.
    """

    ct: Volume
    truth: Volume | None
    phantom: Case | None

    @property
    def px(self) -> float:
        """Size of a pixel of a slice.

        Returns
        -------
        float
            mm.
        """
        return float(self.ct.spacing[1:].mean())

    def true_curves(self, plane: int) -> tuple[NDArray[np.float64], ...]:
        """Closed-form curves across the widest gap of a plane.

        Parameters
        ----------
        plane : int

        Returns
        -------
        tuple of ndarray, shape (n, 2)
            Outer and inner curve, (row, col) px; empty where they are not known.
        """
        return tuple(gap.curve for gap in self._widest(plane))

    def true_angles(self, plane: int) -> tuple[NDArray[np.float64], ...]:
        """Closed-form end angles of the widest gap of a plane.

        Parameters
        ----------
        plane : int

        Returns
        -------
        tuple of ndarray, shape (2,)
            (theta0, theta1) of the outer and of the inner gap, degrees; empty where they are not known.
        """
        return tuple(gap.angles for gap in self._widest(plane))

    @cached_property
    def _widest(self) -> Callable[[int], tuple[Gap, ...]]:
        # the closed form of a plane takes a while, and lessons ask for the same planes again and again
        return cache(self._find_widest)

    def _find_widest(self, plane: int) -> tuple[Gap, ...]:
        # gaps that both boundaries have, and of these the one with the longest outer chord
        truths = self.phantom.slice_truth(plane) if self.phantom else ()
        gaps = [(t.outer, t.inner) for t in truths if t.outer and t.inner]
        return max(gaps, key=lambda pair: pair[0].chord, default=())


def load(
    size: str = "class",
    *,
    defect: str = "unilateral",
    seed: int = 0,
    scan: str | os.PathLike[str] | None = None,
    truth: str | os.PathLike[str] | None = None,
    needs_truth: bool = False,
) -> LessonCase:
    """The case of a lesson.

    Parameters
    ----------
    size : {"tiny", "class", "full"}
        Grid of the synthetic head; the environment variable ``CRANIO_NB_SIZE`` goes before it.
    defect : str
        Kind of hole, a key of `data_synth.DEFECTS`.
    seed : int
        Chooses head, place and rim.
    scan : path, optional
        A scan of one's own (DICOM folder, NIfTI or NRRD with HU) instead; ``CRANIO_NB_SCAN`` goes before it.
    truth : path, optional
        Mask of the bone that is missing in that scan, where it is known; ``CRANIO_NB_TRUTH`` goes before it.
    needs_truth : bool
        Whether the lesson makes no sense without a truth.

    Returns
    -------
    LessonCase

    Raises
    ------
    InputRefused
        If the scan or the truth cannot be read, or the truth is wanted and there is none (``NoTruth``).
    ValueError
        If there is no such size or defect.
    """
    # the environment goes before the lesson's own arguments: a course can give all lessons one scan
    path, known = os.environ.get("CRANIO_NB_SCAN") or scan, os.environ.get("CRANIO_NB_TRUTH") or truth
    if path and needs_truth and not known:
        raise InputRefused(
            "NoTruth",
            "This lesson measures against the bone that is missing, and for this scan it is not known.",
            "Name its mask in CRANIO_NB_TRUTH (`cranio-nb phantom --from` cuts a hole and writes one), "
            "or unset CRANIO_NB_SCAN.",
        )
    if path:
        from ..pipeline.truth_file import read_truth

        ct, load = read_ct(path)
        mask, said = read_truth(known, ct) if known else (None, ())
        for one in (*warnings_of(load.findings), *said):
            warnings.warn(one.message, stacklevel=2)
        return LessonCase(ct, mask, None)
    return synthetic(os.environ.get("CRANIO_NB_SIZE") or size, defect, seed)


def synthetic(size: str = "class", defect: str = "unilateral", seed: int = 0, **scanner: Any) -> LessonCase:
    """A synthetic head as a lesson's case, whatever the environment names.

    Parameters
    ----------
    size : {"tiny", "class", "full"}
    defect : str
        A key of `data_synth.DEFECTS`.
    seed : int
    **scanner
        Further options of `data_synth.phantom_case`, e.g. ``couch=True`` or ``tilt_deg=15.0``.

    Returns
    -------
    LessonCase

    Examples
    --------
    >>> case = synthetic("tiny")
    >>> case.ct.shape, case.truth.voxels.any()
    ((44, 128, 128), np.True_)
    """
    from data_synth import phantom_case

    case = phantom_case(size, defect, seed, **scanner)
    assert case.hu is not None
    return LessonCase(Volume(case.hu, case.affine), Volume(case.implant, case.affine), case)


def scratch_folder(copy_of: str | os.PathLike[str] | None = None) -> Path:
    """A folder to write to, in a new place of its own.

    Parameters
    ----------
    copy_of : path, optional
        A folder whose files it gets.

    Returns
    -------
    Path
        Named ``ct``; it is there only where something was copied.
    """
    folder = Path(tempfile.mkdtemp()) / "ct"
    if copy_of is not None:
        shutil.copytree(copy_of, folder)
    return folder


def bridged_plane(bone: Volume, opening: Opening, *, skip_px: float, reach_px: float) -> int:
    """The plane nearest to the middle of an opening in which both ends of the gap can be seen.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening
    skip_px, reach_px : float
        As for `feature_extraction.find_gap_ends`, px.

    Returns
    -------
    int
        Index of the plane.

    Raises
    ------
    InputRefused
        ``NoAxialGap`` where no plane has both, as for a hole at the very top of the head.
    """
    # from the middle plane outwards until the stage finds both ends
    first, end = opening.planes
    for plane in sorted(range(first, end), key=lambda p: abs(p - (first + end) // 2)):
        with suppress(feature_extraction.SliceProblem):
            gap_ends(bone, opening, plane, skip_px=skip_px, reach_px=reach_px)
            return plane
    raise InputRefused(
        "NoAxialGap",
        "In no slice of this scan can both ends of the gap be seen.",
        "This lesson cuts as the paper does, along the scan's own slices: take a hole in the side of the head.",
    )


def gap_ends(bone: Volume, opening: Opening, plane: int, *, skip_px: float, reach_px: float) -> tuple[GapEnds, GapEnds]:
    """The ends of an opening's gap in one plane: both steps of the stage, features and ends, in one.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening
    plane : int
    skip_px, reach_px : float
        As for `feature_extraction.find_gap_ends`, px.

    Returns
    -------
    outer, inner : GapEnds
        (row, col) px.

    Raises
    ------
    SliceProblem
        Where the plane has no gap with two ends.
    """
    seen = feature_extraction.extract_features(bone.voxels[plane])
    return feature_extraction.find_gap_ends(seen, opening.sheet.voxels[plane], skip_px=skip_px, reach_px=reach_px)


def skeleton(mask: NDArray[np.bool_]) -> NDArray[np.intp]:
    """The raw skeleton of a mask, forks and spurs included; `feature_extraction` keeps the longest path through it.

    Parameters
    ----------
    mask : ndarray of bool, shape (R, C)

    Returns
    -------
    ndarray of int, shape (n, 2)
        (row, col) px.

    Examples
    --------
    >>> skeleton(np.eye(3, dtype=bool)).tolist()
    [[0, 0], [1, 1], [2, 2]]
    """
    return np.argwhere(skeletonize(np.array(mask)))  # a copy: it takes no read-only array


def distance_to_curve(points: NDArray[np.float64], curve: NDArray[np.float64]) -> NDArray[np.float64]:
    """Distance of points to the nearest place of a curve, on its points or between them.

    Parameters
    ----------
    points : ndarray, shape (m, d)
    curve : ndarray, shape (n, d)
        A polyline, n > 1, no two neighbours alike.

    Returns
    -------
    ndarray, shape (m,)
        In the unit of the points.

    Examples
    --------
    >>> distance_to_curve(np.array([[1.0, 2.0], [7.0, 4.0]]), np.array([[0.0, 0.0], [4.0, 0.0]])).tolist()
    [2.0, 5.0]
    """
    start, step = curve[:-1], np.diff(curve, axis=0)
    # foot of each point on each segment: along it by a share of 0 to 1
    away = points[:, None] - start
    share = np.clip((away * step).sum(axis=-1) / (step**2).sum(axis=-1), 0.0, 1.0)
    return np.asarray(np.linalg.norm(away - share[..., None] * step, axis=-1).min(axis=1))
