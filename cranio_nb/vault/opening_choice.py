"""Judged openings of a skull -> those that are closed: the ones that were cut for sure, or those chosen by number.

Numbers count from 1, largest opening first, and are the same wherever openings are listed.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

from ..errors import InputRefused, NoOpening
from ..opening import Opening
from ..readers import Finding
from .opening_size import OpeningSize, measure_opening
from .smallest_hole import LEAST_MM
from .verdict import Verdict

_BULGE_MM = 2.0  # by which missing bone may stand out of the surface that the bone around it lets expect


@dataclass(frozen=True, eq=False)
class JudgedOpening:
    """An opening with the verdict on it.

    Parameters
    ----------
    number : int
        From 1, largest first among all openings that were found in the skull.
    opening : Opening
    verdict : Verdict
    room_mm : float
        How far the bone that is missing would stay from the edge of the image, mm; below 0: it reaches beyond.
    """

    number: int
    opening: Opening
    verdict: Verdict
    room_mm: float

    @property
    def whole(self) -> bool:
        """Whether all of the bone that is missing would lie inside the image.

        Returns
        -------
        bool
        """
        return self.room_mm >= 0

    @property
    def edge(self) -> str:
        """What to know of the edge of the image.

        Returns
        -------
        str
            A sentence; empty where the edge is far.
        """
        if not self.whole:
            return "It reaches the edge of the image."
        if self.room_mm < _BULGE_MM:
            return f"It ends {self.room_mm:.1f} mm from the edge of the image: bone that bulges there would be cut off."
        return ""

    @cached_property
    def size(self) -> OpeningSize:
        """Place and size.

        Returns
        -------
        OpeningSize
        """
        return measure_opening(self.opening)

    def __str__(self) -> str:
        """One line: number, place, size, verdict, confidence and reason."""
        size, verdict = self.size, self.verdict
        edge = f" {self.edge}" if self.edge else ""
        return (
            f"opening {self.number} ({size.place}, {size.length:.0f} x {size.width:.0f} mm,"
            f" planes {size.planes[0]} to {size.planes[1]}): {verdict.kind}, confidence {verdict.confidence:.2f}."
            f" {verdict.reason}{edge}"
        )

    def record(self) -> dict[str, Any]:
        """What files say of it.

        Returns
        -------
        dict
            JSON-able: number, kind, confidence, reason, whole, and the fields of `OpeningSize`.
        """
        verdict = self.verdict
        head = {"number": self.number, "kind": verdict.kind, "confidence": verdict.confidence}
        return head | {"reason": verdict.reason, "whole": self.whole} | asdict(self.size)


def cut_openings(found: Sequence[JudgedOpening]) -> tuple[JudgedOpening, ...]:
    """The openings that were cut for sure. A skull without any is intact: nothing else decides that.

    Parameters
    ----------
    found : sequence of JudgedOpening
        All openings of a skull.

    Returns
    -------
    tuple of JudgedOpening
        In the same order.
    """
    return tuple(one for one in found if one.verdict.kind == "cut")


def check_intact(found: Sequence[JudgedOpening], remedy: str) -> None:
    """Refuse a skull that is not intact.

    Parameters
    ----------
    found : sequence of JudgedOpening
        All its openings.
    remedy : str
        What is wanted instead.

    Raises
    ------
    InputRefused
        ``NotIntact``, with a list of the openings.
    """
    cut = cut_openings(found)
    if cut:
        raise InputRefused("NotIntact", f"The skull is not intact.{_listed(cut)}", remedy)


def choose_openings(
    found: Sequence[JudgedOpening],
    numbers: Collection[int] = (),
    *,
    smallest_mm: float = LEAST_MM,
    said: Sequence[Finding] = (),
) -> tuple[JudgedOpening, ...]:
    """The openings to close.

    Parameters
    ----------
    found : sequence of JudgedOpening
        All openings of a skull.
    numbers : collection of int
        Those to close, of whatever kind; when empty, those that were cut for sure.
    smallest_mm : float
        Width of the smallest hole that the scan can show.
    said : sequence of Finding
        What to know of the scan; its warnings stand beside the answer that there is no opening.

    Returns
    -------
    tuple of JudgedOpening
        At least one, in the same order.

    Raises
    ------
    NoOpening
        ``NoOpening`` when none was chosen and none was cut for sure; the message lists those in doubt, and says down to
        which width the scan shows holes.
    InputRefused
        ``NoSuchOpening`` for a number that there is not, with a list of all openings; ``OpeningLeavesImage`` when one
        of those to close reaches the edge of the image.
    """
    strange = sorted(set(numbers) - {one.number for one in found})
    if strange:
        there = _listed(found) if found else " The skull has no opening."
        message = f"There is no opening {', '.join(map(str, strange))}.{there}"
        raise InputRefused("NoSuchOpening", message, "Give a number of this list." if found else "")
    chosen = tuple(one for one in found if one.number in numbers) if numbers else cut_openings(found)
    if not chosen:
        _refuse_intact(found, smallest_mm, "".join(f" {one.message}" for one in said if one.severity == "warning"))
    beyond = [one for one in chosen if not one.whole]
    if beyond:
        raise InputRefused(
            "OpeningLeavesImage",
            f"A part of the missing bone lies outside the image, or may lie there.{_listed(beyond)}",
            "Use a scan that covers the whole opening and a margin around it.",
        )
    return chosen


def _refuse_intact(found: Sequence[JudgedOpening], smallest_mm: float, warnings: str) -> None:
    """Say that nothing is closed without being chosen, what is in doubt, and what the scan cannot show."""
    doubtful = [one for one in found if one.verdict.kind == "doubtful"]
    limit = f"The smallest hole that this scan can show for sure is {smallest_mm:.0f} mm wide.{warnings}"
    if not doubtful:
        message = "The vault of this skull has no opening; there is nothing to close."
        raise NoOpening("NoOpening", f"{message} {limit}")
    message = f"The vault of this skull has no opening that was cut for sure, but a doubtful one.{_listed(doubtful)}"
    remedy = f"To close it, choose it by its number: --opening {doubtful[0].number}."
    raise NoOpening("NoOpening", f"{message} {limit}", remedy)


def _listed(openings: Sequence[JudgedOpening]) -> str:
    """The openings one after the other, after a sentence."""
    return "".join(f" {str(one)[0].upper()}{str(one)[1:]}" for one in openings)
