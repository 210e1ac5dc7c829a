"""What a method makes of one opening: the noun that methods and `methods.design` share."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class Piece:
    """The part of a prosthesis that closes one opening.

    Parameters
    ----------
    voxels : ndarray of bool, shape (P, R, C)
        The voxels of the piece on the bone's grid; none set where nothing could be bridged.
    working : tuple
        Intermediate results of the method, for pictures and lessons.
    record : dict
        JSON-able facts. Lists of dicts describe parts of this opening and are joined over the openings; anything else
        describes the whole design.

    Examples
    --------
    >>> import numpy as np
    >>> from cranio_nb.methods.piece import Piece
    >>> Piece(np.zeros((2, 3, 4), bool)).record
    {}
    """

    voxels: NDArray[np.bool_]
    working: tuple[Any, ...] = ()
    record: dict[str, Any] = field(default_factory=dict)
