"""What the lessons share: the case they work on, and pictures that carry a description.

Frames: a lesson's slices are (row, col) px of one plane of the scan; `LessonCase.px` is the size of a pixel in mm.

Everything is made on the spot from a seed, so a lesson needs no network and no data. Where the lesson is run on
somebody's own scan there is no truth, and what is drawn or measured against it is left out.
"""

from __future__ import annotations

import os
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..drawing import figures, palette
from ..drawing.described import described
from ..errors import InputRefused
from ..opening import Opening
from ..readers import read_ct
from ..stages import feature_extraction
from ..volume import Volume

if TYPE_CHECKING:
    from data_synth import Case, Gap

    from ..drawing.figures import Axes, Figure

LINES = (
    (palette.BLUE, "-"),
    (palette.VERMILLION, "--"),
    (palette.GREEN, "-."),
    (palette.PURPLE, ":"),
    (palette.BLACK, "-"),
)
"""Colour and style of the first, second, ... curve of a picture: told apart without colour as well."""


@dataclass(frozen=True, eq=False)
class LessonCase:
    """A scan to work on, with what is known about it.

    Parameters
    ----------
    ct : Volume
        HU.
    truth : Volume or None
        Bool mask of the missing bone; None for a scan of one's own.
    phantom : data_synth.Case or None
        The synthetic head behind it.
    """

    ct: Volume
    truth: Volume | None
    phantom: Case | None

    @property
    def px(self) -> float:
        """Size of a pixel of a slice, mm."""
        return float(self.ct.spacing[1:].mean())

    def true_curves(self, plane: int) -> tuple[NDArray[np.float64], ...]:
        """Closed-form outer and inner curve across the widest gap of a plane, (row, col) px; empty where unknown."""
        return tuple(gap.curve for gap in self._widest(plane))

    def true_angles(self, plane: int) -> tuple[NDArray[np.float64], ...]:
        """Closed-form (theta0, theta1) of the outer and the inner gap of a plane, degrees; empty where unknown."""
        return tuple(gap.angles for gap in self._widest(plane))

    def _widest(self, plane: int) -> tuple[Gap, ...]:
        truths = self.phantom.slice_truth(plane) if self.phantom else ()
        gaps = [(t.outer, t.inner) for t in truths if t.outer and t.inner]
        return max(gaps, key=lambda pair: pair[0].chord, default=())


def load(
    size: str = "class",
    *,
    defect: str = "unilateral",
    seed: int = 0,
    scan: str | os.PathLike[str] | None = None,
    truth: str | os.PathLike[str] | None = None,
    needs_truth: bool = False,
) -> LessonCase:
    """The case of a lesson.

    Parameters
    ----------
    size : {"tiny", "class", "full"}
        Grid of the synthetic head; the environment variable ``CRANIO_NB_SIZE`` goes before it.
    defect : str
        Kind of hole, a key of `data_synth.DEFECTS`.
    seed : int
        Chooses head, place and rim.
    scan : path, optional
        A scan of one's own (DICOM folder, NIfTI or NRRD with HU) instead; ``CRANIO_NB_SCAN`` goes before it.
    truth : path, optional
        Mask of the bone that is missing in that scan, where it is known; ``CRANIO_NB_TRUTH`` goes before it.
    needs_truth : bool
        Whether the lesson makes no sense without a truth.

    Raises
    ------
    InputRefused
        If the scan or the truth cannot be read, or the truth is wanted and there is none (``NoTruth``).
    ValueError
        If there is no such size or defect.
    """
    path, known = os.environ.get("CRANIO_NB_SCAN") or scan, os.environ.get("CRANIO_NB_TRUTH") or truth
    if path and needs_truth and not known:
        raise InputRefused(
            "NoTruth",
            "This lesson measures against the bone that is missing, and for this scan it is not known.",
            "Name its mask in CRANIO_NB_TRUTH (`cranio-nb phantom --from` cuts a hole and writes one), "
            "or unset CRANIO_NB_SCAN.",
        )
    if path:
        from ..pipeline.run import read_truth

        ct = read_ct(path)[0]
        return LessonCase(ct, read_truth(known, ct) if known else None, None)
    from data_synth import phantom_case

    case = phantom_case(os.environ.get("CRANIO_NB_SIZE") or size, defect, seed)
    assert case.hu is not None
    return LessonCase(Volume(case.hu, case.affine), Volume(case.implant, case.affine), case)


