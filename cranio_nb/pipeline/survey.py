"""A scan -> its bone, how the head lies in it, and every opening with the verdict on it.

Frames: all on the grid of the scan; the head's axes in the world (mm, LPS). What is intact, natural, doubtful or cut is
found here for every command: `inspect`, `design`, `compare` and `phantom --from`.
"""

from __future__ import annotations

from dataclasses import dataclass

from ..stages.segmentation import bone_of
from ..vault.head_frame import HeadFrame, find_head_frame
from ..vault.opening_choice import JudgedOpening
from ..vault.opening_search import survey_openings
from ..volume import Volume


@dataclass(frozen=True, eq=False)
class Survey:
    """What a scan shows of the skull.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    frame : HeadFrame
        How the head lies.
    found : tuple of JudgedOpening
        All openings, cut or natural, largest first.
    """

    bone: Volume
    frame: HeadFrame
    found: tuple[JudgedOpening, ...]


def survey_scan(scan: Volume, threshold: float | None = None) -> Survey:
    """Find the bone of a scan and its openings.

    Parameters
    ----------
    scan : Volume
        HU, or a bool mask, shape (P, R, C).
    threshold : float, optional
        Lowest HU of bone; `segmentation.BONE_HU` when not given.

    Returns
    -------
    Survey

    Raises
    ------
    InputRefused
        ``NoBone``, ``ThresholdOfMask`` or ``NoVault``.

    Examples
    --------
    >>> from data_synth import phantom_case
    >>> case = phantom_case("tiny", "burr_hole", 0)
    >>> [one.verdict.kind for one in survey_scan(Volume(case.hu, case.affine)).found]
    ['cut']
    """
    bone = bone_of(scan, threshold)
    frame = find_head_frame(bone)
    return Survey(bone, frame, survey_openings(bone, scan=scan, frame=frame))
