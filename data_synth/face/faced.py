"""Size, seed, holes, pose -> a head CT with a face, and the exact missing bone and landmarks.

Frames: voxel (plane, row, col), planes to the scanner's top, rows to its back, columns to its left; world mm, DICOM
LPS. The pose turns the head in the world; the planes may be turned as well, which makes the header oblique.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace

import numpy as np
from numpy.typing import NDArray

from ..case import Case
from ..defect import DefectSpec, plan_cutters
from ..phantom import SIZES
from .anatomy import Anatomy
from .base_map import base_map
from .braincase import braincase
from .devices import devices
from .holes import draw_holes
from .landmarks import Landmarks, landmarks
from .pose import Pose
from .render import render

Array = NDArray[np.float64]

REACHES = ("vault", "neck")
"""How far a scan reaches: over the whole braincase, or over chin and neck as well."""
_CENTRE = np.array([12.3, -31.6, -803.1])  # world mm: a plain but unsymmetric place
_MARGIN = 7.0  # mm of air above the scalp
_LOW = np.array([[0.0, -84.0, -126.0], [40.0, 20.0, -118.0], [-40.0, 20.0, -118.0]])  # head mm: chin and neck


def face_case(
    size: str = "class",
    seed: int = 0,
    *,
    holes: int | str | Sequence[DefectSpec] = 0,
    diameters_mm: Sequence[float] | None = None,
    pose: Pose | None = None,
    planes: Pose | None = None,
    slice_mm: float | None = None,
    reach: str = "vault",
    around: Sequence[str] = (),
    streaks: bool = False,
    noise: float = 12.0,
    blur_mm: float = 0.5,
    asymmetry: float = 1.0,
) -> Case:
    """A head CT with a face, intact or with holes.

    Parameters
    ----------
    size : {"tiny", "class", "full"}
        Rows, columns and spacing; see `SIZES`. The planes are as many as the head needs.
    seed : int
        The same seed gives the same bytes. Head and holes do not depend on the options from `pose` on.
    holes : int, str or sequence of DefectSpec
        Number of holes (0 to 3) placed by the seed, a name in `DEFECTS`, or the holes themselves.
    diameters_mm : sequence of float, optional
        Mean diameter in mm of each of the numbered holes, 10 to 120; drawn if not given.
    pose : Pose, optional
        How the head lies in the world.
    planes : Pose, optional
        How the scan's planes are turned in the world: the header is oblique by as much. The same value as `pose`
        gives a head that lies straight in the picture.
    slice_mm : float, optional
        Distance and thickness of the slices, 0.5 to 5; the size's own if not given.
    reach : {"vault", "neck"}
        How far the scan reaches.
    around : sequence of str
        What surrounds the head or is fixed to it, names in `AROUND`.
    streaks : bool
        Whether metal throws streaks.
    noise : float
        Standard deviation of the scanner's noise in HU.
    blur_mm : float
        Standard deviation in mm of the scanner's blur within a slice.
    asymmetry : float
        Factor on the difference between left and right; 0 for a head that is its own mirror image.

    Returns
    -------
    Case
        `bone` holds all bone of the picture, face, jaw, teeth and neck included; `implant` what the holes took.

    Raises
    ------
    ValueError
        If the size, a name or a number is not one of these, or the holes do not fit.

    Examples
    --------
    >>> case = face_case("tiny", 3, holes=2, pose=Pose(nod_deg=20), slice_mm=5.0)
    >>> case.bone.shape, case.defect, case.landmarks.up.round(2)
    ((37, 128, 128), '2 holes', array([ 0.  , -0.34,  0.94]))
    """
    _check(size, slice_mm, reach)
    pose, planes, grid = pose or Pose(), planes or Pose(), SIZES[size]
    rng = np.random.default_rng([seed, 7])
    head = _head(rng, pose, asymmetry=asymmetry, thickness_scale=grid.thickness_scale)
    head, name = _with_holes(head, holes, diameters_mm, rng)
    spacing = np.array([slice_mm or grid.spacing[0], *grid.spacing[1:]])
    affine, count = _grid(head, planes, spacing, grid.shape, reach)
    down = pose.rotation().T @ planes.rotation() @ [0.0, 1.0, 0.0]
    things = devices(around, head, down, np.random.default_rng([seed, 8]), streaks=streaks)
    hu, bone, implant = render(
        head, affine, (count, *grid.shape[1:]), devices=things, noise=noise, blur_mm=blur_mm, seed=seed
    )
    parameters = {"size": size, "pose": asdict(pose), "planes": asdict(planes), "slice_mm": float(spacing[0])}
    parameters |= {
        "reach": reach,
        "around": list(around),
        "streaks": streaks,
        "noise": noise,
        "blur_mm": blur_mm,
        "asymmetry": asymmetry,
    }
    found: Landmarks = landmarks(head)
    return Case(hu, affine, bone, implant, name, seed, parameters, head.case, found)


def _check(size: str, slice_mm: float | None, reach: str) -> None:
    if size not in SIZES:
        raise ValueError(f"There is no size named {size!r}; choose one of {', '.join(SIZES)}.")
    if reach not in REACHES:
        raise ValueError(f"A scan cannot reach over {reach!r}; choose one of {', '.join(REACHES)}.")
    if slice_mm is not None and not 0.5 <= slice_mm <= 5.0:
        raise ValueError(f"Slices of 0.5 to 5 mm are wanted, not {slice_mm} mm.")


def _head(rng: np.random.Generator, pose: Pose, *, asymmetry: float, thickness_scale: float) -> Anatomy:
    case = braincase(rng, _CENTRE, pose.rotation(), asymmetry=asymmetry, thickness_scale=thickness_scale)
    return Anatomy(case, base_map(rng), 1 + 0.03 * rng.uniform(-1, 1, 3))


def _with_holes(
    head: Anatomy,
    holes: int | str | Sequence[DefectSpec],
    diameters_mm: Sequence[float] | None,
    rng: np.random.Generator,
) -> tuple[Anatomy, str]:
    """The head with its cutters, and the defect's name."""
    if isinstance(holes, int):
        if holes == 0 and not diameters_mm:
            return head, "intact"
        specs: str | tuple[DefectSpec, ...] = draw_holes(rng, holes, diameters_mm)
        name = f"{holes} hole" + "s" * (holes > 1)
    else:
        specs = holes if isinstance(holes, str) else tuple(holes)
        name = holes if isinstance(holes, str) else f"{len(specs)} holes"
    cutters = plan_cutters(specs, rng, lambda d: float(head.case.outer_radius(d)))
    return replace(head, case=replace(head.case, cutters=cutters)), name


