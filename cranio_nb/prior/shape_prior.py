"""What vaults look like: intact skulls come in -> a shape prior goes out; with it, a hole's most likely bone.

Frames: head (see `headframe`), radii in mm of the mean head along directions seen from its origin; charts (v, u) with
radii in mm of the skull; world mm (LPS).

Every intact skull is laid on the mean head, and its outer and inner radius are measured along the same 6400 rays. With
the mirror images as further skulls, these are samples f_1 .. f_m of a Gaussian process with mean mu and covariance

    K(a, b) = w taper(a, b) sum (f_i(a) - mu(a)) (f_i(b) - mu(b)) / (m - 1)  +  h(a) . h(b)  +  k(a, b),

a and b each being a ray and a side. The taper, exp(-d^2 / 2 L^2) in the chord d between the rays, drops what few
skulls cannot tell (far-off correlations, Houtekamer and Mitchell 2001, "localisation"), and lifts the rank from m - 1
to thousands. The twelve h are what small affine maps do to the radii of the mean head: a skull with a hole is not
laid quite as it would be without. k is a sum of squared exponentials, smooth over long and short ways: what skulls do
that none of these did. Where nothing was learned it is left alone, and continues the known bone smoothly. The known
bone y of a skull then gives the rest as the conditional mean (Rasmussen and Williams 2006, eq. 2.25)

    f* = mu* + K* (K + s^2 I)^-1 (y - mu).

Outer and inner side inform each other, and so do left and right: both are correlations like others.

Most of what 30 skulls give is their mean on well laid heads; their covariance adds little, and at full weight it misled
over the largest holes. Hence the small w, chosen on half of 30 skulls and confirmed on the other half. Nothing learned
is shipped: the licences of skull collections seldom allow it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg
from scipy.interpolate import CloughTocher2DInterpolator

from ..errors import InputRefused
from ..vault.ray_grid import RadiusMap
from ..volume import Volume
from . import alignment
from .alignment import Cloud, HeadFrame
from .vault_radii import (
    RADIUS,
    VAULT,
    coarse,
    distance,
    is_open,
    measure,
    mirrored,
    near,
    radius_along_rays,
    surroundings,
    vault_rays,
    without_outliers,
)

Array = NDArray[np.float64]
Mask = NDArray[np.bool_]

LEAST = 2
"""Fewest skulls that make a prior."""
_SHARE = 0.1  # w: what the sample covariance of a few dozen skulls is worth beside h and k
_TAPER = 80.0  # mm: L
_KERNEL = ((3.0, 80.0), (0.7, 25.0), (0.3, 10.0))  # mm of height and of length of each part of k
_LAID = 1.0  # mm: standard deviation of each part of the affine map that lays a skull on the mean head
_SIDES = 0.5  # correlation of the outer and the inner side in k
_NOISE = 0.2  # mm: s, voxels and sutures
_RIM, _FREE_RIM = 4.0, 6.0  # mm of bone beside a measured hole, and beside any other, that are not trusted
_FINE, _MIDDLE = 12.0, 45.0  # mm from the unknown up to which all, and a quarter, of the known rays are used
_CLOSED = 0.98  # of the vault's rays that meet bone on an intact skull
_MISFIT = 3.5  # mm: far more than any adult skull showed


@dataclass(frozen=True, eq=False)
class Prior:
    """Radius maps of intact skulls on the mean head.

    Parameters
    ----------
    mean : Cloud
        The mean head, on which a skull is laid.
    radii : ndarray of float32, shape (n, 2, m)
        Outer and inner radius of each skull along the m `vault_rays`, mm of the mean head; complete.
    """

    mean: Cloud
    radii: NDArray[np.float32]

    @property
    def samples(self) -> Array:
        """The skulls and their mirror images, shape (2 n, 2, m)."""
        return np.concatenate([self.radii, mirrored(self.radii)]).astype(float)

    def subset(self, chosen: Iterable[int]) -> Prior:
        """The same with some of its skulls."""
        return Prior(self.mean, self.radii[list(chosen)])


@dataclass(frozen=True, eq=False)
class Expected:
    """What a prior expects around an opening.

    Parameters
    ----------
    outer, inner : ndarray, shape (M, M)
        Conditional mean of the radii on the rays of the chart, mm; nan where the prior does not reach.
    frame : HeadFrame
        Where the skull was taken to stand.
    """

    outer: Array
    inner: Array
    frame: HeadFrame


def learn(bones: Iterable[Volume], progress: Callable[[str, float], None] | None = None) -> Prior:
    """Learn a prior from intact skulls.

    Parameters
    ----------
    bones : iterable of Volume
        Bool masks, taken one at a time; each is to pass `check_intact`.
    progress : callable, optional
        Called with (step, fraction).

    Raises
    ------
    InputRefused
        ``TooFewSkulls``; ``NoVault``.
    """
    tell = progress or (lambda step, done: None)
    packed, clouds = [], []
    for bone in bones:
        packed.append(_Packed.of(bone))
        clouds.append(alignment.see(bone))
    if len(packed) < LEAST:
        message = f"A prior needs {LEAST} intact skulls; {len(packed)} could be used."
        raise InputRefused("TooFewSkulls", message, "Give a folder with more scans of whole heads.")
    mean, frames = _lay_together(packed, clouds, tell)
    middle = radius_along_rays(mean.outside)
    radii = []
    for i, (one, frame) in enumerate(zip(packed, frames, strict=True)):
        tell("measuring", i / len(packed))
        radii.append(measure(one.bone, frame, middle))
    return Prior(mean, _completed(np.array(radii)).astype(np.float32))


def check_intact(bone: Volume) -> None:
    """Refuse what is not the skull of a whole head.

    Raises
    ------
    InputRefused
        ``NotIntact`` where rays of the vault meet no bone; ``NoVault``.
    """
    seen = alignment.coverage(bone)
    if seen < _CLOSED:
        message = f"{100 * (1 - seen):.0f} % of the vault is open or outside the image."
        raise InputRefused("NotIntact", message, "A prior is learned from scans of whole, closed skulls.")


def expect(prior: Prior, bone: Volume, chart: RadiusMap) -> Expected:
    """The most likely vault around an opening, given the bone that is there.

    Parameters
    ----------
    prior : Prior
    bone : Volume
        Bool mask of the skull with the hole; all of it informs, not only what the chart shows.
    chart : RadiusMap
        Of the opening.

    Raises
    ------
    InputRefused
        ``PriorDoesNotFit`` when the skull does not lie on the mean head; ``NoVault``.
    """
    frame = alignment.stand(alignment.see(bone), prior.mean)
    if frame.misfit > _MISFIT:
        message = f"The skull lies {frame.misfit:.1f} mm off the prior's mean head; {_MISFIT:g} mm is the most."
        raise InputRefused("PriorDoesNotFit", message, "Design without the prior, or learn one from such skulls.")
    middle = prior.samples.mean(axis=0)
    radii = measure(bone, frame, middle[0])
    hole = _rays_through(chart, frame, middle)
    unknown = near(hole, _RIM) | near(is_open(radii) & ~hole, _FREE_RIM)
    known = np.where(unknown, np.nan, without_outliers(radii, middle))
    directions = vault_rays() @ frame.matrix.T
    reach = min(chart.grid.n / 2 * chart.grid.step_rad + 0.2, np.pi)
    wanted: Mask = directions @ chart.grid.axes[2] > np.cos(reach) * np.linalg.norm(directions, axis=1)
    points = frame.to_world(vault_rays()[wanted] * condition(prior, known, wanted)[..., None])
    outer, inner = (_onto_chart(chart, frame, side) for side in points)
    return Expected(outer, inner, frame)


def condition(prior: Prior, radii: Array, wanted: Mask) -> Array:
    """Conditional mean of both radii, given some of them.

    Parameters
    ----------
    prior : Prior
    radii : ndarray, shape (2, m)
        Known radii, mm of the mean head; nan on either side where a ray is unknown.
    wanted : ndarray of bool, shape (m,)
        Rays to predict.

    Returns
    -------
    ndarray, shape (2, k)
        Outer and inner radius along the k wanted rays.
    """
    samples = prior.samples
    mean = samples.mean(axis=0)
    spread = (samples - mean) * np.sqrt(_SHARE / (len(samples) - 1))
    laid = _LAID * np.stack([_affine_changes(side) for side in mean])
    known = np.flatnonzero(_used(np.logical_and(*np.isfinite(radii)), wanted))
    at = np.flatnonzero(wanted)
    if not len(known):
        return mean[:, at]
    matrix = _covariance(spread, laid, known, known)
    matrix[np.diag_indices(len(matrix))] += _NOISE**2
    factor = linalg.cho_factor(matrix, overwrite_a=True, check_finite=False)
    weights = linalg.cho_solve(factor, (radii - mean)[:, known].ravel())
    return mean[:, at] + (_covariance(spread, laid, at, known) @ weights).reshape(2, -1)


def _covariance(spread: Array, laid: Array, a: NDArray[np.intp], b: NDArray[np.intp]) -> Array:
    """K between both sides of rays a and of rays b, shape (2 len(a), 2 len(b)).

    `spread` (2 n, 2, m) holds the samples about their mean, scaled, `laid` (2, m, 12) the h.
    """
    rays = vault_rays()
    squared = np.maximum(2 - 2 * rays[a] @ rays[b].T, 0) * RADIUS**2
    taper = np.exp(squared / (-2 * _TAPER**2))
    kernel = sum(height**2 * np.exp(squared / (-2 * length**2)) for height, length in _KERNEL)
    parts = []
    for i in (0, 1):
        learned = [spread[:, i, a].T @ spread[:, j, b] * taper + laid[i, a] @ laid[j, b].T for j in (0, 1)]
        parts.append([learned[j] + (1.0 if i == j else _SIDES) * kernel for j in (0, 1)])
    return np.block(parts)


def _affine_changes(radius: Array) -> Array:
    """Change of radius (m,) for 1 mm of each part of an affine map, shape (m, 12).

    A point p of a surface with normal n that moves by u changes the radius along its ray d by (n . u) / (n . d).
    """
    points = vault_rays() * radius[:, None]
    normals = alignment.normals(points)
    facing = np.maximum(np.einsum("ij,ij->i", normals, vault_rays()), 0.3)  # a ray that grazes the base tells nothing
    normals = normals / facing[:, None]
    turned = normals[:, :, None] * (points / RADIUS)[:, None, :]
    return np.concatenate([normals, turned.reshape(-1, 9)], axis=1)


def _used(known: Mask, wanted: Mask) -> Mask:
    """The known rays that are used: all near the unknown that is wanted, fewer further away."""
    away = distance(wanted & ~known)
    return known & ((away < _FINE) | (coarse(4) & (away < _MIDDLE)) | coarse(3))


@dataclass(frozen=True, eq=False)
class _Packed:
    """A bone mask at one bit a voxel: thirty fit in memory."""

    bits: NDArray[np.uint8]
    shape: tuple[int, int, int]
    affine: Array

    @classmethod
    def of(cls, bone: Volume) -> _Packed:
        return cls(np.packbits(bone.voxels), bone.shape, bone.affine)

    @property
    def bone(self) -> Volume:
        voxels = np.unpackbits(self.bits, count=int(np.prod(self.shape)))
        return Volume(voxels.reshape(self.shape).view(bool), self.affine)


def _lay_together(
    packed: list[_Packed], clouds: list[Cloud], tell: Callable[[str, float], None]
) -> tuple[Cloud, list[HeadFrame]]:
    """The mean head and each skull's frame on it: laid on the first skull by similarities, then twice on the mean."""
    mean, directions = clouds[0], alignment.sphere(4)
    for turn, affine in enumerate((False, True, True)):
        frames = []
        for i, cloud in enumerate(clouds):
            tell("aligning", (turn + i / len(clouds)) / 3)
            frames.append(alignment.stand(cloud, mean, affine=affine))
        frames = alignment.centred(frames, clouds)
        outlines = [alignment.outline(p.bone, f, directions) for p, f in zip(packed, frames, strict=True)]
        mean = alignment.mean_head(np.array(outlines), directions)
    return mean, frames


