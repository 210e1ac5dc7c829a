"""A study -> one self-contained HTML page.

It holds names of cases, which are paths below the folder of the plan, and no text of any input's headers.
"""

from __future__ import annotations

from collections.abc import Sequence
from importlib.metadata import version

import numpy as np

from ..output.pages import Shot, page_template
from ..pipeline.compare import MEASURES
from .best import target_of
from .failures import Reason, warned
from .parts import Part
from .store import Columns
from .summaries import counts

_BY_CLASS = ("dice", "hd95", "assd", "rim_gap")


def study_page(
    columns: Columns,
    parts: Sequence[Part],
    why: Sequence[Reason] = (),
    failures: Sequence[Shot] = (),
    *,
    missing: int | None = None,
) -> str:
    """The page of a study.

    Parameters
    ----------
    columns : Columns
        One row at least.
    parts : sequence of Part
        What is said of each contender.
    why : sequence of Reason
        Why runs failed.
    failures : sequence of Shot
        Pictures of skulls they failed on.
    missing : int, optional
        Runs of the plan that are not done yet, where the plan is known.

    Returns
    -------
    str
        HTML that needs no other file.
    """
    target = target_of(columns)
    known = [key for key in MEASURES if np.isfinite(columns[key]).any()]
    return page_template("study_page.html").render(
        version=version("cranio-nb"),
        n_rows=len(columns["key"]),
        n_cases=len(set(columns["case"])),
        counts=counts(columns),
        missing=missing,
        versions=sorted(set(columns["version"])),
        measures=MEASURES,
        keys=known,
        by_class=[key for key in _BY_CLASS if key in known],
        target=MEASURES[target],
        target_key=target,
        parts=parts,
        reasons=why,
        warned=warned(columns),
        failures=failures,
    )