def _grid(head: Anatomy, planes: Pose, spacing: Array, shape: tuple[int, int, int], reach: str) -> tuple[Array, int]:
    """Affine and number of planes: the braincase in the middle of the image, air above it."""
    assert head.case.rotation is not None
    axes = planes.rotation()[:, ::-1]  # columns: along plane, row, col
    scalp, low = (spots @ head.case.rotation.T @ axes for spots in (_scalp(head), _LOW))
    along = np.concatenate([scalp, low]) if reach == "neck" else scalp
    middle = np.array([_middle(along[:, 0]), _middle(scalp[:, 1]), _middle(scalp[:, 2])])
    count = int(np.ceil((np.ptp(along[:, 0]) + 2 * _MARGIN) / spacing[0])) + 1
    affine = np.eye(4)
    affine[:3, :3] = axes * spacing
    affine[:3, 3] = head.case.centre + axes @ (middle - spacing * (np.array([count, *shape[1:]]) - 1) / 2)
    return affine, count


def _middle(values: Array) -> float:
    return float(values.min() + values.max()) / 2


def _scalp(head: Anatomy) -> Array:
    """Points all over the scalp, head mm, shape (n, 3)."""
    z, turn = np.linspace(-1, 1, 61)[:, None], np.linspace(0, 2 * np.pi, 90)
    flat = np.sqrt(1 - z**2)
    d = np.stack(np.broadcast_arrays(flat * np.cos(turn), flat * np.sin(turn), z), axis=-1).reshape(-1, 3)
    return d * head.case.skin_radius(d)[:, None]
