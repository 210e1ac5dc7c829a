"""A function that may never end -> its answer, or the word that it took too long.

Signals reach the main thread only, and not on every system; so the function runs on a thread of its own, which is told
to stop when its time is over. That works in a notebook's kernel, on every system, and from any thread. Compiled code
that keeps the interpreter to itself, as ``sum(range(10**12))`` does, cannot be stopped so: only by hand.
"""

from __future__ import annotations

import ctypes
import threading
from collections.abc import Callable
from contextvars import copy_context
from typing import Any

_TRIES, _PATIENCE_S = 5, 0.1  # a thread is told to stop, and given time to


class TookTooLongError(BaseException):
    """A function did not end in time; no ordinary ``except`` of the function itself catches it."""


def call_within(limit_s: float, function: Callable[..., Any], *arguments: Any) -> Any:
    """Call a function, and stop it when its time is over.

    Parameters
    ----------
    limit_s : float
        Seconds.
    function : callable
        It sees the caller's context, such as numpy's settings for errors.
    *arguments

    Returns
    -------
    Any
        What the function returns.

    Raises
    ------
    TookTooLongError
    BaseException
        Whatever the function raises.

    Examples
    --------
    >>> call_within(10, pow, 2, 5)
    32
    """
    outcome: list[tuple[Any, BaseException | None]] = []
    context = copy_context()

    def run() -> None:
        try:
            try:
                outcome.append((context.run(function, *arguments), None))
            except BaseException as error:
                outcome.append((None, error))
        except TookTooLongError:  # told to stop just as it ended
            pass

    worker = threading.Thread(target=run, daemon=True)
    worker.start()
    try:
        worker.join(limit_s)
    finally:  # also where the user interrupts the waiting
        late = _stop(worker)
    if late or not outcome:
        raise TookTooLongError
    value, error = outcome[0]
    if error is not None:
        raise error
    return value


def _stop(worker: threading.Thread) -> bool:
    """Stop a thread if it still runs; whether it did.

    What does not stop is left alone: it ends with the program.
    """
    late = worker.is_alive()
    for _ in range(_TRIES if late else 0):
        ctypes.pythonapi.PyThreadState_SetAsyncExc(
            ctypes.c_ulong(worker.ident or 0), ctypes.py_object(TookTooLongError)
        )
        worker.join(_PATIENCE_S)
        if not worker.is_alive():
            break
    return late
