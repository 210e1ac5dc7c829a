"""Slice headers -> a stack in order, and how far the headers are from it. World is DICOM LPS, lengths in mm.

One test decides: the corners of every slice by its own header against the corners by the stack's straight line.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InputRefused
from .slice_header import SliceHeader, Vector

CORNER_TOL_MM = 0.05  # mm
MAX_STEP_MM = 5.0  # mm between slices
MAX_STEP_RATIO = 4.0  # widest to narrowest step that is resampled
MIN_SLICES = 8
SAME_PLACE_MM = 1e-3  # mm
_SPACING_RANGE_MM = (0.05, 10.0)  # mm in the plane
_FARTHEST_MM = 1e4  # mm: no scanner is so large, and single precision still tells 0.001 mm apart there
_REMEDY = "Export the series again from its source."


@dataclass(frozen=True, eq=False)
class Stack:
    """Slices in the order of their height.

    Parameters
    ----------
    headers : tuple of SliceHeader
        N of them, from the lowest to the highest.
    origin : ndarray, shape (3,)
        Centre of the first pixel of the lowest slice, mm.
    along_cols, along_rows : ndarray, shape (3,)
        Unit directions in which the column and the row index grow.
    normal : ndarray, shape (3,)
        Unit direction in which the height grows.
    spacing : ndarray, shape (2,)
        mm between rows, and between columns.
    heights : ndarray, shape (N,)
        mm along the normal, from 0.
    shear : ndarray, shape (3,)
        mm that a slice slides in its own plane for each mm of height; zero in an upright stack.
    """

    headers: tuple[SliceHeader, ...]
    origin: Vector
    along_cols: Vector
    along_rows: Vector
    normal: Vector
    spacing: Vector
    heights: Vector
    shear: Vector

    @property
    def extent(self) -> float:
        """Mm from the lowest to the highest slice."""
        return float(self.heights[-1])

    def corner_errors(self, heights: Vector) -> Vector:
        """How far each slice's worst corner lies from where the stack puts it.

        Parameters
        ----------
        heights : ndarray, shape (N,)
            mm along the normal at which the slices are put.

        Returns
        -------
        ndarray, shape (N,)
            mm.
        """
        origins = self.origin + heights[:, None] * (self.normal + self.shear)
        model = _corners(origins, self.along_cols, self.along_rows, self.spacing, self.headers[0])
        own = np.stack([_own_corners(header) for header in self.headers])
        return np.linalg.norm(own - model, axis=-1).max(axis=-1)


def axes_of(orientation: Vector) -> tuple[Vector, Vector, Vector]:
    """The three directions of a slice.

    Parameters
    ----------
    orientation : ndarray, shape (6,)
        ImageOrientationPatient: unit directions in which the column and the row index grow, LPS.

    Returns
    -------
    cols, rows, normal : ndarray, shape (3,)
        Unit vectors at right angles; the normal's largest part is positive.

    Raises
    ------
    InputRefused
        ``BadGeometry`` unless the two directions are unit vectors at right angles within 1e-3.

    Examples
    --------
    >>> axes_of(np.array([1.0, 0, 0, 0, 1, 0]))[2]
    array([0., 0., 1.])
    """
    cols, rows = orientation[:3], orientation[3:]
    gram = np.array([cols @ cols, rows @ rows, cols @ rows])
    if not np.isfinite(gram).all() or np.abs(gram - [1, 1, 0]).max() > 2e-3:
        raise bad_geometry("The slice directions (ImageOrientationPatient) are not unit vectors at right angles.")
    # rounded headers are made exactly orthogonal
    cols = cols / np.linalg.norm(cols)
    rows = rows - (rows @ cols) * cols
    rows = rows / np.linalg.norm(rows)
    normal = np.cross(cols, rows)
    return cols, rows, normal * np.sign(normal[np.abs(normal).argmax()]) + 0.0


def check_geometry(headers: list[SliceHeader]) -> None:
    """Refuse slices whose position, orientation or pixel spacing is absent or no number.

    Parameters
    ----------
    headers : list of SliceHeader

    Raises
    ------
    InputRefused
        ``BadGeometry``, naming the first such slice.
    """
    for header in headers:
        index = header.file if header.frames == 1 else header.frame
        for name, value in (
            ("ImagePositionPatient", header.position),
            ("ImageOrientationPatient", header.orientation),
            ("PixelSpacing", header.spacing),
        ):
            if value is None or not np.isfinite(value).all():
                what = "has no" if value is None else "has an unreadable"
                raise bad_geometry(f"Slice {index} (in file order) {what} {name}.")
        if header.position is None or np.abs(header.position).max() > _FARTHEST_MM:
            raise bad_geometry(f"Slice {index} (in file order) lies more than {_FARTHEST_MM:g} mm away.")
        low, high = _SPACING_RANGE_MM
        if header.spacing is None or header.spacing.min() < low or header.spacing.max() > high:
            raise bad_geometry(f"Slice {index} (in file order) has a PixelSpacing outside {low} to {high} mm.")


def bad_geometry(message: str) -> InputRefused:
    """The refusal for geometry that cannot be trusted; nothing is guessed from file order or slice numbers.

    Parameters
    ----------
    message : str
        One sentence: what was found.

    Returns
    -------
    InputRefused
    """
    return InputRefused("BadGeometry", message, _REMEDY)


def sort_by_height(headers: list[SliceHeader]) -> tuple[list[SliceHeader], NDArray[np.float64]]:
    """Sort slices by their height along the normal.

    Parameters
    ----------
    headers : list of SliceHeader
        With positions; the first one's orientation gives the normal.

    Returns
    -------
    ordered : list of SliceHeader
        From the lowest to the highest.
    heights : ndarray, shape (N,)
        mm along the normal, from 0.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> axial = np.array([1.0, 0, 0, 0, 1, 0])
    >>> slices = [SimpleNamespace(orientation=axial, position=np.array([0, 0, z])) for z in (105.0, 100.0, 102.5)]
    >>> sort_by_height(slices)[1]
    array([0. , 2.5, 5. ])
    """
    *_, normal = axes_of(_orientation(headers[0]))
    heights = np.array([header.position for header in headers]) @ normal
    order = np.argsort(heights, kind="stable")
    return [headers[i] for i in order], heights[order] - heights[order[0]]


def build_stack(headers: list[SliceHeader]) -> Stack:
    """Build the straight stack through checked headers.

    Parameters
    ----------
    headers : list of SliceHeader
        One per height.

    Returns
    -------
    Stack
        Slices by height, on the least-squares line through their positions.

    Raises
    ------
    InputRefused
        ``BadGeometry`` where all slices lie at one place, or a corner is more than `CORNER_TOL_MM` off.

    Examples
    --------
    A gantry tilted by 10 degrees lets each slice slide by tan(10 degrees) mm for each mm of height:

    >>> from data_synth import write_dicom
    >>> from .parse import parse_file
    >>> from .slice_header import read_headers
    >>> hu = np.zeros((8, 4, 4), np.int16)
    >>> files = write_dicom("scan", hu, np.diag([2.5, 1, 1, 1])[[2, 1, 0, 3]], tilt_deg=10)
    >>> stack = build_stack([header for file in files for header in read_headers(*parse_file(file, 0), 0)])
    >>> bool(np.isclose(np.linalg.norm(stack.shear), np.tan(np.radians(10))))
    True
    """
    ordered, heights = sort_by_height(headers)
    if heights[-1] < SAME_PLACE_MM:
        many = f"All {len(headers)} slices lie at one position."
        raise bad_geometry("The series holds a single slice." if len(headers) == 1 else many)
    cols, rows, normal = axes_of(_orientation(ordered[0]))

    # the line through the slices; what of it is not along the normal is the tilt of the gantry
    positions = np.array([header.position for header in ordered])
    origin, direction = _line(positions, heights)
    spacing = np.asarray(ordered[0].spacing, float)
    shear = direction - (direction @ normal) * normal
    shear[np.abs(shear) * heights[-1] < 1e-6] = 0  # rounding of the fit

    # every slice must lie on it
    stack = Stack(tuple(ordered), origin, cols, rows, normal, spacing, heights, shear)
    errors = stack.corner_errors(heights)
    worst = int(errors.argmax())
    if errors[worst] > CORNER_TOL_MM:
        raise bad_geometry(f"Slice {worst} lies {errors[worst]:.2f} mm off the straight stack of the others.")
    return stack


def _line(positions: Vector, heights: Vector) -> tuple[Vector, Vector]:
    """Least-squares line: position = origin + height * direction."""
    # one fit for all three coordinates
    design = np.stack([np.ones_like(heights), heights], axis=1)
    (origin, direction), *_ = np.linalg.lstsq(design, positions, rcond=None)
    return origin, direction


def _corners(origin: Vector | None, cols: Vector, rows: Vector, spacing: Vector | None, header: SliceHeader) -> Vector:
    """Corners of slices whose first pixels are at `origin`, shape (..., 4, 3)."""
    # from the centre of the first pixel to those of the other corners
    down, right = np.asarray(spacing) * (header.rows - 1, header.cols - 1)
    steps = np.array([[0, 0], [0, right], [down, 0], [down, right]]) @ np.stack([rows, cols])
    return np.asarray(origin)[..., None, :] + steps


def _own_corners(header: SliceHeader) -> Vector:
    """Corners of one slice by its own header, shape (4, 3)."""
    iop = _orientation(header)
    return _corners(header.position, iop[:3], iop[3:], header.spacing, header)


def _orientation(header: SliceHeader) -> Vector:
    """Orientation of a slice that was checked to have one, shape (6,)."""
    return np.asarray(header.orientation, float)
