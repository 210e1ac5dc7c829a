"""Text and JSON -> files, written whole or not at all.

Every file is made under another name in its folder, brought to disk, checked, and only then given its name. What
fails raises `CannotWrite` and leaves nothing behind.
"""

from __future__ import annotations

import dataclasses
import json
import math
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CannotWrite


def write_text(path: str | Path, text: str) -> None:
    """Write a text file in UTF-8.

    Parameters
    ----------
    path : str or Path
    text : str

    Raises
    ------
    CannotWrite
        If the system refuses.
    """
    write_whole(Path(path), text.encode())


def write_json(path: str | Path, data: Any) -> None:
    """Write data as strict JSON.

    Parameters
    ----------
    path : str or Path
    data : Any
        As for `jsonable`.

    Raises
    ------
    CannotWrite
        If the system refuses, or the data has no place in JSON.
    """
    write_text(path, json_text(data) + "\n")


def json_text(data: Any) -> str:
    """Data as the text of strict JSON.

    Parameters
    ----------
    data : Any
        As for `jsonable`.

    Returns
    -------
    str
        Indented by two; characters beyond ASCII as they are.

    Examples
    --------
    >>> print(json_text({"size": (2, 3)}))
    {
      "size": [
        2,
        3
      ]
    }
    """
    return json.dumps(jsonable(data), indent=2, ensure_ascii=False, allow_nan=False)


def jsonable(data: Any) -> Any:
    """The same data in the types of strict JSON.

    Parameters
    ----------
    data : Any
        Dataclasses, dicts, sequences, arrays, numbers and text, nested as they like.

    Returns
    -------
    dict, list, str, int, float, bool or None
        JSON knows no infinity: a number that is not finite becomes None.

    Raises
    ------
    CannotWrite
        BadFormat, for anything else.

    Examples
    --------
    >>> jsonable({"gap": np.float32(0.5), "sizes": np.arange(3), "ratio": np.inf})
    {'gap': 0.5, 'sizes': [0, 1, 2], 'ratio': None}
    """
    if dataclasses.is_dataclass(data) and not isinstance(data, type):
        return {field.name: jsonable(getattr(data, field.name)) for field in dataclasses.fields(data)}
    if isinstance(data, dict):
        return {str(key): jsonable(value) for key, value in data.items()}
    if isinstance(data, np.ndarray | np.generic):
        return jsonable(data.tolist())
    if isinstance(data, list | tuple):
        return [jsonable(value) for value in data]
    if isinstance(data, float) and not math.isfinite(data):
        return None
    if data is None or isinstance(data, bool | int | float | str):
        return data
    raise CannotWrite("BadFormat", f"A {type(data).__name__} has no place in JSON.")


def write_whole(path: Path, data: bytes, check: Callable[[Path], None] | None = None) -> None:
    """Write a file whole or not at all.

    Parameters
    ----------
    path : Path
        Replaced only when the new file is complete.
    data : bytes
    check : callable, optional
        Called with the path of the hidden file that was written; it raises what is wrong with it.

    Raises
    ------
    CannotWrite
        If the system refuses; nothing is left behind then.

    Examples
    --------
    >>> write_whole(Path("a.txt"), b"words")
    >>> Path("a.txt").read_text()
    'words'
    """
    # a hidden file beside the goal, brought to disk and checked, then renamed; removed if anything fails
    part = path.with_name(f".part-{os.getpid()}-{path.name}")
    try:
        with part.open("wb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        if check is not None:
            check(part)
        part.replace(path)
        _sync_folder(path.parent)
    except OSError as error:
        raise _cannot(path.name, error) from error
    finally:
        _remove(part)


def _sync_folder(folder: Path) -> None:
    """Bring the new name to disk, where the system can do that for folders."""
    if not hasattr(os, "O_DIRECTORY"):
        return
    handle = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def _remove(part: Path) -> None:
    """Remove the hidden file, where it is still there."""
    try:
        part.unlink(missing_ok=True)
    except OSError:
        return  # the folder itself is gone or not to be written: there is nothing of ours in it


def _cannot(what: str, error: OSError) -> CannotWrite:
    """The system's own words, without the path it adds to them."""
    return CannotWrite("CannotWrite", f"{what} could not be written: {error.strerror or type(error).__name__}.")
