"""What may be given for an option, declared once, beside its default.

A method declares its options where it takes them; all else reads that: the check, the help, the table in the docs, the
sliders of the panels and the ranges of a study (`methods.catalogue.options_of`)::

    def pieces(bone, openings, *, grow_px: Annotated[int, Option("How far the sheet grows.", 0, 20, "voxels")] = 2):
"""

from .option import THRESHOLD, Option
from .signature import declared
from .work import Work

__all__ = ["THRESHOLD", "Option", "Work", "declared"]
