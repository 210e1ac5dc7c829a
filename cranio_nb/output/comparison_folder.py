"""A comparison -> its folder of files: one page, and the table as CSV and JSON."""

from __future__ import annotations

from pathlib import Path

from ..pipeline.compare import Comparison
from . import files
from .comparison_page import comparison_page
from .comparison_tables import comparison_csv, comparison_record

FILES = ("comparison.csv", "comparison.json", "comparison.html")
"""What a comparison leaves in its folder."""


def write_comparison(comparison: Comparison, folder: Path) -> None:
    """Write the `FILES` of a comparison.

    Parameters
    ----------
    comparison : Comparison
    folder : Path
        Must be there; usually the one from `staging.staged`.

    Raises
    ------
    CannotWrite
        If a file cannot be written.
    """
    files.write_text(folder / "comparison.csv", comparison_csv(comparison))
    files.write_json(folder / "comparison.json", comparison_record(comparison))
    files.write_text(folder / "comparison.html", comparison_page(comparison))
