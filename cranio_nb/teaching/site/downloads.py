"""The project's folder -> archives that the site offers: all of the project, and the students' copies of the lessons.

A page opened from disk shows a notebook as text, but saves an archive.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

PROJECT = "cranio-nb.zip"
"""Name of the archive of the project."""
EXERCISES = "exercises.zip"
"""Name of the archive of the students' copies."""
_PARTS = (
    *("cranio_nb", "data_synth", "notebooks", "tests", "benchmarks", "docs", "binder"),
    *("README.md", "LICENSE", "CITATION.cff", "CHANGELOG.md", "CONTRIBUTING.md"),
    *("pyproject.toml", "setup.py", "MANIFEST.in", "constraints.txt", "environment.yml", "san.cfg"),
)
_DATE = (2011, 1, 1, 0, 0, 0)  # the same for all, so that the same project makes the same archive


def write_project(project: Path, path: Path) -> None:
    """Write the project without what lies in its folder besides: nobody's data, environments or results.

    Parameters
    ----------
    project : path
        The project's folder.
    path : path
        The archive, new.
    """
    files = (file for name in _PARTS for file in _below(project / name))
    _write(path, {f"cranio-nb/{file.relative_to(project).as_posix()}": file for file in files})


def write_exercises(project: Path, path: Path) -> None:
    """Write the students' copies, and the versions that go with them.

    Parameters
    ----------
    project : path
        The project's folder.
    path : path
        The archive, new.
    """
    files = (*sorted((project / "notebooks" / "exercises").glob("*.ipynb")), project / "constraints.txt")
    _write(path, {f"exercises/{file.name}": file for file in files if file.is_file()})


def _below(path: Path) -> Iterator[Path]:
    """A file, or the files in a folder, without hidden ones and what Python leaves behind."""
    if path.is_file():
        yield path
    for file in sorted(path.rglob("*")):
        parts = file.relative_to(path).parts
        if file.is_file() and not any(part.startswith(".") or part == "__pycache__" for part in parts):
            yield file


def _write(path: Path, files: dict[str, Path]) -> None:
    with ZipFile(path, "w") as archive:
        for name, file in files.items():
            info = ZipInfo(name, _DATE)
            info.compress_type, info.external_attr = ZIP_DEFLATED, 0o644 << 16
            archive.writestr(info, file.read_bytes())
