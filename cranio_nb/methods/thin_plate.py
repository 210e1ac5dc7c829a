"""A thin plate across the hole: bone mask in, pieces out.

Idea: seen from inside the head each surface of the vault is one radius per direction (`RadiusMap`). A plate that lies
on the bone around the hole is bent across it as little as can be. With radii f on the bone, mirrored radii m where the
other side of the skull has bone, radii e that are expected, and D^n all partial derivatives of order n on the map,
the radii g = e + h minimise

    sum w (g - f)^2 + a^4 |D^2 h|^2 + b^6 |D^3 h|^2 + c^4 sum v |D^2 (g - m)|^2 + s sum |h|^2 .

Without a prior e is one radius for all and s is 0: the plate is a piece of a sphere that is bent. With one, e is the
mean of intact skulls given this skull's bone, and springs s hold the plate to it in the hole. Near the rim the
plate is the better informed, in the middle of a wide hole the springs are; where the other side shows the shape,
the plate is stiffer and heeds them less.

The second order pulls smoothed bone towards spheres, the third towards quadrics, so that it carries the rim's
curvature into the hole, but also the rim's bumps; both together err less than either. The last term asks the plate to
be curved as the other side is; it does not depend on where the other side lies, so an asymmetric head and a plane that
is a little off leave no step at the rim. It is left out where the mirrored skull lies more than 1.3 mm off the skull:
then the plane is wrong, or the head has none. The lengths a, b, c (mm) say over what distance bone is smoothed; across
the hole only their ratios matter. The weights w and v drop bone that does not belong to the vault, ridges, vessels and
sinuses (Cauchy's weights, iterated); w is also smaller where rays cross thick slices, since a mask tells less there.
Each surface is one sparse symmetric system, solved directly.

Source: thin plates in cranioplasty are Carr, Fright and Beatson 1997 (doi 10.1109/42.563663): radial basis functions
on a depth map, second order, interpolating. Ours are the radius map, finite differences in place of radial
functions, the third order, the smoothing, the robust weights, the inner surface, the mirrored side and the springs.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import lru_cache
from math import comb
from pathlib import Path
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage, sparse

from ..errors import InputRefused
from ..geometry import symmetric_system, voxel_pieces
from ..opening import Opening
from ..options import Option
from ..prior.around_opening import predict_around
from ..prior.file import load_prior
from ..prior.shape_prior import Prior
from ..vault import radius_measurement, radius_voxels, symmetry
from ..vault.ray_grid import RadiusMap, filled_from_nearest
from ..vault.symmetry import SymmetryPlane
from ..volume import Volume
from .piece import Piece

Array = NDArray[np.float64]

_NODES = 2.0  # mm between the nodes of the plate
_REACH = 25.0  # mm of bone beside the hole that the plate lies on
_RIM = 0.8  # mm beside the hole that are not fitted: rays graze a rim, and a scan blurs it
_HOLDS = (0.01, 0.1, 1.0, 1.0)  # how firmly the data hold in each round of weighting
_LEAST_SPREAD = 0.05  # mm: residuals below this are no outliers
_LOPSIDED = 1.3  # mm of median residual from which a symmetry plane is not one: its mirror image did harm
_SPRING = 1e-4  # s: draws the middle of a hole of 75 mm half the way to what is expected, (64 a^4 / s)^(1/4) = R
_RAYS_APART = 3.0  # mm between the rays on which skulls were learned: what is finer there is noise
_FAINT = 1e-10  # weight that holds the plate to the mean radius where bone holds it nowhere
_LEAST_NODES = 12


@dataclass(frozen=True, eq=False)
class Plate:
    """What the method did for one opening.

    Parameters
    ----------
    radius_map : RadiusMap
        The vault around the opening.
    outer, inner : ndarray, shape (M, M)
        Radii of the prosthesis, mm; nan outside the hole.
    mirrored : tuple of ndarray, shape (M, M), or None
        Outer and inner radii of the other side of the skull; nan where it has none.
    expected : tuple of ndarray, shape (M, M), or None
        Outer and inner radii that a prior predicts.
    """

    radius_map: RadiusMap
    outer: Array
    inner: Array
    mirrored: tuple[Array, Array] | None
    expected: tuple[Array, Array] | None


def pieces(
    bone: Volume,
    openings: Sequence[Opening],
    *,
    # beyond 20 mm the plate no longer follows the bone that it lies on
    second_mm: Annotated[float, Option("Smoothing by second order; 0 for none.", 0, 20, "mm")] = 1.3,
    third_mm: Annotated[float, Option("Smoothing by third order; 0 for none.", 0, 20, "mm")] = 1.8,
    mirror_mm: Annotated[float, Option("Smoothing towards the other side; 0 for none.", 0, 20, "mm")] = 1.6,
    # no system takes longer paths
    prior: Annotated[str, Option("File of `cranio-nb prior learn`; empty for none.", 0, 4096, "characters")] = "",
) -> Iterator[Piece]:
    """Close each opening by bending thin plates across it.

    Parameters
    ----------
    bone, openings
        As for `methods.design.design`.
    second_mm, third_mm : float
        The lengths a and b over which bone is smoothed by the second and the third order, mm; 0 for none.
    mirror_mm : float
        The length c over which bone is smoothed towards the curvature of the other side, mm; 0 for none.
    prior : str
        File made by `cranio-nb prior learn`: the plate is then held to what intact skulls predict. Empty for none.

    Yields
    ------
    Piece
        The record's `symmetry` describes the symmetry plane or why there is none; the piece is empty where too
        little bone is seen around the opening. `working` holds a `Plate`.

    Raises
    ------
    InputRefused
        ``NoPrior`` or ``PriorDoesNotFit``.
    """
    # one symmetry plane serves all openings: it is the whole skull's
    learned = load_prior(Path(prior)) if prior else None
    with ThreadPoolExecutor(1) as beside:
        searched = beside.submit(_symmetry, bone, openings[0]) if mirror_mm else None
        radius_measurement.measure_around(bone, openings[0])  # meanwhile; kept for its plate
    plane, found = (None, {"unused": "not asked for"}) if searched is None else searched.result()
    record = {"symmetry": found} if learned is None else {"symmetry": found, "prior_skulls": len(learned.radii)}
    lengths = {"second_mm": second_mm, "third_mm": third_mm, "mirror_mm": mirror_mm}
    for opening in openings:
        plate = _plate(bone, opening, plane, learned, lengths)
        yield Piece(_solid(plate, opening, bone), (plate,), record)


def bend(
    values: Array,
    hole: NDArray[np.bool_],
    mm: float,
    *,
    like: Array | None = None,
    expected: Array | None = None,
    firmness: Array | None = None,
    second_mm: float = 1.3,
    third_mm: float = 1.8,
    mirror_mm: float = 1.6,
) -> Array:
    """Continue a map across a hole with the least bending.

    Parameters
    ----------
    values : ndarray, shape (M, N)
        Radii, or differences of radii to a model of the skull, mm; nan where unknown.
    hole : ndarray of bool, shape (M, N)
        Where the map is wanted; what is known of it there is not used.
    mm : float
        Distance between neighbours on the map.
    like : ndarray, shape (M, N), optional
        A map of the same curvature, up to anything; nan where unknown.
    expected : ndarray, shape (M, N), optional
        A map to bend less far from, known everywhere; springs hold the plate to it in the hole.
    firmness : ndarray, shape (M, N), optional
        The weights w before stray bone lowers them, as inverse variances are; 1 when not given.
    second_mm, third_mm, mirror_mm : float
        The lengths a, b and c of the energy, mm; 0 for none.

    Returns
    -------
    ndarray, shape (M, N)
        The plate in the hole and up to 25 mm around it; nan elsewhere, and everywhere if nothing is known.
    """
    # the plate covers the hole and a band of bone, which carries curvature into it
    beside = ndimage.distance_transform_edt(~hole) * mm <= _REACH
    out = np.full(values.shape, np.nan)
    known = (np.isfinite(values) & ~hole)[beside]
    if known.sum() < _LEAST_NODES:
        return out
    # h = g - e: only what departs from what is expected is bent
    base = np.full(values.shape, np.median(values[beside][known])) if expected is None else expected
    data = np.where(known, (values - base)[beside], 0.0)
    # a^4 |D^2 h|^2 + b^6 |D^3 h|^2, lengths in nodes
    stiffness = _stiffness(beside, 2, second_mm / mm) + _stiffness(beside, 3, third_mm / mm)
    push = np.zeros(len(data))
    # c^4 v |D^2 (g - m)|^2: a matrix, and a force towards the mirrored curvature
    if like is not None and mirror_mm:
        held, push = _towards((like - base)[beside], beside, mirror_mm / mm)
        stiffness = stiffness + held
    # springs s to the expected radii, in the hole only: bone needs none
    if expected is not None:
        stiffness = stiffness + sparse.diags_array(_SPRING * hole[beside])
    sure = known.astype(float) if firmness is None else np.where(known, firmness[beside], 0.0)
    out[beside] = base[beside] + _settle(stiffness, push, data, sure)
    return out


def _settle(stiffness: sparse.csr_array, push: Array, data: Array, sure: Array) -> Array:
    """The minimum of the energy, with weights that fall from `sure` (0 where nothing is known) with the residuals."""
    weight = sure
    for hold in _HOLDS:  # first a stiff plate, which no stray bone can bend
        # (S + w) g = w f + push, the zero of the energy's slope
        held = (stiffness + sparse.diags_array(hold * weight + _FAINT)).tocsc()
        g = symmetric_system.solve(held, hold * weight * data + push)
        # Cauchy's weights at three standard deviations, these from the median
        residual = np.abs(g - data) * np.sqrt(sure)
        spread = max(1.4826 * float(np.median(residual[sure > 0])), _LEAST_SPREAD)
        weight = sure / (1 + (residual / (3 * spread)) ** 2)
    return g


def _towards(like: Array, beside: NDArray[np.bool_], length: float) -> tuple[sparse.csr_array, Array]:
    """The energy of second differences unlike those of another map: its matrix and its right-hand side."""
    # differences that touch an unknown place of the other map are left out
    known = np.isfinite(like)
    differences = _differences(beside.tobytes(), beside.shape, 2)
    differences = differences[abs(differences) @ (~known).astype(float) == 0]
    # v: where the other side bends sharply (ridge, sinus), its bend is not copied
    wanted = differences @ np.where(known, like, 0.0)
    spread = 1.4826 * float(np.median(np.abs(wanted))) if len(wanted) else 0.0
    weight = length**4 / (1 + (wanted / (4 * spread + 1e-6)) ** 2)
    pull = (differences.T @ sparse.diags_array(weight)).tocsr()
    return pull @ differences, pull @ wanted


def _stiffness(beside: NDArray[np.bool_], order: int, length: float) -> sparse.csr_array:
    """The energy length^(2 order) |D^order g|^2 as a matrix."""
    differences = _differences(beside.tobytes(), beside.shape, order)
    return (differences.T @ differences) * length ** (2 * order)


@lru_cache(maxsize=4)  # both surfaces of an opening, and all lengths that a lesson tries, have the same nodes
def _differences(beside: bytes, shape: tuple[int, int], order: int) -> sparse.csr_array:
    """All partial differences of an order that lie within the plate, each by the root of its multiplicity."""
    # |D^n g|^2 sums over all orders of the axes: the mixed parts count binomially often
    nodes = np.frombuffer(beside, bool).reshape(shape)
    index = np.where(nodes, np.cumsum(nodes).reshape(shape) - 1, -1)
    parts = [_partial(index, order - i, i) * np.sqrt(comb(order, i)) for i in range(order + 1)]
    return sparse.vstack(parts).tocsr()


def _partial(index: NDArray[np.intp], down: int, across: int) -> sparse.csr_array:
    """One partial difference, `down` times along the rows' axis and `across` times along the columns'."""
    # n-th difference: alternating binomial coefficients
    along_rows, along_cols = ([(-1.0) ** j * comb(n, j) for j in range(n + 1)] for n in (down, across))
    stencil = np.outer(along_rows, along_cols)
    # only stencils that lie wholly on the plate: its edge is free
    nodes = np.lib.stride_tricks.sliding_window_view(index, stencil.shape).reshape(-1, stencil.size)
    nodes = nodes[(nodes >= 0).all(axis=1)]
    # one row for each stencil, one column for each node
    rows = np.repeat(np.arange(len(nodes)), stencil.size)
    shape = (len(nodes), int(index.max()) + 1)
    return sparse.csr_array((np.tile(stencil.ravel(), len(nodes)), (rows, nodes.ravel())), shape=shape)


def _symmetry(bone: Volume, opening: Opening) -> tuple[SymmetryPlane | None, dict[str, Any]]:
    """The symmetry plane, if there is one, and what to record of it."""
    try:
        plane = symmetry.find_symmetry_plane(bone, opening.head_centre, opening.head_axes)
    # a skull with too little of the other side still gets its plate, without that term
    except InputRefused as refused:
        return None, {"unused": refused.message}
    # a bad plane would press the wrong curvature onto the hole
    if plane.residual_mm > _LOPSIDED:
        return None, plane.record() | {"unused": f"The mirrored skull lies {plane.residual_mm:.1f} mm off the skull."}
    return plane, plane.record()


def _plate(
    bone: Volume, opening: Opening, plane: SymmetryPlane | None, learned: Prior | None, lengths: dict[str, float]
) -> Plate:
    """Both plates of one opening."""
    # all that is known of the vault on the rays: bone, its mirror image, the prior's mean
    radius_map = radius_measurement.measure_around(bone, opening)
    mirrored = None if plane is None else _other_side(bone, radius_map, plane)
    expected = None if learned is None else _expected(bone, radius_map, learned, opening.head_axes)
    # a coarser grid of nodes for the plate; its hole keeps every node that any missing ray touches
    nodes = max(1, round(_NODES / radius_map.step_mm))
    hole = thin_map(radius_map.hole.astype(float), nodes) > 1e-9  # more than what the filter leaves of rounding
    rim = ndimage.distance_transform_edt(~radius_map.hole) * radius_map.step_mm <= _RIM
    firmness = thin_map(radius_measurement.firmness(radius_map, bone), nodes)
    radii = []
    # each surface by itself
    for i, radius in enumerate((radius_map.outer, radius_map.inner)):
        known = np.where(rim, np.nan, radius)
        like, likely = (None if maps is None else thin_map(maps[i], nodes) for maps in (mirrored, expected))
        mm = radius_map.step_mm * nodes
        plate = bend(thin_map(known, nodes), hole, mm, like=like, expected=likely, firmness=firmness, **lengths)
        radii.append(np.where(radius_map.hole, _refined(plate, nodes, radius_map.hole.shape), np.nan))
    return Plate(radius_map, radii[0], radii[1], mirrored, expected)


def _other_side(bone: Volume, radius_map: RadiusMap, plane: SymmetryPlane) -> tuple[Array, Array]:
    """Outer and inner radii of the mirrored skull along the map's rays; nan where it lacks bone."""
    other = radius_measurement.measure_along(radius_map, plane.mirrored(bone))
    return np.where(other.hole, np.nan, other.outer), np.where(other.hole, np.nan, other.inner)


