"""Two ways to bend a surface across a hole: the thin plate, and a sheet of D-NURBS that comes to rest."""

from .plate import bent_plate
from .sheet import elastic_sheet

__all__ = ["bent_plate", "elastic_sheet"]