def _completed(radii: Array) -> Array:
    """Radius maps (n, 2, m) of intact skulls; where a ray is missing or far off, the offset around it holds."""
    middle = np.nanmedian(np.concatenate([radii, mirrored(radii)]), axis=0)
    usual = np.stack([middle + surroundings(one - middle) for one in radii])
    sound = np.stack([without_outliers(one, middle) for one in radii])
    return np.where(np.isfinite(sound), sound, usual)


def _rays_through(chart: RadiusMap, frame: HeadFrame, middle: Array) -> Mask:
    """Which rays pass through the chart's hole, on the outer or the inner side of the mean vault (2, m)."""
    through = np.zeros(len(vault_rays()), bool)
    for radius in middle:
        away = frame.to_world(vault_rays() * radius[:, None]) - chart.grid.centre
        through |= chart.grid.at(chart.hole, away, outside=False)
    return through


def _onto_chart(chart: RadiusMap, frame: HeadFrame, points: Array) -> Array:
    """Radius of a surface given by points (k, 3), world, along the rays of a chart, shape (M, M), mm."""
    away = points - chart.grid.centre
    grid = np.indices(chart.outer.shape).reshape(2, -1).T
    values = CloughTocher2DInterpolator(chart.grid.locate(away).T, np.linalg.norm(away, axis=1))(grid)
    radius = values.reshape(chart.outer.shape)
    seen = (chart.grid.points(radius) - frame.origin) @ np.linalg.inv(frame.matrix).T
    with np.errstate(invalid="ignore"):
        below = seen[..., 2] < np.cos(np.radians(VAULT)) * np.linalg.norm(seen, axis=-1)
    return np.where(below, np.nan, radius)
