"""Valid and faulty folders of DICOM files with known truth, made one at a time, to try any reader.

A valid folder is one that a reader must turn into exactly these HU at exactly these places. A faulty one holds a
fault that a reader must refuse, or recover from and say so; read without a word, it is silently wrong. The cases
follow the tables of what goes wrong in public archives: geometry, series, rescale, pixels, files.

World is DICOM LPS, mm; voxels are (plane, row, col).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from .fault_free import valid_recipes
from .fault_series import write_folder
from .faulty import faulty_recipes


@dataclass(frozen=True, eq=False)
class FaultCase:
    """One folder with its truth.

    Parameters
    ----------
    name : str
        What it is, in words.
    valid : bool
        Whether it must be read exactly; else it must be refused, or recovered with a message.
    hu : ndarray of int16, shape (P, R, C)
        What the scanner saw.
    affine : ndarray, shape (4, 4)
        Voxel (plane, row, col, 1) -> world mm (LPS).
    recovered : bool
        Whether a reader that recovers may give exactly `hu` on `affine`, and so is not wrong if it stays silent
        (an exact copy of a slice dropped, say).
    """

    name: str
    valid: bool
    hu: NDArray[np.int16]
    affine: NDArray[np.float64]
    recovered: bool = False


def fault_cases(folder: str | Path, *, valid: bool | None = None, every: int = 1) -> Iterator[tuple[FaultCase, Path]]:
    """Write the folders one after the other; each is there until the next is asked for.

    Parameters
    ----------
    folder : path
        Where to write; one subfolder at a time is made in it, and removed again.
    valid : bool, optional
        Only the valid ones, or only the faulty ones; by default all.
    every : int
        Only every so many of them.

    Yields
    ------
    case : FaultCase
    path : Path
        The folder of files.

    Examples
    --------
    >>> case, path = next(fault_cases("sets", valid=True))
    >>> case.name, case.hu.shape, len(list(path.iterdir()))
    ('plain', (20, 44, 48), 20)
    """
    recipes = [(name, True, recipe) for name, recipe in valid_recipes().items()]
    recipes += [(name, False, recipe) for name, recipe in faulty_recipes().items()]
    chosen = [entry for entry in recipes if valid is None or entry[1] == valid]
    for name, is_valid, recipe in chosen[::every]:
        path = Path(folder) / "case"
        hu, affine = write_folder(path, recipe)
        yield FaultCase(name, is_valid, hu, affine, recipe.recovered), path
        _remove(path)


def _remove(path: Path) -> None:
    """Remove one folder of a case, links not followed."""
    for entry in sorted(path.rglob("*"), reverse=True):
        if entry.is_dir() and not entry.is_symlink():
            entry.rmdir()
        else:
            entry.unlink()
    path.rmdir()
