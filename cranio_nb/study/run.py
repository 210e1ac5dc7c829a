"""A plan and workers -> rows: hands out what is not done yet, writes what comes back, survives what fails."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, Executor, Future, wait
from dataclasses import dataclass
from pathlib import Path

from ..errors import CranioError
from ..methods.transfer import pack_methods
from ..pipeline.trial import Attempt, attempt
from .plan import Plan
from .store import Columns, Store
from .version import version_of
from .work import Batch, Row, do_batch, failed_rows

FAILED = ("no patch", "broken")
"""Ends of a run that count as failures; "refused" is a method or a case that does not serve."""
_AHEAD = 200  # batches handed out at a time: enough for many workers, and little to keep in mind


@dataclass(frozen=True)
class Tally:
    """How far a study is.

    Parameters
    ----------
    total : int
        Runs of the plan.
    before : int
        Runs that were done before.
    done, failed : int
        Runs done now, and how many of them failed.
    seconds : float
        Since the start.
    """

    total: int
    before: int
    done: int = 0
    failed: int = 0
    seconds: float = 0.0

    @property
    def seconds_left(self) -> float:
        """Time that the rest takes at the pace so far.

        Returns
        -------
        float
            nan before the first run is done.
        """
        left = self.total - self.before - self.done
        return self.seconds / self.done * left if self.done else float("nan")


def run_study(
    plan: Plan,
    folder: str | Path,
    executor: Executor | None = None,
    *,
    part: tuple[int, int] = (1, 1),
    attempt: Attempt = attempt,
    progress: Callable[[Tally], None] | None = None,
) -> Tally:
    """Do what a study lacks.

    Parameters
    ----------
    plan : Plan
    folder : path
        Of the study; rows of other plans in it stay, and are taken where this plan asks for them.
    executor : concurrent.futures.Executor, optional
        Any; `cluster.dask_workers` gives one for Dask. By default a Dask cluster on this machine.
    part : tuple of int
        Which of how many shares of the cases to do, from 1 on: each may have a client of its own.
    attempt : callable
        How a design is run, see `pipeline.trial`: by default in the worker's own process, where "memory" is the most
        that this worker ever held.
    progress : callable, optional
        Called with a `Tally` at the start, and after each batch.

    Returns
    -------
    Tally

    Raises
    ------
    CannotWrite
        Where rows cannot be written, or another process works on this study.
    CranioError
        ``WorkersLost`` where the workers are gone or cannot work at all. All rows that came back are written: the
        same call goes on from there.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> from cranio_nb.study.cases import phantom_cases
    >>> from cranio_nb.study.plan import Plan, vary
    >>> cases = phantom_cases(["burr_hole"], [0], size="tiny")
    >>> plan = Plan(tuple(cases), tuple(vary("hull", {"axial": [False, True]})))
    >>> with ThreadPoolExecutor(1) as pool:
    ...     first, second = run_study(plan, "study", pool), run_study(plan, "study", pool)
    >>> (first.before, first.done), (second.before, second.done)
    ((0, 2), (2, 0))
    """
    if executor is None:
        from .cluster import dask_workers

        with dask_workers() as workers:
            return run_study(plan, folder, workers.executor, part=part, attempt=attempt, progress=progress)
    store = Store(Path(folder))
    with store.opened("" if part[1] == 1 else f"-{part[0]}-{part[1]}"):
        return _Handing(plan.part(*part), store, executor, attempt, progress or (lambda tally: None)).all()


def rows_of(plan: Plan, folder: str | Path) -> Columns:
    """The rows that a plan asks for, as far as they are there.

    Parameters
    ----------
    plan : Plan
    folder : path
        Of the study.

    Returns
    -------
    Columns
        In the order of the plan.
    """
    return Store(Path(folder)).columns(list(plan.keys(version_of)))


class _Handing:
    """One going through a plan: batches handed out and taken back."""

    def __init__(
        self, plan: Plan, store: Store, executor: Executor, attempt: Attempt, progress: Callable[[Tally], None]
    ) -> None:
        store.tidy()  # removes no file but those that it has read
        done = store.done()
        versions = {method: version_of(method) for method in {s.contender.method for s in plan.settings}}
        self.todo = deque(plan.batches(done, versions.__getitem__))
        left = sum(len(batch.keys) for batch in self.todo)
        self.tally, self.began = Tally(plan.n_runs, plan.n_runs - left), time.monotonic()
        self.out: dict[Future[list[Row]], Batch] = {}
        self.store, self.executor, self.progress = store, executor, progress
        self.given = pack_methods(), attempt

    def all(self) -> Tally:
        """Go through it."""
        self.progress(self.tally)
        try:
            while self.todo or self.out:
                self._hand_out()
                ended = wait(self.out, return_when=FIRST_COMPLETED).done
                for future in sorted(ended, key=_has_no_rows):  # rows first: what has none may be the end
                    self._take_back(future)
        finally:
            for future in self.out:
                future.cancel()
        self.store.tidy()
        return self.tally

    def _hand_out(self) -> None:
        while self.todo and len(self.out) < _AHEAD:
            try:
                future = self.executor.submit(do_batch, self.todo[0], *self.given)
            except Exception as error:
                raise _lost(error) from error
            self.out[future] = self.todo.popleft()

    def _take_back(self, future: Future[list[Row]]) -> None:
        """Write the rows of a batch; one that killed its workers is tried run by run, so that one run is to blame."""
        batch = self.out.pop(future)
        error = None if future.cancelled() else future.exception()
        if not _has_no_rows(future):
            rows = future.result()
        elif type(error).__name__ != _KILLED:
            raise _lost(error) from error
        elif len(batch.keys) > 1:
            self.todo.extendleft(reversed(batch.singly()))
            return
        else:
            message = "Every worker that was given this run ended before its time; they may have run out of memory."
            rows = failed_rows(batch, status="broken", code="WorkerEnded", message=message)
        self.store.add(rows)
        failed = sum(row["status"] in FAILED for row in rows)
        t = self.tally
        seconds = time.monotonic() - self.began
        self.tally = Tally(t.total, t.before, t.done + len(rows), t.failed + failed, seconds)
        self.progress(self.tally)


def _has_no_rows(future: Future[list[Row]]) -> bool:
    """Whether a batch that has ended brought nothing."""
    return future.cancelled() or future.exception() is not None


_KILLED = "KilledWorker"  # of Dask: workers died with this task again and again


def _lost(error: BaseException | None) -> CranioError:
    """A study that cannot go on for lack of workers."""
    name = f" ({type(error).__name__})" if error is not None else ""
    message = f"The workers were lost, or cannot do such work{name}. All rows that came back are written."
    return CranioError("WorkersLost", message, "Look after the workers, then run the same command: it goes on.")
