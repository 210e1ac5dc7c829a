"""A comparison -> its tables: as they are shown, as CSV, and all of it as JSON.

Nothing here holds text of the input's headers, nor a path.
"""

from __future__ import annotations

import csv
import io
from importlib.metadata import version
from typing import Any

import numpy as np

from ..pipeline.compare import MEASURES, Comparison, records
from .design_folder import load_record, versions


def tables(comparison: Comparison) -> list[dict[str, Any]]:
    """The tables that are shown: accuracy (where a truth is known), and the implants with their cost.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    list of dict
        For each table its "title", the "keys" of its columns in `MEASURES`, and under "best" the best value of each
        column: the one nearest to the end that is better, where contenders differ as printed; else None.
    """
    # with a truth the measures against it come first
    parts = {"The implants, and what they cost": [k for k, m in MEASURES.items() if not m.needs_truth]}
    if comparison.case.truth is not None:
        parts = {"Against the truth": [k for k, m in MEASURES.items() if m.needs_truth]} | parts
    return [
        {"title": title, "keys": keys, "best": {key: _best(comparison, key) for key in keys}}
        for title, keys in parts.items()
    ]


def _best(comparison: Comparison, key: str) -> float | None:
    """The best value of a column as it is printed; None where no end is better or all are alike."""
    what = MEASURES[key]
    # rounded as printed: what looks alike is no better
    shown = {round(float(row[key]), what.digits) for row in comparison.rows if np.isfinite(row[key])}
    if not what.best or len(shown) < 2:
        return None
    return max(shown) if what.best == "high" else min(shown)


def comparison_csv(comparison: Comparison) -> str:
    """The table as CSV.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    str
        A head, and a line for each contender; an empty cell where there is no value.
    """
    rows = [{k: v for k, v in row.items() if k != "parameters"} for row in records(comparison)]
    text = io.StringIO()
    writer = csv.DictWriter(text, list(rows[0]), lineterminator="\n")
    writer.writeheader()
    writer.writerows(rows)
    return text.getvalue()


def comparison_record(comparison: Comparison) -> dict[str, Any]:
    """What `comparison.json` says.

    Parameters
    ----------
    comparison : Comparison

    Returns
    -------
    dict
        JSON-able after `files.jsonable`.
    """
    return {
        "cranio_nb": version("cranio-nb"),
        "not_for_clinical_use": True,
        "load": load_record(comparison.case.load),
        "bone_threshold_hu": comparison.case.threshold,
        "openings": [one.record() for one in comparison.case.closed],
        "left_open": [one.record() for one in comparison.case.left_open],
        "findings": comparison.case.remarks,
        "units": {key: what.unit for key, what in MEASURES.items()},
        "reference": comparison.reference,
        "methods": records(comparison),
        "pairs": [{"methods": pair, "dice": d, "assd": a} for pair, (d, a) in comparison.pairs.items()],
        "colour_scale_mm": [0.0, comparison.top],
        "versions": versions(),
    }
