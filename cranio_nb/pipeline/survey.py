"""A scan -> its bone, how the head lies in it, and every opening with the verdict on it.

Frames: all on the grid of the scan; the head's axes in the world (mm, LPS). What is intact, natural, doubtful or cut is
found here for every command: `inspect`, `design`, `compare` and `phantom --from`.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

from ..readers import Finding
from ..stages.segmentation import parts_of
from ..vault.head_frame import HeadFrame, find_head_frame
from ..vault.opening_choice import JudgedOpening, choose_openings
from ..vault.opening_search import survey_openings
from ..vault.remarks import orientation_remarks, thickness_remarks
from ..vault.second_skull import second_skull_remarks
from ..vault.smallest_hole import smallest_hole_mm
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
    remarks : tuple of Finding
        What to know of the slices, of how the head lies, and of a second skull in the image.
    """

    bone: Volume
    frame: HeadFrame
    found: tuple[JudgedOpening, ...]
    remarks: tuple[Finding, ...]

    def choose(self, numbers: Collection[int] = ()) -> tuple[JudgedOpening, ...]:
        """The openings to close, as `choose_openings` picks them.

        Parameters
        ----------
        numbers : collection of int
            Those to close; when empty, those that were cut for sure.

        Returns
        -------
        tuple of JudgedOpening

        Raises
        ------
        InputRefused, NoOpening
            As `choose_openings`; that there is no opening is said with what this scan cannot show.
        """
        smallest_mm = smallest_hole_mm(float(self.bone.spacing.max()))
        return choose_openings(self.found, numbers, smallest_mm=smallest_mm, said=self.remarks)


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
    parts = parts_of(scan, threshold)
    bone, frame = parts.bone, find_head_frame(parts.bone)
    remarks = (
        *thickness_remarks(float(scan.spacing.max())),
        *orientation_remarks(frame),
        *second_skull_remarks(bone, parts.others),
    )
    return Survey(bone, frame, survey_openings(bone, scan=scan, frame=frame), remarks)
