"""The folder of a study: its plan, and its rows in many small Parquet files, each whole or not there.

Only the client writes, one client at a time. A row counts as done from the moment its file has its name; whatever is
killed before that, the run is done again, and whatever is killed after that, it is not.
"""

from __future__ import annotations

import hashlib
import io
import json
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from numpy.typing import NDArray

from ..errors import CannotWrite, InputRefused
from ..output.files import write_json, write_whole
from ..output.part_folder import held_lock, sweep
from ..pipeline.compare import MEASURES
from .work import Row

SCHEMA = pa.schema(
    [
        *(
            (name, pa.string())
            for name in ("key", "case", "kind", "defect", "contender", "method", "options", "version")
        ),
        ("seed", pa.int64()),
        *((name, pa.float64()) for name in ("asked_mm", "threshold_hu", "length_mm")),
        ("place", pa.string()),
        ("n_openings", pa.int64()),
        *((name, pa.string()) for name in ("warnings", "status", "code", "message")),
        *((name, pa.float64()) for name in MEASURES),
        ("written_s", pa.float64()),
    ]
)
"""A row: what it is of, what the skull is like (lengths in mm), what its scan warns of (a JSON list), how it ended, the
`MEASURES` in their units, and when it was written (s since 1970)."""
Columns = dict[str, NDArray[Any]]
"""Rows as a column for each name: numbers as float64 with nan for none, text as objects with "" for none."""
PLAN, ROWS = "study.json", "rows"
_MANY = 500  # files, from which on they are made one


def is_study(folder: Path, name: str) -> bool:
    """Whether a file or folder is of a study, which may go on there.

    Parameters
    ----------
    folder : Path
    name : str
        `PLAN` or `ROWS`.

    Returns
    -------
    bool
    """
    path = folder / name
    if name == ROWS:
        return path.is_dir() and all(item.suffix == ".parquet" or item.name[0] == "." for item in path.iterdir())
    try:
        words = json.loads(path.read_bytes())
    except (OSError, ValueError):
        return False
    return isinstance(words, dict) and words.keys() >= {"folder", "cases", "methods"}


class Store:
    """The rows of a study.

    Parameters
    ----------
    folder : Path
        Made if missing.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.rows = Path(folder), Path(folder) / ROWS

    @contextmanager
    def opened(self, part: str = "") -> Iterator[None]:
        """Hold the folder, or a part of the study, for this process alone, and remove what killed ones left.

        Parameters
        ----------
        part : str
            Name of the part; several processes may work on different ones.

        Returns
        -------
        context manager

        Raises
        ------
        CannotWrite
            ``StudyRuns`` where another process holds it.
        """
        try:
            self.rows.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise CannotWrite("CannotWrite", f"The folder of the study cannot be made: {error.strerror}.") from error
        with held_lock(self.folder / f".lock{part}") as alone:
            if not alone:
                message = "Another process is working on this study."
                raise CannotWrite("StudyRuns", message, "Wait for its end, or name another folder.")
            sweep(self.rows)
            yield

    def add(self, rows: Sequence[Row]) -> None:
        """Write the rows of a batch as one file.

        Parameters
        ----------
        rows : sequence of dict
            As `SCHEMA`; what a row lacks is empty.

        Raises
        ------
        CannotWrite
            If the system refuses; then nothing of them is there.
        """
        now = time.time()
        self._write(pa.Table.from_pylist([row | {"written_s": now} for row in rows], SCHEMA))

    def done(self) -> set[str]:
        """Keys of all rows.

        Returns
        -------
        set of str
        """
        return set(self._table(["key"])["key"].to_pylist())

    def columns(self, keys: Sequence[str] | None = None) -> Columns:
        """All rows, each once, in the order of the keys.

        Parameters
        ----------
        keys : sequence of str, optional
            Those wanted, of which some may not be there yet; by default all, in no order.

        Returns
        -------
        Columns
        """
        table = self._table()
        place = {key: i for i, key in enumerate(table["key"].to_pylist())}
        taken = table.take(pa.array([place[k] for k in (place if keys is None else keys) if k in place], pa.int64()))
        return {name: _column(taken[name]) for name in SCHEMA.names}

    def tidy(self) -> None:
        """Make one file of many. A kill in between leaves rows twice, of which one is read."""
        files = self._files()
        if len(files) < _MANY:
            return
        whole = self._table()
        first = {key: i for i, key in reversed(list(enumerate(whole["key"].to_pylist())))}
        new = self._write(whole.take(pa.array(sorted(first.values()), pa.int64())))
        for path in files:
            if path != new:
                path.unlink(missing_ok=True)

    def keep_plan(self, words: dict[str, Any]) -> None:
        """Write what the plan says.

        Parameters
        ----------
        words : dict
            See `plan_file.read_plan`.
        """
        self.folder.mkdir(parents=True, exist_ok=True)
        write_json(self.folder / PLAN, words)

    def _write(self, table: pa.Table) -> Path:
        stream = io.BytesIO()
        pq.write_table(table, stream, compression="zstd")
        path = self.rows / f"{hashlib.sha256(json.dumps(table['key'].to_pylist()).encode()).hexdigest()[:24]}.parquet"
        # not `replace_file`, which looks at every file of the folder for each one that it writes
        write_whole(path, stream.getvalue())
        return path

    def _files(self) -> list[Path]:
        return sorted(self.rows.glob("[!.]*.parquet"))

    def _table(self, names: list[str] | None = None) -> pa.Table:
        """Columns of all files."""
        schema = SCHEMA if names is None else pa.schema([SCHEMA.field(name) for name in names])
        parts = [schema.empty_table()]
        for path in self._files():
            try:
                parts.append(pq.read_table(path, columns=schema.names).cast(schema))
            except FileNotFoundError:  # another part of the study has just made one file of many
                return self._table(names)
            except (pa.ArrowException, OSError, ValueError, KeyError) as error:
                message = f"{ROWS}/{path.name} holds no rows of a study."
                raise InputRefused("BadRows", message, "Remove it; its runs are done again.") from error
        return pa.concat_tables(parts)


def _column(column: pa.ChunkedArray) -> NDArray[Any]:
    """A column as an array."""
    if pa.types.is_string(column.type):
        return np.array(column.fill_null("").to_pylist(), object)
    return np.array(column.cast(pa.float64()).fill_null(np.nan).to_numpy(), float)