def bridged_plane(bone: Volume, opening: Opening, *, skip_px: float, reach_px: float) -> int:
    """The plane nearest to the middle of an opening in which both ends of the gap can be seen.

    Parameters
    ----------
    bone : Volume
        Bool mask.
    opening : Opening
    skip_px, reach_px : float
        As for `feature_extraction.find_gap_ends`.

    Raises
    ------
    InputRefused
        ``NoAxialGap`` where no plane has both, as for a hole at the very top of the head.
    """
    first, end = opening.planes
    for plane in sorted(range(first, end), key=lambda p: abs(p - (first + end) // 2)):
        with suppress(feature_extraction.SliceProblem):
            seen = feature_extraction.extract_features(bone.voxels[plane])
            feature_extraction.find_gap_ends(seen, opening.sheet.voxels[plane], skip_px=skip_px, reach_px=reach_px)
            return plane
    raise InputRefused(
        "NoAxialGap",
        "In no slice of this scan can both ends of the gap be seen.",
        "This lesson cuts as the paper does, along the scan's own slices: take a hole in the side of the head.",
    )


picture = described
"""A figure with its description and its line of numbers: the last line of a cell."""


def axes(n: int = 1, *, height: float = 3.4, width: float = 9.0) -> tuple[Figure, list[Axes]]:
    """A figure with `n` axes side by side, of given inches in all."""
    figure, _ = figures.new_figure(width, height)
    figure.clear()
    figure.set_layout_engine("constrained")
    return figure, list(figure.subplots(1, n, squeeze=False)[0])


def show_hu(ax: Axes, hu: NDArray, *, px: float, centre: float = 300.0, width: float = 2000.0, title: str = "") -> None:
    """Draw a slice of HU, shape (R, C), in greys from centre - width / 2 to centre + width / 2; axes in mm."""
    low, high = centre - width / 2, centre + width / 2
    ax.imshow(hu, cmap="gray", vmin=low, vmax=high, extent=_extent(hu.shape, px), interpolation="nearest")
    _label(ax, title)


def show_mask(ax: Axes, mask: NDArray[np.bool_], *, px: float, colour: str = palette.BONE, title: str = "") -> None:
    """Draw a mask, shape (R, C), in one colour over what is there; axes in mm."""
    rgba = np.zeros((*mask.shape, 4))
    rgba[mask] = [*(int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)), 1.0]
    ax.imshow(rgba, extent=_extent(mask.shape, px), interpolation="nearest")
    _label(ax, title)


def show_points(ax: Axes, points: ArrayLike, *, px: float, colour: str, marker: str = ".", label: str = "") -> None:
    """Draw points, (row, col) px of shape (n, 2), on a slice."""
    row, col = np.asarray(points, float).reshape(-1, 2).T * px
    ax.plot(col, row, ls="none", marker=marker, ms=3 if marker == "." else 6, color=colour, label=label or None)


def show_curve(ax: Axes, points: ArrayLike, *, px: float, line: int = 0, label: str = "") -> None:
    """Draw a curve, (row, col) px of shape (n, 2), on a slice in the style `LINES[line]`."""
    row, col = np.asarray(points, float).reshape(-1, 2).T * px
    colour, style = LINES[line]
    ax.plot(col, row, ls=style, lw=1.8, color=colour, label=label or None)


def show_tangents(ax: Axes, points: ArrayLike, tangents: ArrayLike, *, px: float, length: float = 14.0) -> None:
    """Draw gap ends as rings and their tangents, both (row, col) of shape (n, 2), as arrows of `length` mm."""
    for point, tangent in zip(np.asarray(points, float) * px, np.asarray(tangents, float), strict=True):
        tip = point + length * tangent
        ax.annotate("", tip[::-1], point[::-1], arrowprops={"arrowstyle": "-|>", "color": palette.GREEN, "lw": 1.6})
        ax.plot(*point[::-1], marker="o", ms=6, mfc="white", mec=palette.BLACK)


def zoom(ax: Axes, points: Iterable[ArrayLike], *, px: float, margin: float = 15.0) -> None:
    """Show only what lies within `margin` mm of the points, (row, col) px; call it last."""
    every = np.concatenate([np.asarray(p, float).reshape(-1, 2) for p in points]) * px
    (top, left), (bottom, right) = every.min(axis=0) - margin, every.max(axis=0) + margin
    ax.set(xlim=(left, right), ylim=(bottom, top))


def plot_lines(ax: Axes, x: ArrayLike, ys: dict[str, ArrayLike], *, xlabel: str, ylabel: str, title: str = "") -> None:
    """Draw named curves over the same x, with a legend, in colours and styles that all can tell apart."""
    for (name, y), (colour, style) in zip(ys.items(), LINES, strict=False):
        ax.plot(x, y, color=colour, ls=style, label=name)
    ax.set(xlabel=xlabel, ylabel=ylabel, title=title)
    ax.grid(alpha=0.3)
    ax.legend(fontsize=8)


def _extent(shape: tuple[int, ...], px: float) -> tuple[float, float, float, float]:
    rows, cols = shape
    return (-0.5 * px, (cols - 0.5) * px, (rows - 0.5) * px, -0.5 * px)


def _label(ax: Axes, title: str) -> None:
    ax.set(xlabel="mm", ylabel="mm", title=title, aspect="equal")
