"""Dask workers: a cluster on this machine, or one that is there already, by its address."""

from __future__ import annotations

import os
from collections.abc import Iterator
from concurrent.futures import Executor
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass

from distributed import Client, LocalCluster

from ..errors import InputRefused

_WAIT_S = 20  # for a scheduler to answer


@dataclass(frozen=True)
class Workers:
    """Workers that wait for batches.

    Parameters
    ----------
    executor : Executor
        Hands work to them.
    dashboard : str
        Address of the page that shows what they do.
    """

    executor: Executor
    dashboard: str


@contextmanager
def dask_workers(
    scheduler: str | None = None,
    *,
    n_workers: int | None = None,
    memory_gb: float | None = None,
    processes: bool = True,
) -> Iterator[Workers]:
    """Start workers on this machine, or join those of a scheduler.

    Parameters
    ----------
    scheduler : str, optional
        Address of a scheduler, e.g. ``tcp://127.0.0.1:8786``; its workers need this package, and the scans at the same
        paths.
    n_workers : int, optional
        Of a cluster on this machine, each with one thread; by default as many as it has processors.
    memory_gb : float, optional
        A worker of this machine that holds more is ended and started again; by default its share of all memory.
    processes : bool
        Whether each worker of this machine is a process of its own.

    Returns
    -------
    context manager of Workers
        At its end what it started is stopped, and what it joined is left.

    Raises
    ------
    InputRefused
        ``NoScheduler``.
    """
    with ExitStack() as stack:
        if scheduler is None:
            limit = "auto" if memory_gb is None else int(memory_gb * 1e9)
            cluster = LocalCluster(
                n_workers=n_workers or os.cpu_count() or 1,
                threads_per_worker=1,
                processes=processes,
                memory_limit=limit,
                dashboard_address="127.0.0.1:0",  # seen from this machine only
                worker_dashboard_address="127.0.0.1:0",
            )
            client = stack.enter_context(Client(stack.enter_context(cluster)))
        else:
            client = stack.enter_context(_joined(scheduler))
        yield Workers(client.get_executor(), client.dashboard_link)


def _joined(scheduler: str) -> Client:
    """A client of a scheduler that is there."""
    try:
        return Client(scheduler, timeout=_WAIT_S)
    except (OSError, ValueError) as error:
        message = f"No Dask scheduler answers at the address given ({type(error).__name__})."
        raise InputRefused(
            "NoScheduler", message, "Give it as tcp://HOST:PORT, as `dask scheduler` prints it."
        ) from error
