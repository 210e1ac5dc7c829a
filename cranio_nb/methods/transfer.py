"""Methods that were added by hand, packed for another process: functions go by value, wherever they were written."""

from __future__ import annotations

import os
import pickle
import sys
import uuid
from collections.abc import Iterator
from contextlib import contextmanager

from .catalogue import Method, added_methods, keep_method

_MADE = uuid.uuid4().hex  # a forked process shares it, but not the number of the process


def pack_methods() -> bytes:
    """The methods that `add_method` added in this process.

    Returns
    -------
    bytes
        For `unpack_methods`; empty where there are none.
    """
    methods = added_methods()
    if not methods:
        return b""
    import cloudpickle  # loaded only for own methods

    with _by_value(methods):
        return bytes(cloudpickle.dumps((_process(), methods)))


def unpack_methods(packed: bytes) -> None:
    """Add packed methods to the catalogue of this process; what was packed here is left as it is.

    Parameters
    ----------
    packed : bytes
        From `pack_methods`. A worker that lives long gets the newest form of each method.
    """
    sender, methods = pickle.loads(packed) if packed else (_process(), ())
    if sender != _process():
        for method in methods:
            keep_method(method)


def _process() -> tuple[str, int]:
    """What tells a process from those of all machines."""
    return _MADE, os.getpid()


@contextmanager
def _by_value(methods: tuple[Method, ...]) -> Iterator[None]:
    """While it lasts, what is defined in the modules of the methods is packed whole: the other process lacks them."""
    import cloudpickle

    names = {m.pieces.__module__ for m in methods} - set(cloudpickle.list_registry_pickle_by_value()) - {"__main__"}
    modules = [sys.modules[name] for name in names if name in sys.modules]
    for module in modules:
        cloudpickle.register_pickle_by_value(module)
    try:
        yield
    finally:
        for module in modules:
            cloudpickle.unregister_pickle_by_value(module)