def _expected(bone: Volume, radius_map: RadiusMap, learned: Prior, axes: Array | None) -> tuple[Array, Array] | None:
    """Outer and inner radii that a prior predicts, continued where it does not reach; None where it never does."""
    # the prior is known on its coarser rays: blurred over their spacing, it has no facets
    predicted = predict_around(learned, bone, radius_map, axes)
    if not (np.isfinite(predicted.outer) & radius_map.hole).any():
        return None
    filled = (filled_from_nearest(radius) for radius in (predicted.outer, predicted.inner))
    outer, inner = (ndimage.gaussian_filter(radius, _RAYS_APART / radius_map.step_mm) for radius in filled)
    return outer, inner


def _solid(plate: Plate, opening: Opening, bone: Volume) -> NDArray[np.bool_]:
    """The voxels between both plates; none where bone holds no plate."""
    if not np.isfinite(plate.outer).any():
        return np.zeros(bone.shape, bool)
    # the two plates are independent: where they come too close they are moved apart
    outer, inner = radius_voxels.thickened(plate.radius_map, outer=plate.outer, inner=plate.inner)
    between = radius_voxels.voxels_between(plate.radius_map, bone, outer=outer, inner=inner)
    return voxel_pieces.keep_main_piece(between, opening.sheet.voxels)


def thin_map(values: Array, nodes: int) -> Array:
    """Every n-th value about a map's middle, as the mean of its known neighbours, so that the scan's stairs even out.

    Parameters
    ----------
    values : ndarray, shape (M, M)
        nan where unknown.
    nodes : int
        n.

    Returns
    -------
    ndarray, shape (K, K)
        nan where less than half of the neighbours are known.
    """
    # mean over the known of n x n neighbours: sum of the known, by their share
    known = np.isfinite(values)
    width = 2 * (nodes // 2) + 1
    share = ndimage.uniform_filter(known.astype(float), width)
    mean = ndimage.uniform_filter(np.where(known, values, 0.0), width) / np.maximum(share, 1e-9)
    # the map's middle stays a node, so that coarse and fine map share it
    start = (len(values) // 2) % nodes
    return np.where(share > 0.5, mean, np.nan)[start::nodes, start::nodes]


def _refined(values: Array, nodes: int, shape: tuple[int, ...]) -> Array:
    """The map that `thin_map` would have made these values from: cubic between the nodes."""
    start = (shape[0] // 2) % nodes
    places = (np.indices(shape) - start) / nodes
    return ndimage.map_coordinates(filled_from_nearest(values), places, order=3, mode="nearest")
