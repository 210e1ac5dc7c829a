"""Work on parts of arrays -> the same on two processors at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Part = TypeVar("Part")
_N_THREADS = 2  # as many processors as any computer of today has


def side_by_side(work: Callable[[Part], None], parts: Iterable[Part]) -> None:
    """Do the same with each part, two at a time.

    Numpy and scipy leave the processor to other threads while they compute. Each part writes to places of its own, so
    that nothing hangs on their order.

    Parameters
    ----------
    work : callable
        Called once with each part; what it raises is raised here.
    parts : iterable
        Large enough that a part takes longer than to hand it over, about 50 microseconds.

    Examples
    --------
    >>> import numpy as np
    >>> squares = np.zeros(4)
    >>> def square(k):
    ...     squares[k] = k * k
    >>> side_by_side(square, range(4))
    >>> squares.tolist()
    [0.0, 1.0, 4.0, 9.0]
    """
    with ThreadPoolExecutor(_N_THREADS) as threads:
        for _ in threads.map(work, parts):
            pass
