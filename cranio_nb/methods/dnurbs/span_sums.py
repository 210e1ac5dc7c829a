"""Places on a sheet, and sums over them span by span: all places of a span are moved by the same 16 control points.

So a sum over thousands of places of products of two B-splines is a small dense matrix for each span, and all of them
together are a band (`band`) by control points, counted row by row of the net.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .sheet import LOCAL, basis

Array = NDArray[np.float64]

_SIDE = 4  # B-splines of a span, one way
_FIRST, _SECOND = np.triu_indices(_SIDE)
_N_PAIRS = len(_FIRST)  # of two of them
LATER, EARLIER = np.tril_indices(LOCAL)
"""All pairs of control points of a span, the later one of the net first; each once, and each with itself."""


def _products_of_pairs() -> NDArray[np.intp]:
    """For each pair of control points its product of B-splines along v and that along u, as one number."""
    number = np.zeros((_SIDE, _SIDE), int)
    number[_FIRST, _SECOND] = number[_SECOND, _FIRST] = np.arange(_N_PAIRS)
    return (number[:, None, :, None] * _N_PAIRS + number[None, :, None, :]).reshape(LOCAL, LOCAL)[LATER, EARLIER]


_PRODUCTS = _products_of_pairs()


@dataclass(frozen=True, eq=False)
class Places:
    """Places on a sheet, sorted by span.

    Parameters
    ----------
    order : ndarray, shape (k,), int
        The places as they were given, in the order of their spans.
    ends : ndarray, shape (spans + 1,), int
        Where the places of each span begin; the last one ends.
    along_v, along_u : ndarray, shape (k, 10)
        Products of two B-splines along v and along u, sorted.
    """

    order: NDArray[np.intp]
    ends: NDArray[np.intp]
    along_v: Array
    along_u: Array


def sorted_places(v: Array, u: Array, spans: tuple[int, int]) -> Places:
    """Sort places by their span, and take the B-splines there.

    Parameters
    ----------
    v, u : ndarray, shape (k,)
        Parameters.
    spans : tuple of int
        Along v and u.

    Returns
    -------
    Places
    """
    # the last span holds its end too
    at_v, at_u = (np.minimum(x.astype(int), n - 1) for x, n in zip((v, u), spans, strict=True))
    span = at_v * spans[1] + at_u
    order = np.argsort(span, kind="stable")
    ends = np.searchsorted(span[order], np.arange(spans[0] * spans[1] + 1))
    splines = [basis(x[order], n).data.reshape(-1, _SIDE) for x, n in zip((v, u), spans, strict=True)]
    return Places(order, ends, *(part[:, _FIRST] * part[:, _SECOND] for part in splines))


@lru_cache(maxsize=4)
def control_of(spans: tuple[int, int]) -> NDArray[np.intp]:
    """The control points that move each span.

    Parameters
    ----------
    spans : tuple of int
        Along v and u.

    Returns
    -------
    ndarray, shape (spans, 16), int
        Places in the ravelled net, rising.

    Examples
    --------
    >>> control_of((4, 4))[5].tolist()
    [8, 9, 10, 11, 15, 16, 17, 18, 22, 23, 24, 25, 29, 30, 31, 32]
    """
    net = np.arange((spans[0] + _SIDE - 1) * (spans[1] + _SIDE - 1)).reshape(spans[0] + _SIDE - 1, -1)
    return np.lib.stride_tricks.sliding_window_view(net, (_SIDE, _SIDE)).reshape(-1, LOCAL)


def span_products(places: Places, fields: Array) -> Array:
    """Sums of the products of two B-splines over the places of each span, times each of some fields.

    Parameters
    ----------
    places : Places
    fields : ndarray, shape (k, f)
        Factors at the places.

    Returns
    -------
    ndarray, shape (spans, f, 136)
        For the pairs `LATER`, `EARLIER`.

    Examples
    --------
    The products of all B-splines at a place sum to 1; pairs of two are here once:

    >>> places = sorted_places(np.array([0.5, 3.0]), np.array([1.5, 1.6]), (4, 4))
    >>> found = span_products(places, np.array([[1.0], [10.0]]))[[1, 13], 0]
    >>> (found * np.where(LATER == EARLIER, 1, 2)).sum(axis=1).round(9).tolist()
    [1.0, 10.0]
    """
    # B_a B_b is a product along v times one along u; of these there are 10 each, as a b is b a
    fields, along_v = fields.T[:, None], places.along_v.T
    sums = np.zeros((len(places.ends) - 1, len(fields), _N_PAIRS, _N_PAIRS))
    for found, (first, end) in zip(sums, pairwise(places.ends), strict=True):
        np.matmul(fields[:, :, first:end] * along_v[:, first:end], places.along_u[first:end], out=found)
    return np.take(sums.reshape(len(sums), -1, _N_PAIRS**2), _PRODUCTS, axis=2)


def span_band(products: Array, spans: tuple[int, int]) -> Array:
    """The lower band, by control points, of a matrix that is a sum of one for each span.

    Parameters
    ----------
    products : ndarray, shape (spans, 136)
        For the pairs `LATER`, `EARLIER`.
    spans : tuple of int

    Returns
    -------
    ndarray, shape (3 m + 4, n m)
        n m control points.
    """
    at, height, n = _places_in_band(spans)
    return np.bincount(at, products.ravel(), minlength=height * n).astype(float, copy=False).reshape(height, n)


@lru_cache(maxsize=4)
def _places_in_band(spans: tuple[int, int]) -> tuple[NDArray[np.intp], int, int]:
    """Where two control points of each span lie in the ravelled band, and the shape of that."""
    first, second = (control_of(spans)[:, one] for one in (LATER, EARLIER))
    n = (spans[0] + _SIDE - 1) * (spans[1] + _SIDE - 1)
    return ((first - second) * n + second).ravel(), (_SIDE - 1) * (spans[1] + _SIDE) + 1, n
