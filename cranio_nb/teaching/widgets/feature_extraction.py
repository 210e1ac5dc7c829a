"""Stage 2 under sliders: the features of a slice, and which of its boundary points carry the tangents at the gap.

Frame: slice (row, col) px of the scan without its empty margins; lengths on controls in mm.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage
from scipy.spatial import HalfspaceIntersection

from ...curves import ChordFrame, GapEnds, Points, SliceFeatures
from ...drawing.canvas import Canvas
from ...drawing.palette import BLACK, BONE, GREY, INNER, OUTER, TANGENT, WHITE, rgb_of
from ...drawing.pixels import RGB, Window, plain, tinted
from ...stages import feature_extraction as stage
from ...volume import Volume
from ..classroom import LessonCase
from .controls import Slider, View
from .panel import Panel
from .parts import HEIGHT, LEFT, RIGHT, WIDTH, annotate_slice, left_window

_INSET = (HEIGHT - 8) / 2  # px: height of a close-up
_AROUND = 22.0  # mm shown around a gap end in a close-up


def features(bone: Volume, plane: int, *, opening: Volume | None = None, case: LessonCase | None = None) -> Panel:
    """Boundary, skeleton, hull and end tangents of a slice.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    plane : int
        Slice to begin with.
    opening : Volume, optional
        Bool mask of the opening on the same grid (``opening.sheet``): says which gap is meant.
    case : LessonCase, optional
        Its closed form says which angles are to be expected.

    Returns
    -------
    Panel
        Controls ``plane``, ``skip_mm`` and ``reach_mm``.
    """
    part = Slices(bone, opening, case)
    controls = (
        Slider("plane", f"slice (0 to {bone.shape[0] - 1})", 0, bone.shape[0] - 1, plane, ahead=4, near=3),
        Slider("skip_mm", "skip: left out at the cut", 0, 20, 4.5, 0.5, unit="mm"),
        Slider("reach_mm", "reach: fitted after that", 1, 40, 10, 0.5, unit="mm"),
    )
    alt = (
        "Bone of a slice with outer boundary, inner boundary, spine and convex hull; two close-ups show the boundary "
        "points that carry the tangent line at each end of the gap, and the tangents."
    )
    presets = {"skip 0": {"skip_mm": 0.0}, "reach 6 mm": {"skip_mm": 4.5, "reach_mm": 6.0}}
    presets |= {"reach 40 mm": {"skip_mm": 4.5, "reach_mm": 40.0}}
    return Panel(controls, lambda **values: _view(part, **values), alt=alt, presets=presets)


class Slices:
    """The slices of a skull, cut down to where there is bone, and the features of those that were asked for.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    opening : Volume or None
        Bool mask of the opening on the same grid.
    case : LessonCase or None
        What is known of the gaps.
    """

    def __init__(self, bone: Volume, opening: Volume | None, case: LessonCase | None) -> None:
        # 8 px more than the bone of all slices needs: features do not change, pictures are larger
        box = ndimage.find_objects(bone.voxels.any(axis=0).view(np.uint8))
        rows, cols = (slice(max(s.start - 8, 0), s.stop + 8) for s in box[0]) if box else (slice(None), slice(None))
        self.bone = bone.crop((slice(None), rows, cols))
        self.sheet = None if opening is None else opening.crop((slice(None), rows, cols))
        self.case, self.px = case, float(bone.spacing[1:].mean())
        self.window = left_window(self.bone.voxels)
        self.features = lru_cache(maxsize=8)(lambda plane: stage.extract_features(self.bone.voxels[plane]))
        self.background = lru_cache(maxsize=8)(lambda plane: _draw_background(self, plane))

    def ends(self, plane: int, *, skip_mm: float, reach_mm: float) -> tuple[GapEnds, GapEnds]:
        """Ends of the gap of a plane.

        Parameters
        ----------
        plane : int
        skip_mm, reach_mm : float
            As for `feature_extraction.find_gap_ends`, in mm.

        Returns
        -------
        outer, inner : GapEnds
            Slice (row, col) px.
        """
        opening = None if self.sheet is None else self.sheet.voxels[plane]
        skip_px, reach_px = skip_mm / self.px, reach_mm / self.px
        return stage.find_gap_ends(self.features(plane), opening, skip_px=skip_px, reach_px=reach_px)

    def expected(self, plane: int, length: float) -> tuple[float, float] | None:
        """End angles of a gap of the true place that is longer or shorter than the true one, as in a circle.

        Parameters
        ----------
        plane : int
        length : float
            Of the outer gap, px.

        Returns
        -------
        tuple of float or None
            theta0 and theta1, degrees: their sines are as the lengths. None where the truth is not known.
        """
        if self.case is None or not self.case.true_angles(plane):
            return None
        curve = self.case.true_curves(plane)[0]
        sines = np.sin(np.radians(self.case.true_angles(plane)[0])) * length / np.linalg.norm(curve[-1] - curve[0])
        lean0, lean1 = np.degrees(np.arcsin(np.clip(sines, -1, 1)))
        return float(lean0), float(180 - lean1)


def _view(part: Slices, plane: int, skip_mm: float, reach_mm: float) -> View:
    """A slice with its features, and close-ups of both ends of its gap."""
    mask, window = part.bone.voxels[plane], part.window
    try:
        # what does not depend on skip and reach is drawn once for each slice
        background, rgb, found, outside = part.background(plane)
    except stage.SliceProblem as problem:
        canvas = Canvas(WIDTH, HEIGHT)
        canvas.show(tinted(plain(mask.shape), mask, BONE), window)
        return View(canvas.array(), f"Slice {plane}: {problem}")
    canvas = background.copy()
    try:
        # ends and tangents at this skip and reach; a slice that has none says why
        pair = part.ends(plane, skip_mm=skip_mm, reach_mm=reach_mm)
    except stage.SliceProblem as problem:
        return View(canvas.array(), f"Slice {plane}: {problem}")
    lengths = {"skip_px": skip_mm / part.px, "reach_px": reach_mm / part.px}
    fits = [_fit(found, outside, ends, **lengths) for ends in pair]
    _draw_ends(canvas, window, fits, part.px, 1.0)
    # a close-up of each end, about half-way between outer and inner boundary
    for side in (0, 1):
        middle = (pair[0].points[side] + pair[1].points[side]) / 2
        box = (RIGHT[0], side * (HEIGHT - _INSET), RIGHT[2], _INSET)
        _close_up(canvas, box, rgb, middle, fits, part.px, side)
    line = f"Slice {plane}, skip {skip_mm:g} mm, reach {reach_mm:g} mm: {_angles(part, plane, found, pair[0])}; "
    counts = " and ".join(str(sum(len(points) for points in fit.used)) for fit in fits)
    return View(canvas.array(), line + f"{counts} boundary points carry the outer and inner tangents.")


def _angles(part: Slices, plane: int, found: SliceFeatures, outer: GapEnds) -> str:
    """Length and end angles of the outer gap, with those to expect where the truth is known."""
    # the middle of the spine lies on the inner side of the gap
    frame = ChordFrame.of(outer, np.concatenate(found.skeleton).mean(axis=0))
    wanted = part.expected(plane, frame.length)
    told = ["", ""] if wanted is None else [f" (expect {angle:.1f})" for angle in wanted]
    theta0, theta1 = (f"{a:.1f}{w}" for a, w in zip(np.degrees(frame.end_angles(outer)), told, strict=True))
    return f"the outer ends are {frame.length * part.px:.1f} mm apart, theta0 {theta0}, theta1 {theta1} degrees"


def _draw_background(part: Slices, plane: int) -> tuple[Canvas, RGB, SliceFeatures, NDArray[np.bool_]]:
    """What `skip` and `reach` do not change: canvas, slice in colours, features, which boundary is off the hull."""
    # the slice with its boundaries, then spine and hull as lines over it
    found, mask = part.features(plane), part.bone.voxels[plane]
    outside = ~found.in_hull
    canvas, window = Canvas(WIDTH, HEIGHT), part.window
    rgb = _slice_picture(mask, found)
    canvas.show(rgb, window)
    _draw_lines(canvas, window, found)
    annotate_slice(canvas, window, part.bone, plane)
    # the legend lies in the cavity, where nothing is drawn
    outer_name, inner_name = "outer boundary, B \N{MINUS SIGN} S", "inner boundary, B \N{INTERSECTION} S"
    bounds = [(OUTER, "area", outer_name), (INNER, "area", inner_name)]
    lines = [(BLACK, "line", "spine"), (GREY, "dash", "hull S"), (BLACK, "dash", "fitted line")]
    lines.append((WHITE, "dot", "end of the balloon"))
    used = [(TANGENT, "dot", "used for a tangent"), (TANGENT, "line", "tangents")]
    canvas.legend(LEFT / 2 - 90, HEIGHT / 2 - 66, [*bounds, *lines, *used])
    return canvas, rgb, found, outside


@dataclass(frozen=True, eq=False)
class Fit:
    """Ends of a gap, and for each the boundary points whose line is its tangent, shape (m, 2) each."""

    ends: GapEnds
    used: tuple[Points, ...]


def _fit(found: SliceFeatures, outside: NDArray[np.bool_], ends: GapEnds, *, skip_px: float, reach_px: float) -> Fit:
    """The boundary points behind each tangent; `outside` says which lie off the hull."""
    # B - S or B and S, by the boundary pixel nearest to one of the ends
    is_outer = bool(outside[np.argmin(np.hypot(*(found.boundary - ends.points[0]).T))])
    boundary = found.boundary[outside == is_outer]
    # each end has the run of a spine that starts nearest to it
    runs = [run for spine in found.skeleton for run in (spine, spine[::-1])]
    used = []
    for point in ends.points:
        run = min(runs, key=lambda r: np.hypot(*(r[0] - point)))
        used.append(boundary[stage.select_tangent_points(boundary, run, skip_px=skip_px, reach_px=reach_px)])
    return Fit(ends, tuple(used))


def _slice_picture(mask: NDArray[np.bool_], found: SliceFeatures) -> RGB:
    """Bone with its outer and inner boundary pixels, shape (R, C, 3)."""
    rgb = tinted(plain(mask.shape), mask, BONE)
    for points, colour in ((found.outer, OUTER), (found.inner, INNER)):
        row, col = points.astype(np.intp).T
        rgb[row, col] = rgb_of(colour)
    return rgb


def _draw_lines(canvas: Canvas, window: Window, found: SliceFeatures) -> None:
    """Hull and spines."""
    # corners of the hull from its half-planes, about a point inside, joined by their angle
    inside = found.skeleton[0].mean(axis=0)
    for candidate in (inside, np.concatenate(found.skeleton).mean(axis=0)):
        if (found.hull[:, :2] @ candidate + found.hull[:, 2] < -1e-6).all():
            corners = HalfspaceIntersection(found.hull, candidate).intersections
            angle = np.arctan2(*(corners - candidate).T)
            outline = corners[np.argsort(angle)]
            canvas.line(window.px(np.concatenate([outline, outline[:1]])), GREY, width=1.5, dash=(7, 4))
            break
    for spine in found.skeleton:
        canvas.line(window.px(spine), BLACK, width=1.5)


def _draw_ends(canvas: Canvas, window: Window, fits: list[Fit], px: float, size: float) -> None:
    """Used points, fitted lines, tangents and gap ends."""
    for fit in fits:
        for points, end, tangent in zip(fit.used, fit.ends.points, fit.ends.tangents, strict=True):
            canvas.dots(window.px(points), TANGENT, radius=1.2 * size + 0.6)
            # the fitted line goes through the mean of the used points; the tangent starts at the end, beside it
            middle = points.mean(axis=0)
            along = (points - middle) @ tangent
            canvas.line(
                window.px([middle + along.min() * tangent, middle + along.max() * tangent]),
                BLACK,
                width=1.5,
                dash=(4, 3),
            )
            canvas.arrow(window.px(end), window.px(end + 12.0 / px * tangent), TANGENT, width=1.2 + 0.8 * size)
            canvas.dots(window.px(end), WHITE, radius=2.0 + 1.5 * size, edge=BLACK)


def _close_up(
    canvas: Canvas,
    box: tuple[float, float, float, float],
    rgb: RGB,
    middle: Points,
    fits: list[Fit],
    px: float,
    side: int,
) -> None:
    """One end of the gap, large."""
    # the same part of the slice twice: as a place on the canvas, and within the inset
    x, y, width, height = box
    window = Window.around(box, middle - _AROUND / px, middle + _AROUND / px)
    inset = Canvas(int(width), int(height))
    here = Window((0, 0, width, height), window.rows, window.cols)
    inset.show(rgb, here)
    # only what belongs to this end
    one = [Fit(GapEnds(f.ends.points[[side]], f.ends.tangents[[side]]), (f.used[side],)) for f in fits]
    _draw_ends(inset, here, one, px, 2.0)
    inset.scale_bar(12, height - 12, 10 / px * here.zoom, "10 mm")
    inset.text(width - 10, 20, f"end {side + 1}", anchor="rs", halo=True)
    edge = [(0, 0), (width - 1, 0), (width - 1, height - 1), (0, height - 1), (0, 0)]
    inset.line(edge, GREY, width=1)
    canvas.inlay(inset, x, y)
