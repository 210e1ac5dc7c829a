"""The folder of a study -> its report: the page, the rows as CSV, and the best options of each method."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pyarrow as pa
from pyarrow import csv

from ..errors import CranioError, InputRefused
from ..output.files import write_json, write_text, write_whole
from .best import Best, target_of
from .cases import Case
from .failures import failure_shots, reasons
from .page import study_page
from .parts import Part, by_contender, contender_part
from .plan_file import cases_of, plan_of
from .store import PLAN, SCHEMA, Columns, Store
from .version import version_of

PAGE, ROWS_CSV = "study.html", "rows.csv"


@dataclass(frozen=True, eq=False)
class Study:
    """What a folder holds of a study.

    Parameters
    ----------
    columns : Columns
        The newest row of each run.
    cases : tuple of Case
        Of its plan, as far as it can be read.
    missing : int or None
        Runs of the plan that are not done; None where its methods are not known here.
    parts : tuple of Part
        What is said of each contender.
    """

    columns: Columns
    cases: tuple[Case, ...]
    missing: int | None
    parts: tuple[Part, ...]

    @property
    def best(self) -> tuple[Best, ...]:
        """The best setting of each contender that has one.

        Returns
        -------
        tuple of Best
        """
        return tuple(part.best for part in self.parts if part.best is not None)


def read_study(folder: Path) -> Study:
    """Read the rows of a study; another process may still add some.

    Parameters
    ----------
    folder : Path

    Returns
    -------
    Study

    Raises
    ------
    InputRefused
        ``NoRows`` where there are none.
    """
    columns = newest(Store(folder).columns())
    if not len(columns["key"]):
        raise InputRefused("NoRows", "There are no rows of a study in this folder.", "Run `cranio-nb study run` first.")
    target = target_of(columns)
    parts = tuple(contender_part(own, target) for own in by_contender(columns))
    return Study(columns, *_planned(folder, columns), parts)


def newest(columns: Columns) -> Columns:
    """Of the rows of one case and setting the one that was written last: older ones are of another state of the source.

    Parameters
    ----------
    columns : Columns

    Returns
    -------
    Columns
    """
    order = np.argsort(columns["written_s"], kind="stable")
    said = zip(*(columns[name][order] for name in ("case", "contender", "options", "threshold_hu")), strict=True)
    last = {(case, one, options, f"{height}"): i for (case, one, options, height), i in zip(said, order, strict=True)}
    chosen = np.sort(np.array(list(last.values()), np.intp))
    return {name: column[chosen] for name, column in columns.items()}


def files_of(study: Study) -> tuple[str, ...]:
    """Names of the files of a report.

    Parameters
    ----------
    study : Study

    Returns
    -------
    tuple of str
    """
    return (PAGE, ROWS_CSV, *(best.file for best in study.best))


def write_report(study: Study, folder: Path) -> None:
    """Write the report.

    Parameters
    ----------
    study : Study
    folder : Path
        Must be there; usually the one from `staging.staged`.

    Raises
    ------
    CannotWrite
        If a file cannot be written.
    """
    why = reasons(study.columns)
    page = study_page(study.columns, study.parts, why, failure_shots(why, study.cases), missing=study.missing)
    write_text(folder / PAGE, page)
    table = pa.table({name: pa.array(study.columns[name], from_pandas=True) for name in SCHEMA.names})
    stream = pa.BufferOutputStream()
    csv.write_csv(table, stream)
    write_whole(folder / ROWS_CSV, stream.getvalue().to_pybytes())
    for best in study.best:
        write_json(folder / best.file, best.options)


def _planned(folder: Path, columns: Columns) -> tuple[tuple[Case, ...], int | None]:
    """The cases of the plan, and how many of its runs are not there; nothing where the plan or a method is gone."""
    try:
        words = json.loads((folder / PLAN).read_bytes())
        cases = tuple(cases_of(words))
    except (OSError, ValueError):
        return (), None
    try:
        wanted = plan_of(words).keys(version_of)
    except CranioError:
        return cases, None
    return cases, len(wanted.keys() - set(columns["key"]))
