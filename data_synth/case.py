"""One synthetic or cut case: the scan or mask with its defect, and the exact truth beside it.

Frames: voxel (plane, row, col); world mm, DICOM LPS.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .head import HeadShape
from .truth import SliceTruth, gaps_in_slice

if TYPE_CHECKING:
    from .face.landmarks import Landmarks


@dataclass(frozen=True, eq=False)
class Case:
    """A skull with a defect, and the bone that is missing.

    Parameters
    ----------
    hu : ndarray of int16, shape (P, R, C), or None
        CT with the defect; None where the case was cut from a binary mask.
    affine : ndarray, shape (4, 4)
        Voxel (plane, row, col, 1) -> world mm, LPS.
    bone : ndarray of bool, shape (P, R, C)
        The defective skull. Phantom: voxel centre inside the closed-form bone and outside every cutter.
        Cut CT: HU at or above the threshold before the cut, minus the implant. Cut mask: the mask minus the implant.
    implant : ndarray of bool, shape (P, R, C)
        The missing bone; disjoint from `bone`, and together they are the complete skull.
    defect : str
        Name in `DEFECTS`.
    seed : int
        Seed it was made from.
    parameters : dict
        What the case was made with, JSON-able.
    head : HeadShape or None
        Closed-form surfaces and cutters of a phantom; None for a cut case.
    landmarks : Landmarks or None
        How a head with a face lies in the world; None for others.
    """

    hu: NDArray[np.int16] | None
    affine: NDArray[np.float64]
    bone: NDArray[np.bool_]
    implant: NDArray[np.bool_]
    defect: str
    seed: int
    parameters: dict[str, Any] = field(default_factory=dict)
    head: HeadShape | None = None
    landmarks: Landmarks | None = None

    @property
    def complete(self) -> NDArray[np.bool_]:
        """The skull before the defect, shape (P, R, C)."""
        return self.bone | self.implant

    @property
    def voxel_volume(self) -> float:
        """Volume of one voxel in mm3."""
        return float(abs(np.linalg.det(self.affine[:3, :3])))

    def slice_truth(self, plane: float) -> tuple[SliceTruth, ...]:
        """The gaps that the defects leave in one plane, in closed form.

        Parameters
        ----------
        plane : float
            Plane index.

        Returns
        -------
        tuple of SliceTruth
            One per defect that takes bone there; empty for a cut case, which has no closed form.
        """
        return () if self.head is None else gaps_in_slice(self.head, self.affine, plane)
