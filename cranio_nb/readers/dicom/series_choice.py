"""Images of a folder -> the slices of the one head CT in it, and why the others were left.

`series_groups` says which images may be slices of a CT and which of them belong together; here one group is chosen.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from ...errors import InputRefused
from ..load_report import Finding
from .continuation import agree, check_continued
from .geometry import MAX_STEP_MM, MIN_SLICES, axes_of, bad_geometry, check_geometry, sort_by_height
from .kernel import describe_kernel, is_sharp
from .parse import CT_CLASSES
from .series_groups import CT_MODALITIES, group_alike, join_single_slices, nothing_usable, split_usable
from .slice_header import SliceHeader

_STRAY = 3  # so few images are a scout or a reference picture, not a scan
_HEAD_HEIGHT_MM = 150.0  # mm: a taller scan has no advantage over another
_MAX_SERIES_NUMBER = 99_999  # a longer one may be anything, a birth date among others
_FOLDER_REMEDY = "Give the folder that holds only the wanted series."


@dataclass(frozen=True, eq=False)
class Candidate:
    """A group of images that could be the scan, with what the choice depends on.

    Parameters
    ----------
    headers : list of SliceHeader
    step : float
        mm between slices, the median.
    extent : float
        mm from the bottom of the lowest slice to the top of the highest.
    axial : bool
        Whether the slices lie across the long axis of the body.
    original : bool
        Whether the scanner made them, not a program afterwards.
    """

    headers: list[SliceHeader]
    step: float
    extent: float
    axial: bool
    original: bool

    @property
    def label(self) -> str:
        """How it is called in messages: numbers and fixed words only, whatever the header says."""
        first = self.headers[0]
        kind = describe_kernel(first.kernel)
        kernel = "" if kind == "unknown" else f", {kind} kernel"
        number = "" if self.number is None else f"series {self.number}: "
        return f"{number}{len(self.headers)} slices of {first.rows} x {first.cols}, {self.step:.2f} mm apart{kernel}"

    @property
    def number(self) -> int | None:
        """The series number.

        Returns
        -------
        int or None
            None where there is none, or where it is longer than such numbers are.
        """
        number = self.headers[0].series_number
        return number if number is not None and 0 <= number <= _MAX_SERIES_NUMBER else None


def choose_series(headers: list[SliceHeader], allow: Collection[str] = ()) -> tuple[list[SliceHeader], list[Finding]]:
    """Choose the slices of the scan to read.

    Parameters
    ----------
    headers : list of SliceHeader
        All images of the folder.
    allow : collection of str
        ``"wrong_modality"`` takes images that are not CT.

    Returns
    -------
    headers : list of SliceHeader
        Of one series, in file order, with geometry.
    findings : list of Finding
        What was chosen and what was left.

    Raises
    ------
    InputRefused
        ``NoImages``, ``WrongModality``, ``BadGeometry``, ``AmbiguousSeries``, ``MixedPatients``,
        ``MixedFrameOfReference``.

    Examples
    --------
    Two reconstructions of one study, of which the thinner is chosen:

    >>> from dataclasses import replace
    >>> from data_synth import write_dicom
    >>> from .parse import parse_file
    >>> from .slice_header import read_headers
    >>> hu, affine = np.zeros((20, 4, 4), np.int16), np.eye(4)[[2, 1, 0, 3]]
    >>> files = write_dicom("thin", hu, affine) + write_dicom("thick", hu[::2], affine * [2, 1, 1, 1])
    >>> headers = [header for i, file in enumerate(files) for header in read_headers(*parse_file(file, i), i)]
    >>> chosen, findings = choose_series([replace(header, study="1") for header in headers])
    >>> len(chosen), [finding.code for finding in findings]
    (20, ['SeriesChosen', 'SeriesSkipped'])
    """
    # CT images, in groups that belong together
    usable, left, others = split_usable(headers, "wrong_modality" in allow)
    if not usable:
        raise nothing_usable(headers, left)
    usable, joined = join_single_slices(usable)
    groups = group_alike(usable)
    placed = [group for group in groups if group[0].orientation is not None and group[0].spacing is not None]
    if not placed:
        check_geometry(usable)

    # the best group that is large enough to be a scan
    scans = [group for group in placed if len(group) > _STRAY] or placed
    candidates = [_candidate(group) for group in scans]
    chosen = _best(candidates)

    # of one patient, and whole
    _check_one_person(chosen.headers, "series")
    apart = [g for g in groups if g is not chosen.headers]
    _check_rest_of_series(chosen, apart)
    check_continued(chosen.headers, chosen.step, [header for group in apart for header in group] + others)
    rest = [candidate for candidate in candidates if candidate is not chosen]
    strays = [group for group in placed if not any(group is scan for scan in scans)]
    return chosen.headers, joined + _report(chosen, rest, strays, left, others)


def _candidate(group: list[SliceHeader]) -> Candidate:
    """What the choice depends on; a group without sound geometry is judged by its number of slices alone."""
    first = group[0]
    original = bool(first.image_type) and first.image_type[0] == "ORIGINAL"
    try:
        check_geometry(group)
        *_, normal = axes_of(np.asarray(first.orientation))
        heights = sort_by_height(group)[1]
    except InputRefused:
        return Candidate(group, 1.0, float(len(group)), True, original)
    # copies at one height do not count
    gaps = np.diff(heights)
    step = float(np.median(gaps[gaps > 1e-3])) if (gaps > 1e-3).any() else 0.0
    return Candidate(group, step, float(heights[-1]) + step, bool(abs(normal[2]) > 0.8), original)


def _best(candidates: list[Candidate]) -> Candidate:
    """The thinnest axial original scan among those that cover a head; a tie is refused."""
    # tall enough for a head, then axial, original, thin, and with most slices
    enough = [c for c in candidates if len(c.headers) >= MIN_SLICES] or candidates
    tall = min(max(c.extent for c in enough), _HEAD_HEIGHT_MM)
    pool = [c for c in enough if c.extent >= 0.7 * tall]
    pool.sort(key=lambda c: (not c.axial, not c.original, round(c.step, 2), -len(c.headers)))
    best = pool[0]

    # others of the same direction must be of the same person and study
    rivals = [c for c in pool[1:] if c.axial == best.axial and c.step <= MAX_STEP_MM + 0.1]
    if rivals:
        _check_one_person([c.headers[0] for c in (best, *rivals)], "folder")
    if any(c.headers[0].study != best.headers[0].study for c in rivals):
        raise ambiguous([best, *rivals], "studies")

    # among equals the smooth kernel is meant: sharp ones raise the noise
    ties = [best, *(c for c in rivals if c.original == best.original and abs(c.step - best.step) < 0.05 * best.step)]
    if len(ties) == 1:
        return best
    smooth = [c for c in ties if not is_sharp(c.headers[0].kernel)]
    if len(smooth) != 1 or not all(c.headers[0].kernel for c in ties):
        raise ambiguous(ties, "series")
    return smooth[0]


def ambiguous(candidates: list[Candidate], what: str) -> InputRefused:
    """The refusal where more than one scan could be meant.

    Parameters
    ----------
    candidates : list of Candidate
    what : str
        "series" or "studies".

    Returns
    -------
    InputRefused
    """
    listed = "; ".join(c.label for c in candidates[:4])
    return InputRefused("AmbiguousSeries", f"The folder holds several head CT {what} ({listed}).", _FOLDER_REMEDY)


def _check_one_person(headers: list[SliceHeader], where: str) -> None:
    """Refuse images of more than one patient, and a series with more than one frame of reference."""
    for part in range(3):
        if len({h.person[part] for h in headers} - {""}) > 1:
            message = f"The {where} holds images of more than one patient."
            raise InputRefused("MixedPatients", message, "Sort the images by patient first.")
    if where == "series" and len({h.frame_of_reference for h in headers} - {""}) > 1:
        message = "The series holds images of more than one frame of reference: their positions cannot be compared."
        raise InputRefused("MixedFrameOfReference", message, _FOLDER_REMEDY)


def _check_rest_of_series(chosen: Candidate, others: list[list[SliceHeader]]) -> None:
    """Images of the same series that were grouped apart must not be a part of the same head."""
    first = chosen.headers[0]
    for group in others:
        if group[0].series != first.series or group[0].image_type[:1] != first.image_type[:1]:
            continue
        # a part without geometry cannot be told from the rest
        if group[0].orientation is None or group[0].spacing is None:
            check_geometry(group)
        if not agree(group[0].orientation, first.orientation):
            continue
        check_geometry(group)
        if len(group) > _STRAY:
            raise bad_geometry(f"{len(group)} slices of the series differ from the others in size or pixel spacing.")


def _report(
    chosen: Candidate,
    rest: list[Candidate],
    strays: list[list[SliceHeader]],
    left: Counter[str],
    others: list[SliceHeader],
) -> list[Finding]:
    """What was chosen, and what was left and why."""
    first = chosen.headers[0]
    values = {"slices": len(chosen.headers), "step_mm": round(chosen.step, 4), "series": chosen.number}
    findings = [Finding("SeriesChosen", "info", f"Read {chosen.label}.", values)]
    findings += [Finding("SeriesSkipped", "info", f"Left {c.label}.", {"slices": len(c.headers)}) for c in rest[:20]]
    if len(rest) > 20:
        findings.append(Finding("SeriesSkipped", "info", f"Left {len(rest) - 20} more series.", {}))
    for same in (True, False):
        count = sum(len(group) for group in strays if (group[0].series == first.series) == same)
        if count:
            message = f"Left {count} image{'s' * (count > 1)} that fit no stack."
            findings.append(Finding("ImagesSkipped", "warning" if same else "info", message, {"images": count}))
    if first.modality not in CT_MODALITIES or first.sop_class not in CT_CLASSES:
        findings.append(Finding("WrongModality", "warning", "The images are not CT; they were read as allowed.", {}))
    if left:
        listed = ", ".join(f"{reason}: {count}" for reason, count in sorted(left.items()))
        severity = "warning" if any(header.series == first.series for header in others) else "info"
        findings.append(
            Finding("ImagesSkipped", severity, f"Left images that are no CT slices ({listed}).", dict(left))
        )
    return findings
