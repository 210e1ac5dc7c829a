"""A scan on disk -> what every method gets: the bone, its openings, and the missing bone where it is known."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from functools import cached_property
from os import PathLike

from ..errors import InputRefused, NoOpening
from ..opening import Opening
from ..readers import Finding, LoadReport, read_ct, warnings_of
from ..stages.segmentation import threshold_of
from ..vault.opening_choice import JudgedOpening
from ..vault.opening_search import bone_around
from ..vault.opening_size import OpeningSize
from ..vault.remarks import opening_remarks
from ..volume import Volume
from .input_digest import digest_volume
from .survey import Survey, survey_scan
from .truth_file import read_truth

Progress = Callable[[str, float], None]


@dataclass(frozen=True, eq=False)
class Prepared:
    """A scan as every method gets it.

    Parameters
    ----------
    load : LoadReport
    scan : Volume
        HU, or a bool mask, as it was read.
    bone : Volume
        Bool mask of the skull.
    closed, left_open : tuple of JudgedOpening
        The openings to close, and all others, the largest first.
    threshold : float or None
        HU of the bone threshold; None for a mask.
    truth : Volume or None
        Bool mask of the missing bone on the grid of `bone`.
    seconds : dict of str to float
        Time of each step.
    """

    load: LoadReport
    scan: Volume
    bone: Volume
    closed: tuple[JudgedOpening, ...]
    left_open: tuple[JudgedOpening, ...]
    threshold: float | None
    truth: Volume | None
    seconds: dict[str, float]

    @property
    def remarks(self) -> tuple[Finding, ...]:
        """What a person has to know before a design: what the scan warns of, and the openings in doubt or left open.

        Returns
        -------
        tuple of Finding
        """
        return (*warnings_of(self.load.findings), *opening_remarks(self.closed, self.left_open))

    @property
    def openings(self) -> tuple[Opening, ...]:
        """The openings to close, as methods take them.

        Returns
        -------
        tuple of Opening
        """
        return tuple(one.opening for one in self.closed)

    @property
    def sizes(self) -> tuple[OpeningSize, ...]:
        """Place and size of each of them.

        Returns
        -------
        tuple of OpeningSize
        """
        return tuple(one.size for one in self.closed)

    @cached_property
    def digests(self) -> dict[str, str]:
        """What tells this input from others: the digest of the scan, and of the truth where there is one.

        Returns
        -------
        dict of str to str
            "scan", "truth" -> SHA-256 in hex, made when first asked for.
        """
        volumes = {"scan": self.scan, "truth": self.truth}
        return {name: digest_volume(volume) for name, volume in volumes.items() if volume is not None}


def prepare(
    path: str | PathLike[str],
    *,
    mask: bool | None = None,
    label: int | None = None,
    threshold: float | None = None,
    opening: Collection[int] = (),
    planes: tuple[int, int] | None = None,
    truth: str | PathLike[str] | None = None,
    allow: Collection[str] = (),
    progress: Progress | None = None,
) -> Prepared:
    """Read a scan and find its openings: all that comes before a design.

    Parameters
    ----------
    path : path
        DICOM folder, NIfTI or NRRD file with a CT in HU or a bone mask.
    mask : bool, optional
        As for `read_ct`: True takes every nonzero voxel as bone. By default data of 0 and 1 are a mask.
    label : int, optional
        As for `read_ct`: the voxels of this value are bone.
    threshold : float, optional
        Lowest HU of bone; `segmentation.BONE_HU` when not given.
    opening : collection of int
        Numbers of the openings to close, as `cranio-nb inspect` lists them, doubtful and natural ones too; when empty,
        those that were cut for sure.
    planes : tuple of int, optional
        First and last plane (both included): only what lies between them is closed.
    truth : path, optional
        Mask of the missing bone on the scan's own grid.
    allow : collection of str
        Relaxations for `read_ct`.
    progress : callable, optional
        Called with (step, fraction of the whole run).

    Returns
    -------
    Prepared

    Raises
    ------
    InputRefused
        What cannot be read safely; ``NoSuchOpening``, ``OpeningLeavesImage``.
    NoOpening
        When there is nothing to close.

    Examples
    --------
    >>> import cranio_nb as cn
    >>> from cranio_nb.output.nifti_files import write_nifti
    >>> from data_synth import phantom_case
    >>> case = phantom_case("tiny", "burr_hole", 0)
    >>> write_nifti(cn.Volume(case.bone, case.affine), "skull.nii.gz")
    >>> prepared = cn.prepare("skull.nii.gz")
    >>> len(prepared.openings), prepared.threshold, prepared.truth
    (1, None, None)
    """
    report = progress or (lambda step, done: None)
    clock = Clock()
    report("reading", 0.0)
    scan, load = read_ct(
        path, mask=mask, label=label, allow=allow, progress=lambda i, n: report("reading", 0.3 * i / n)
    )
    known, said = (None, ()) if truth is None else read_truth(truth, scan)
    clock.lap("read")
    report("bone", 0.3)
    seen = survey_scan(scan, threshold)
    load = replace(load, findings=(*load.findings, *said, *seen.remarks))
    closed = openings_to_close(seen, opening, planes)
    numbers = {one.number for one in closed}
    left_open = tuple(one for one in seen.found if one.number not in numbers)
    clock.lap("bone and openings")
    bone = bone_around(seen.bone, scan, [one.opening for one in closed])
    return Prepared(load, scan, bone, closed, left_open, threshold_of(scan, threshold), known, clock.seconds)


def openings_to_close(
    seen: Survey, numbers: Collection[int] = (), planes: tuple[int, int] | None = None
) -> tuple[JudgedOpening, ...]:
    """The openings of a skull that a method gets.

    Parameters
    ----------
    seen : Survey
    numbers, planes
        As `opening` and `planes` of `prepare`.

    Returns
    -------
    tuple of JudgedOpening
        Largest first, none of them beside the border of the image.

    Raises
    ------
    InputRefused, NoOpening
        As `prepare`.
    """
    chosen = seen.choose(numbers)
    closed = chosen if planes is None else within_planes(chosen, planes)
    for one in closed:
        check_margin(one.opening.sheet, f"Opening {one.number}")
    return closed


def within_planes(openings: tuple[JudgedOpening, ...], planes: tuple[int, int]) -> tuple[JudgedOpening, ...]:
    """The parts of the openings that lie in a range of planes; openings elsewhere are left out.

    Parameters
    ----------
    openings : tuple of JudgedOpening
        At least one.
    planes : tuple of int
        First and last plane, both included.

    Returns
    -------
    tuple of JudgedOpening
        With their numbers.

    Raises
    ------
    InputRefused
        ``BadPlanes`` when the range is empty or outside the volume.
    NoOpening
        ``NoOpening`` when no opening meets it.
    """
    first, last = planes
    n_planes = openings[0].opening.sheet.shape[0]
    if not 0 <= first <= last < n_planes:
        raise InputRefused("BadPlanes", f"Planes {first} to {last} are not a range within 0 to {n_planes - 1}.")
    parts = []
    for one in openings:
        sheet = one.opening.sheet
        voxels = sheet.voxels.copy()
        voxels[:first] = voxels[last + 1 :] = False
        if voxels.any():
            parts.append(replace(one, opening=replace(one.opening, sheet=sheet.with_voxels(voxels))))
    if not parts:
        spans = ", ".join(f"{a} to {b - 1}" for a, b in (one.opening.planes for one in openings))
        message = f"No opening lies in planes {first} to {last}; openings were found in planes {spans}."
        raise NoOpening("NoOpening", message)
    return tuple(parts)


def check_margin(mask: Volume, what: str) -> None:
    """Refuse what touches the border of its grid: it may go on outside.

    Parameters
    ----------
    mask : Volume
        Bool mask.
    what : str
        Its name in the sentence.

    Raises
    ------
    InputRefused
        ``OpeningLeavesImage``.
    """
    if touches_border(mask):
        raise InputRefused(
            "OpeningLeavesImage",
            f"{what} reaches the edge of the image, where it would be cut off.",
            "Use a scan that covers the whole opening and a margin around it.",
        )


def touches_border(mask: Volume) -> bool:
    """Whether a mask reaches the first or the last plane, row or column of its grid.

    Parameters
    ----------
    mask : Volume
        Bool mask.

    Returns
    -------
    bool
    """
    return any(mask.voxels.take(end, axis).any() for axis in range(3) for end in (0, -1))


class Clock:
    """Seconds of each step.

    Parameters
    ----------
    before : dict, optional
        Steps measured earlier.
    """

    def __init__(self, before: dict[str, float] | None = None) -> None:
        self.seconds = dict(before or {})
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """End a step.

        Parameters
        ----------
        name : str
            Of the step.
        """
        now = time.perf_counter()
        self.seconds[name] = now - self._last
        self._last = now
