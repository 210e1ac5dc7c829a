"""A slice is drawn in mm, with all its parts where they are."""

import dataclasses

import numpy as np
import pytest

from cranio_nb.curves import GapEnds
from cranio_nb.drawing import figures, palette
from cranio_nb.methods.slicewise.slices import SlicedDesign, SliceResult
from cranio_nb.opening import Opening
from cranio_nb.vault import slicing
from cranio_nb.volume import Volume


@pytest.fixture
def bone() -> Volume:
    """A straight bone with a gap of 40 px, slices 2 mm apart, pixels of 0.5 mm; rows along y, columns along x."""
    voxels = np.zeros((3, 60, 160), bool)
    voxels[:, 30:40, :60] = voxels[:, 30:40, 100:] = True
    affine = np.array([[0, 0, 0.5, -11.0], [0, 0.5, 0, 7.0], [2.0, 0, 0, 50.0], [0, 0, 0, 1]])
    return Volume(voxels, affine)


@pytest.fixture
def patch(bone) -> Volume:
    voxels = np.zeros(bone.shape, bool)
    voxels[1, 30:40, 60:100] = True
    return bone.with_voxels(voxels)


@pytest.fixture
def sliced(bone, patch) -> SlicedDesign:
    """The gap bridged by straight curves in the middle slice."""
    ends = tuple(GapEnds(np.array([[r, 59.0], [r, 100.0]]), np.array([[0.0, 1.0], [0.0, -1.0]])) for r in (30.0, 39.0))
    curves = np.array([[[r, 59.0], [r, 80.0], [r, 100.0]] for r in (30.0, 39.0)])
    done = SliceResult(1, "balloon", "", ends, curves + np.array([2.0, 0.0]), curves)
    results = (SliceResult(0, "skipped", "no bone"), done, SliceResult(2, "carried", "", curves=curves))
    opening = Opening(patch, bone.to_world([1, 300, 80]))
    return SlicedDesign(opening, slicing.axial_frames(bone, range(3)), 0.5, results)


def test_slice_is_drawn_in_mm_with_all_its_parts(sliced, bone, patch):
    figure, ax = figures.new_figure(4, 3)
    figures.draw_slice(ax, sliced, sliced.slices[1], bone, patch)
    outer = next(line for line in ax.lines if line.get_linestyle() == "-" and len(line.get_xdata()) == 3)
    np.testing.assert_allclose(outer.get_xdata(), [29.5, 40, 50])
    np.testing.assert_allclose(outer.get_ydata(), 15)
    bar = ax.lines[-1]
    assert np.ptp(bar.get_xdata()) == pytest.approx(20) and ax.texts[-1].get_text() == "20 mm"
    arrows = [t for t in ax.texts if getattr(t, "arrow_patch", None)]
    assert len(arrows) == 4 and "--" in {line.get_linestyle() for line in ax.lines}
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    width, height = figure.get_size_inches()
    assert (x1 - x0) / width == pytest.approx((y0 - y1) / height)


def test_masks_are_drawn_where_they_are(sliced, bone, patch):
    _, ax = figures.new_figure(4, 3)
    figures.draw_slice(ax, sliced, sliced.slices[1], bone, patch)
    for image, (x0, x1, y0, y1) in zip(
        ax.images, [(None, None, 14.75, 19.75), (29.75, 49.75, 14.75, 19.75)], strict=True
    ):
        shown = np.asarray(image.get_array())[..., 3] > 0
        left, right, bottom, top = image.get_extent()
        rows, cols = np.nonzero(shown)
        y = top + (rows + 0.5) * (bottom - top) / shown.shape[0]
        x = left + (cols + 0.5) * (right - left) / shown.shape[1]
        assert (y.min(), y.max()) == pytest.approx((y0, y1), abs=0.36)
        if x0 is not None:
            assert (x.min(), x.max()) == pytest.approx((x0, x1), abs=0.36)


def test_boundaries_part_bone_into_outside_and_inside(sliced, bone, patch):
    _, ax = figures.new_figure(4, 3)
    figures.draw_slice(ax, sliced, sliced.slices[1], bone, patch)
    outer, inner = (line for line in ax.lines if line.get_marker() == ".")
    assert np.median(outer.get_ydata()) == pytest.approx(15, abs=0.36) and outer.get_color() == palette.OUTER
    assert np.median(inner.get_ydata()) == pytest.approx(19.5, abs=0.36) and inner.get_color() == palette.INNER


@pytest.mark.parametrize("plane", [0, 1, 2])
@pytest.mark.parametrize("skeleton", [False, True])
def test_every_kind_of_slice_can_be_drawn(sliced, bone, patch, plane, skeleton):
    figure = figures.slice_figure(sliced, sliced.slices[plane], bone, patch, skeleton=skeleton)
    assert figures.png(figure).startswith(b"\x89PNG")


def test_crossings_are_marked_and_sides_named(sliced, bone, patch):
    """The inner curve starts below the outer and ends above it: they cross in the middle."""
    curves = sliced.slices[1].curves.copy()
    curves[:, :, 0] = [[30, 34.5, 39], [39, 34.5, 30]]
    figure = figures.slice_figure(sliced, dataclasses.replace(sliced.slices[1], curves=curves), bone, patch)
    ax = figure.axes[0]
    marks = [line for line in ax.lines if line.get_marker() == "x"]
    np.testing.assert_allclose([(line.get_xdata(), line.get_ydata()) for line in marks], [[[40], [17.25]]])
    letters = {t.get_text(): t.get_position() for t in ax.texts}
    assert letters["L"][0] > 0.9 and letters["R"][0] < 0.1 and letters["A"][1] > 0.9
