"""A batch of runs -> its rows: the case is read and segmented once, then each setting designs and is measured.

This is all that happens on a worker. It never raises for what a case or a method does: that is a row with its reason.
Memory: one case with its masks, and what one method needs; nothing is kept between batches.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import CranioError
from ..methods.transfer import unpack_methods
from ..opening import Opening
from ..pipeline.compare import Reference, measure
from ..pipeline.preparation import openings_to_close
from ..pipeline.survey import Survey, survey_scan
from ..pipeline.trial import Attempt, Contender, status_of
from ..readers import warnings_of
from ..vault.opening_choice import JudgedOpening
from ..vault.opening_size import measure_opening
from ..vault.remarks import opening_remarks
from .cases import Case, LoadedCase, load_case

Row = dict[str, Any]


@dataclass(frozen=True)
class Batch:
    """Runs that share a case and its threshold.

    Parameters
    ----------
    case : Case
    threshold_hu : float or None
    contenders : tuple of Contender
    keys, versions : tuple of str
        Of the run of each contender.
    """

    case: Case
    threshold_hu: float | None
    contenders: tuple[Contender, ...]
    keys: tuple[str, ...]
    versions: tuple[str, ...]

    def singly(self) -> list[Batch]:
        """The same runs, each for itself.

        Returns
        -------
        list of Batch
        """
        runs = zip(self.contenders, self.keys, self.versions, strict=True)
        return [Batch(self.case, self.threshold_hu, (c,), (k,), (v,)) for c, k, v in runs]


def do_batch(batch: Batch, methods: bytes, attempt: Attempt) -> list[Row]:
    """Do every run of a batch.

    Parameters
    ----------
    batch : Batch
    methods : bytes
        Own methods, from `pack_methods`.
    attempt : callable
        How a trial is run: `pipeline.trial.attempt`, or `attempt_apart` in a process of its own.

    Returns
    -------
    list of dict
        A row for each run, see `store.SCHEMA`.
    """
    unpack_methods(methods)
    try:
        made = load_case(batch.case)
        seen = survey_scan(made.scan, batch.threshold_hu)
        closed = openings_to_close(seen)
        openings, warned = tuple(one.opening for one in closed), _warnings(made, seen, closed)
        reference = None if made.truth is None else Reference.of(made.truth, seen.bone, openings[0])
    except Exception as error:
        return failed_rows(batch, **_reason(error))
    del made  # the methods get the bone only
    rows = _heads(batch)
    for row, contender in zip(rows, batch.contenders, strict=True):
        row |= _sizes(openings) | {"warnings": warned}
        try:
            trial = attempt(seen.bone, openings, contender)
            measures = measure(trial, seen.bone, reference)
            row |= {"status": trial.status, "code": trial.code, "message": trial.message} | measures
        except Exception as error:  # what cannot be measured is a row, too
            row |= _reason(error)
    return rows


def failed_rows(batch: Batch, *, status: str, code: str, message: str) -> list[Row]:
    """The rows of a batch of which nothing came.

    Parameters
    ----------
    batch : Batch
    status, code, message : str
        As of a `Trial`.

    Returns
    -------
    list of dict
    """
    return [row | {"status": status, "code": code, "message": message} for row in _heads(batch)]


def _heads(batch: Batch) -> list[Row]:
    """What each row is of."""
    asked = {"case": batch.case.name, "kind": batch.case.kind, "threshold_hu": batch.threshold_hu, **batch.case.facts}
    return [
        {
            "key": key,
            **asked,
            "contender": one.name,
            "method": one.method,
            "options": json.dumps(one.options, sort_keys=True),
            "version": version,
        }
        for one, key, version in zip(batch.contenders, batch.keys, batch.versions, strict=True)
    ]


def _sizes(openings: tuple[Opening, ...]) -> Row:
    """What the skull is like: place and length of the largest opening, and how many there are."""
    largest = measure_opening(openings[0])
    return {"place": largest.place, "length_mm": largest.length, "n_openings": len(openings)}


def _warnings(made: LoadedCase, seen: Survey, closed: Sequence[JudgedOpening]) -> str:
    """What a person has to check, as a JSON list of "Name: sentence"."""
    left_open = [one for one in seen.found if one not in closed]
    found = warnings_of((*made.warnings, *seen.remarks, *opening_remarks(closed, left_open)))
    return json.dumps([f"{one.code}: {one.message}" for one in found])


def _reason(error: Exception) -> dict[str, str]:
    """Why nothing came of a run. The words of an unforeseen error stay hidden: they may hold a path or a name."""
    if isinstance(error, CranioError):
        return {"status": status_of(error), "code": error.code, "message": str(error)}
    name = type(error).__name__
    return {"status": "broken", "code": name, "message": f"Something unforeseen went wrong ({name})."}
