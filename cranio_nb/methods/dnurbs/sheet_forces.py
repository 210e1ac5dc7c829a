"""What acts on a sheet at its place: inertia, stiffness and force, each a sum over the spans of the sheet.

Frame: as in `sheet`. With J = ds/dq and its derivatives (`sheet_derivatives`),

    M = int J^T J,    K = int a11 J_v^T J_v + ... + b22 J_uu^T J_uu + sum_i k_i J^T J at the springs.

The matrices are bands (`band`): their equations are counted by control points, those of one point side by side. J is
the same for x, y and z, so that without free weights one band serves all three: by the points, M and K have the same
products w_i w_j Q_i Q_j, and nothing between x, y and z. Free weights add w_i Q_i (p_j - s) Q_j between points and
weights, and (p_i - s) Q_i . (p_j - s) Q_j between weights.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from .sheet import LOCAL, STRAINS, VALUE, Sheet
from .sheet_derivatives import derivatives, local_entries, rational_basis, shape_products
from .sheet_energy import Dynamics, Quadrature, Setting
from .span_sums import EARLIER, LATER, Places, control_of, span_band, span_products

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Forces:
    """What acts on a sheet at its place, by its coordinates.

    With free weights x, y, z and weight of a control point follow each other, and the force is one vector of all; else
    the bands are those of one of x, y and z, and the force has three columns.

    Parameters
    ----------
    matter : ndarray, shape (h + 1, q)
        The band of the integral of J^T J.
    elastic : ndarray, shape (h + 1, q)
        The band of the stiffness of sheet and springs.
    force : ndarray, shape (q,) or (q, 3)
    """

    matter: Array
    elastic: Array
    force: Array


def forces(sheet: Sheet, setting: Setting, dynamics: Dynamics, sums: Quadrature) -> Forces:
    """Inertia, stiffness and force of a sheet and its springs at the sheet's place.

    Parameters
    ----------
    sheet : Sheet
    setting : Setting
    dynamics : Dynamics
        Whether weights are free, and what holds them.
    sums : Quadrature
        Of the setting.

    Returns
    -------
    Forces
    """
    free, spans = dynamics.free_weights, sheet.spans
    # s and p from the middle of a span's control points: differences of large numbers cost digits
    control = sheet.control.reshape(-1, 3)[control_of(spans)]
    middle = control.mean(axis=1)
    own = control - middle[:, None]
    inside, pulled = (_points(sheet, splines[VALUE]) for splines in (sums.splines, sums.at_springs))
    bent, back = _strains(sheet, setting, sums, own if free else None, middle)
    elastic = bent + _squares(sums.pulled, sums.springs.strength, pulled, middle, free)
    matter = _squares(sums.inside, sums.weight, inside, middle, free)
    matter, elastic = (_band(_about_control(part, own) if free else part, sheet) for part in (matter, elastic))
    # ds/dp is w Q
    force = _pull(sheet, sums, pulled) - _summed(back, spans)
    force[:, :3] *= sheet.weights.reshape(-1, 1)
    if not free:
        return Forces(matter, elastic, force[:, :3])
    # what holds free weights at 1
    elastic[0, 3::4] += dynamics.hold
    force[:, 3] -= dynamics.hold * (sheet.weights.ravel() - 1)
    return Forces(matter, elastic, force.ravel())


def by_point(q: Array, *, free_weights: bool) -> Array:
    """Coordinates in the order of a band.

    Parameters
    ----------
    q : ndarray, shape (q,)
        All x of the control points, all y, all z, then all weights if they are free.
    free_weights : bool

    Returns
    -------
    ndarray, shape (4 n,) with free weights, else (n, 3)

    Examples
    --------
    >>> by_point(np.arange(6.0), free_weights=False).tolist()
    [[0.0, 2.0, 4.0], [1.0, 3.0, 5.0]]
    >>> by_point(np.arange(8.0), free_weights=True).tolist()
    [0.0, 2.0, 4.0, 6.0, 1.0, 3.0, 5.0, 7.0]
    """
    return q.reshape(4, -1).T.ravel() if free_weights else q.reshape(3, -1).T


def by_kind(x: Array, *, free_weights: bool) -> Array:
    """The inverse of `by_point`.

    Parameters
    ----------
    x : ndarray, shape (4 n,) with free weights, else (n, 3)
    free_weights : bool

    Returns
    -------
    ndarray, shape (q,)

    Examples
    --------
    >>> by_kind(by_point(np.arange(8.0), free_weights=True), free_weights=True).tolist()
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    """
    return x.reshape(-1, 4 if free_weights else 3).T.ravel()


def _points(sheet: Sheet, splines: sparse.csr_array) -> tuple[Array, Array]:
    """The sheet at some places, shape (k, 3), and there W, shape (k,)."""
    weights = sheet.weights.reshape(-1, 1)
    found = splines @ np.concatenate([sheet.control.reshape(-1, 3) * weights, weights], axis=1)
    return found[:, :3] / found[:, 3:], found[:, 3]


def _squares(places: Places, strength: Array, at: tuple[Array, Array], middle: Array, free: bool) -> Array:
    """Sums of strength Q_i Q_j over the places of each span for each pair, shape (spans, 1, 136).

    With free weights (spans, 8, 136): then follow those of Q_i s Q_j in x, y, z, of s Q_i Q_j, and of s Q_i . s Q_j.
    """
    points, below = at
    factor = (strength / below**2)[:, None]
    if not free:
        return span_products(places, factor)
    off = points - np.repeat(middle, np.diff(places.ends), axis=0)
    fields = [factor, factor * off, factor * (off**2).sum(axis=1, keepdims=True)]
    return span_products(places, np.concatenate(fields, axis=1))[:, [0, 1, 2, 3, 1, 2, 3, 4]]


def _strains(sheet: Sheet, setting: Setting, sums: Quadrature, own: Array | None, middle: Array) -> tuple[Array, Array]:
    """As `_squares`, for the derivatives of the energy; and their force back to the natural shape, (spans, 16, 3 or 4).

    `own` are the control points that move each span, from its middle, where weights are free.
    """
    basis = rational_basis(sheet.weights, sums.splines)
    shape = derivatives(sheet, basis)
    every = list(zip(setting.material.stiffness, STRAINS, strict=True))
    pairs = [one for one in every if one[0]] or every  # what costs nothing is not summed
    factors, kinds = zip(*pairs, strict=True)
    # rows: each strain at each place of a span, by the root of what it weighs
    root = np.sqrt(np.multiply.outer(sums.weight, factors))
    rows = lambda part, wide: part.reshape(len(middle), -1, wide)  # noqa: E731
    splines = rows(root[..., None] * np.stack([local_entries(basis[d]) for d in kinds], axis=1), LOCAL)
    strain = rows(root[..., None] * np.stack([shape[d] - sums.natural[d] for d in kinds], axis=1), 3)
    turned = splines.swapaxes(1, 2)
    same, back = (turned @ splines)[:, None, LATER, EARLIER], turned @ strain
    if own is None:
        return same, back
    shape |= {VALUE: shape[VALUE] - np.repeat(middle, np.diff(sums.inside.ends), axis=0)}
    by_shape = rows(shape_products(basis, shape, kinds, root), 3 * LOCAL)
    once = (turned @ by_shape).reshape(-1, LOCAL, 3, LOCAL).swapaxes(1, 2)
    by_axis = rows(by_shape, LOCAL)
    turned = by_axis.swapaxes(1, 2)
    twice = (turned @ by_axis)[:, None, LATER, EARLIER]
    back_weights = (own * back).sum(axis=2, keepdims=True) - turned @ rows(strain, 1)
    products = [same, once[:, :, LATER, EARLIER], once[:, :, EARLIER, LATER], twice]
    return np.concatenate(products, axis=1), np.concatenate([back, back_weights], axis=2)


def _about_control(squares: Array, own: Array) -> Array:
    """Sums as of `_squares` with p_i - s in place of s; `own` is p."""
    same, once, turned, twice = squares[:, :1], squares[:, 1:4], squares[:, 4:7], squares[:, 7]
    later, earlier = (own[:, which].swapaxes(1, 2) for which in (LATER, EARLIER))
    # (p_i - s) . (p_j - s) is p_i . (p_j - s) - s . p_j + s . s
    cross = same * earlier - once
    both = (later * cross - earlier * turned).sum(axis=1) + twice
    return np.concatenate([same, cross, same * later - turned, both[:, None]], axis=1)


def _pull(sheet: Sheet, sums: Quadrature, at: tuple[Array, Array]) -> Array:
    """Sums over the springs of Q_i k d in x, y, z, and of (p_i - s) Q_i . k d, shape (n m, 4)."""
    points, below = at
    pull = (sums.springs.strength / below)[:, None] * (sums.springs.points - points)
    found = sums.at_springs[VALUE].T @ np.column_stack([pull, (points * pull).sum(axis=1)])
    found[:, 3] = (sheet.control.reshape(-1, 3) * found[:, :3]).sum(axis=1) - found[:, 3]
    return np.asarray(found)


def _summed(parts: Array, spans: tuple[int, int]) -> Array:
    """Sums by control points of what each span gives its 16, shape (n m, 4); 0 in columns that are not given."""
    found = np.zeros(((spans[0] + 3) * (spans[1] + 3), 4))
    at = control_of(spans).ravel()
    for column in range(parts.shape[2]):
        found[:, column] = np.bincount(at, parts[:, :, column].ravel(), minlength=len(found))
    return found


def _band(products: Array, sheet: Sheet) -> Array:
    """The band of J^T J from the sums of `_squares` or `_about_control`."""
    spans = sheet.spans
    weights = sheet.weights.ravel()[control_of(spans)]
    later, earlier = weights[:, LATER], weights[:, EARLIER]
    same = span_band(products[:, 0] * later * earlier, spans)
    if products.shape[1] == 1:
        return same
    # blocks of 4 x 4 for two control points: x, y, z and weight of the later by those of the earlier
    parts = {(axis, axis): same for axis in range(3)} | {(3, 3): span_band(products[:, 7], spans)}
    for axis in range(3):
        parts[axis, 3] = span_band(products[:, 1 + axis] * later, spans)
        parts[3, axis] = span_band(products[:, 4 + axis] * earlier, spans)
    height, n = same.shape
    band = np.zeros((4 * height, 4 * n), order="F")
    for (row, column), part in parts.items():
        # above the diagonal of its block an entry of the first block is in the upper half: not kept
        kept = part if row >= column else part[1:]
        band[(row - column) % 4 :: 4, column::4][: len(kept)] = kept
    return band
