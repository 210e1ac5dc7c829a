"""How fast pictures follow a slider on a 512 x 512 scan: prints a table for the reader, tests nothing.

    python benchmarks/widgets.py [--repeats 40] [--size full]

Measured is the kernel's side: from the moment a slider's value arrives to the moment the new image is on its widget.
Beside it the same update through a new matplotlib figure, and through one figure whose data are replaced.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Iterator

import numpy as np

import cranio_nb as cn
from cranio_nb.drawing import figures
from cranio_nb.evaluation import against_truth
from cranio_nb.stages import feature_extraction
from cranio_nb.teaching import widgets
from data_synth import phantom_case


def moves(values: list, repeats: int) -> Iterator:
    """Values to and fro, so that each one is a change."""
    for i in range(repeats):
        yield values[i % len(values)]


def measure(panel: widgets.Panel, control: str, values: list, repeats: int) -> np.ndarray:
    """Seconds from each new value of a slider to its picture."""
    shown, took = panel.front.widget, []
    for value in moves(values, repeats):
        image, start = shown.picture, time.perf_counter()
        shown.values = shown.values | {control: value}
        took.append(time.perf_counter() - start)
        assert shown.picture is not image
    return np.array(took)


def time_calls(call: Callable[[int], object], repeats: int) -> np.ndarray:
    """Seconds of each call."""
    took = []
    for i in range(repeats):
        start = time.perf_counter()
        call(i)
        took.append(time.perf_counter() - start)
    return np.array(took)


def new_figure(ct: cn.Volume) -> Callable[[int], bytes]:
    """A slice through a new figure each time."""

    def draw(i: int) -> bytes:
        figure, ax = figures.new_figure(512 / figures.DPI, 512 / figures.DPI)
        ax.imshow(ct.voxels[i % ct.shape[0]], cmap="gray", vmin=-450, vmax=1050)
        return figures.png(figure)

    return draw


def same_figure(ct: cn.Volume) -> Callable[[int], bytes]:
    """A slice through one figure with new data."""
    figure, ax = figures.new_figure(512 / figures.DPI, 512 / figures.DPI)
    image = ax.imshow(ct.voxels[0], cmap="gray", vmin=-450, vmax=1050)

    def draw(i: int) -> bytes:
        image.set_data(ct.voxels[i % ct.shape[0]])
        return figures.png(figure)

    return draw


def rows(size: str, repeats: int) -> Iterator[tuple[str, np.ndarray]]:
    """Name and times of each update."""
    case = phantom_case(size)
    ct, bone = cn.Volume(case.hu, case.affine), cn.Volume(case.bone, case.affine)
    openings = cn.find_openings(bone)
    opening, px = openings[0], float(bone.spacing[1])
    plane = sum(opening.planes) // 2
    near = list(range(plane - 4, plane + 5))
    yield "new matplotlib figure: slice", time_calls(new_figure(ct), repeats)
    yield "same matplotlib figure, new data: slice", time_calls(same_figure(ct), repeats)
    viewer, bony = widgets.ct_viewer(ct), widgets.threshold(ct)
    yield "ct_viewer: slice", measure(viewer, "plane", near, repeats)
    yield "ct_viewer: window width", measure(viewer, "width", [400, 1500, 2500], repeats)
    yield "threshold: HU", measure(bony, "threshold_hu", [200, 300, 400, 500, 600], repeats)
    yield "threshold: slice", measure(bony, "plane", near, repeats)
    ends_panel = widgets.features(bone, plane, opening=opening.sheet)
    yield "features: skip", measure(ends_panel, "skip_mm", [1.0, 2.5, 4.0, 5.5], repeats)
    yield "features: reach", measure(ends_panel, "reach_mm", [6.0, 9.0, 12.0, 15.0], repeats)
    yield "features: slice, all new", measure(widgets.features(bone, plane), "plane", list(range(20, 60)), repeats)
    ends, _ = feature_extraction.find_gap_ends(
        feature_extraction.extract_features(bone.voxels[plane]), opening.sheet.voxels[plane], skip_px=4.5 / px
    )
    inside = bone.to_voxel(opening.head_centre)[1:]
    ball = widgets.balloon(ends, inside, background=bone.voxels[plane], px=px)
    fresh = np.round(np.linspace(0.0, 0.39, repeats), 3).tolist()
    yield "balloon: k, all new", measure(ball, "pressure", fresh, repeats)
    yield "balloon: N", measure(ball, "n", [11, 21, 31, 41], repeats)
    yield "balloon: step (the player)", measure(ball, "step", list(range(5, 60)), repeats)
    yield "patch: slice", measure(widgets.patch(bone, opening), "plane", near, repeats)
    made = cn.design(bone, openings, axial=True)
    true = against_truth.true_prosthesis(bone.with_voxels(case.implant), bone, opening.head_centre)
    shown = widgets.distances(made, true)
    yield "evaluation: scale", measure(shown, "top_mm", [0.5, 1.0, 2.0], repeats)
    # the panels below keep what they have made: first each stop anew, then again
    steps = list(range(1, 49))
    smooth = widgets.surface(made.patch)
    yield "surface: steps, all new", measure(smooth, "steps", steps, min(repeats, 48))
    yield "surface: steps, again", measure(smooth, "steps", steps, repeats)
    mirror = widgets.symmetry_plane(bone, opening)
    turns = np.arange(-5, 5, 0.5).tolist()
    yield "symmetry_plane: turn, all new", measure(mirror, "turn_deg", turns, repeats)
    yield from slow_rows(bone, opening, true, repeats)


def slow_rows(
    bone: cn.Volume, opening: cn.Opening, true: cn.Prosthesis, repeats: int
) -> Iterator[tuple[str, np.ndarray]]:
    """The panels that compute for long, and answer when a slider is let go: each setting anew, then again."""
    guides = widgets.guiding_points(bone, opening, true)
    for word in ("all new", "again"):
        yield f"guiding_points: n, {word}", measure(guides, "n", list(range(3, 12)), 9)
    plate = widgets.bent_plate(bone, opening, true)
    lengths = np.arange(2, 12, 0.5).tolist()
    for word in ("all new", "again"):
        yield f"bent_plate: a, {word}", measure(plate, "second_mm", lengths, len(lengths))
    sheet = widgets.elastic_sheet(bone, opening, true)
    yield "elastic_sheet: rigidity, all new", measure(sheet, "wavelength_mm", [10.0, 40.0, 63.0], 3)
    yield "elastic_sheet: step (the player)", measure(sheet, "step", [1, 2, 3, 4, 5, 6], repeats)
    tuned = widgets.tuner(phantom_case("tiny"))
    reaches = [6.0, 8.0, 12.0, 14.0]
    for word in ("all new", "again"):
        yield f"tuner: reach, {word}", measure(tuned, "reach_mm", reaches, len(reaches))


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=40)
    parser.add_argument("--size", default="full")
    asked = parser.parse_args()
    print(f"{'update':42} {'median':>8} {'p95':>8}   ms")
    for name, took in rows(asked.size, asked.repeats):
        print(f"{name:42} {1e3 * np.median(took):8.1f} {1e3 * np.percentile(took, 95):8.1f}", flush=True)


if __name__ == "__main__":
    main()
