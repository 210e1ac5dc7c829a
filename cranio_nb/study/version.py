"""What tells the rows of one state of the source from those of another: a study that goes on does not mix them."""

from __future__ import annotations

import hashlib
import inspect
import marshal
import subprocess
import sys
from functools import cache
from importlib.metadata import version
from pathlib import Path

from ..methods.catalogue import Pieces, find_method

_CODE = """
import importlib, sys
for name in sys.argv[1:]: importlib.import_module(name)
print(*sorted(m.__file__ for n, m in sys.modules.items()
              if n.split(".")[0] in ("cranio_nb", "data_synth") and getattr(m, "__file__", None)), sep="\\n")
"""
_MEASURING = ("cranio_nb.methods.design", "cranio_nb.study.work", "data_synth")


def version_of(method: str) -> str:
    """The release, and a digest of the source that makes, designs and measures.

    Parameters
    ----------
    method : str
        A name of the catalogue. Of a method from elsewhere its own function is looked at, not what it calls.

    Returns
    -------
    str
        ``release+digest``.

    Raises
    ------
    InputRefused
        ``UnknownMethod``.
    """
    pieces = find_method(method).pieces
    ours = (pieces.__module__,) if pieces.__module__.startswith("cranio_nb.") else ()
    digest = hashlib.sha256(_source(pieces) + _loaded(ours))
    return f"{version('cranio-nb')}+{digest.hexdigest()[:8]}"


def _source(function: Pieces) -> bytes:
    """The text of a function, or what was made of it where there is no text."""
    try:
        return inspect.getsource(function).encode()
    except (OSError, TypeError):
        return marshal.dumps(getattr(function, "__code__", None))


@cache
def _loaded(modules: tuple[str, ...]) -> bytes:
    """A digest of the files that these modules load; in a process of its own, where nothing else is loaded."""
    asked = [sys.executable, "-c", _CODE, *_MEASURING, *modules]
    files = subprocess.run(asked, capture_output=True, text=True, check=True).stdout.split("\n")
    return hashlib.sha256(b"".join(Path(path).read_bytes() for path in files if path)).digest()
