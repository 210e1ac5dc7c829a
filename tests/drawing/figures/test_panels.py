"""Panels of one head: what lies where, on which side of the patient, at which scale, and what a zoom's frame covers."""

import numpy as np
import pytest
from shapes import ball, cube

from cranio_nb.drawing import figures
from cranio_nb.drawing.figures import panels
from cranio_nb.drawing.palette import BLUE, BONE, PATCH, rgb_of, rgb_shares
from cranio_nb.drawing.shading import Solid
from cranio_nb.volume import Volume

UPRIGHT = np.array([[0, 0, 0.5, -11.0], [0, 0.8, 0, 7.0], [2.0, 0, 0, 50.0], [0, 0, 0, 1]])
FLIPPED = np.array([[0, 0, -0.5, -11.0], [0, -0.8, 0, 7.0], [2.0, 0, 0, 50.0], [0, 0, 0, 1]])


def scan_of(affine=UPRIGHT):
    return Volume(np.zeros((3, 50, 80), bool), affine)


def letters_of(ax):
    """Letter of each side by the edge where it stands."""
    edges = {(0.985, 0.5): "right", (0.015, 0.5): "left", (0.5, 0.985): "top", (0.5, 0.015): "bottom"}
    places = {text.get_position(): text.get_text() for text in ax.texts}
    return {edge: places[place] for place, edge in edges.items()}


@pytest.mark.parametrize(
    ("affine", "wanted"),
    [
        (UPRIGHT, {"right": "L", "left": "R", "top": "A", "bottom": "P"}),
        (FLIPPED, {"right": "R", "left": "L", "top": "P", "bottom": "A"}),
    ],
    ids=["as a viewer sees it", "both axes flipped"],
)
def test_letters_stand_on_the_sides_where_the_affine_leads(affine, wanted):
    _, named = figures.panel_figure(["a"], 3, 3)
    figures.slice_panel(named["a"], scan_of(affine))
    assert letters_of(named["a"]) == wanted


def test_a_slice_is_in_mm_and_a_mask_lies_where_its_points_lie():
    scan, mask = scan_of(), np.zeros((50, 80), bool)
    mask[30, 21] = True
    _, named = figures.panel_figure(["a"], 3, 3)
    ax = named["a"]
    figures.slice_panel(ax, scan)
    assert ax.get_xlim() == (-0.25, 39.75) and ax.get_ylim() == pytest.approx((39.6, -0.4))
    figures.paint(ax, mask, scan, PATCH)
    figures.plot_points(ax, np.array([[30.0, 21.0]]), scan)
    left, _, _, top = ax.images[0].get_extent()
    assert (left + 21.5 * 0.5, top + 30.5 * 0.8) == pytest.approx(tuple(ax.lines[-1].get_xydata()[0]))
    assert tuple(np.round(255 * ax.images[0].get_array()[30, 21, :3]).astype(int)) == rgb_of(PATCH)


def test_a_scale_bar_has_the_length_that_it_names():
    _, named = figures.panel_figure(["a"], 3, 3)
    figures.slice_panel(named["a"], scan_of())
    assert np.ptp(named["a"].lines[-1].get_xdata()) == pytest.approx(10) and named["a"].texts[-1].get_text() == "10 mm"


@pytest.mark.parametrize("layout", ["ab", ("a", "b")], ids=["beside", "below"])
def test_a_zooms_frame_covers_what_the_zoom_shows(layout):
    figure, named = figures.panel_figure([layout] if isinstance(layout, str) else layout, 4, 3)
    whole, zoom = named["a"], named["b"]
    figures.slice_panel(whole, scan_of())
    figures.slice_panel(zoom, scan_of(), around=[np.array([[20, 30], [30, 50]])], margin_mm=2.0)
    figures.mark_zoom(whole, zoom)
    x, y = next(line for line in whole.lines if line.get_gid() == panels.ZOOM_FRAME).get_data()
    assert (x.min(), x.max()) == zoom.get_xlim() == (13.0, 27.0)
    assert (y.max(), y.min()) == zoom.get_ylim() == pytest.approx((26.0, 14.0))
    # each line joins a corner of the frame with a corner of the zoom, and neither crosses the other
    figure.draw_without_rendering()
    leads = [text for text in whole.texts if getattr(text, "arrow_patch", None)]
    ends = [(whole.transData.transform(t.get_position()), zoom.transAxes.transform(t.xy)) for t in leads]
    along = 1 if layout == "ab" else 0
    assert len(ends) == 2 and all({t.get_position()} <= set(zip(x, y, strict=True)) for t in leads)
    (start, end), (other_start, other_end) = ends
    assert np.sign(start[along] - other_start[along]) == np.sign(end[along] - other_end[along]) != 0


def test_the_key_names_everything_once():
    figure, named = figures.panel_figure(["ab"], 4, 3)
    mask = np.ones((50, 80), bool)
    for ax in named.values():
        figures.slice_panel(ax, scan_of())
        figures.paint(ax, mask, scan_of(), BONE, label="bone")
    figures.outline(named["b"], mask, scan_of(), BLUE, label="truth")
    figures.key(figure)
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["bone", "truth"]


def test_a_surface_is_seen_in_mm_with_its_sides():
    """A ball from the front: x to the right, z up."""
    _, named = figures.panel_figure(["a"], 3, 3)
    ax = named["a"]
    picture = figures.view_panel(ax, [Solid(ball((30, 0, -40), 10), rgb_shares(BLUE))], (0, -1, 0), px_mm=0.5)
    assert letters_of(ax) == {"right": "L", "left": "R", "top": "S", "bottom": "I"}
    left, right, bottom, top = ax.images[0].get_extent()
    rows, cols = np.nonzero(np.isfinite(picture.depth))
    seen = left + (cols.mean() + 0.5) * 0.5, top + (rows.mean() + 0.5) * 0.5
    assert seen == pytest.approx((30, 40), abs=0.3) and right - left == pytest.approx(0.5 * picture.depth.shape[1])
    assert ax.get_xlim()[0] < left and ax.get_ylim()[0] > bottom


def test_surfaces_of_unlike_size_come_to_one_scale():
    _, named = figures.panel_figure(["ab"], 4, 3)
    for ax, size in zip(named.values(), (10.0, 30.0), strict=True):
        figures.view_panel(ax, [Solid(cube(size), rgb_shares(BLUE))], (1, 0, 0), px_mm=1.0)
    figures.one_scale(list(named.values()))
    assert len({round(float(np.ptp(ax.get_xlim())), 6) for ax in named.values()}) == 1
    assert len({round(float(np.ptp(ax.get_ylim())), 6) for ax in named.values()}) == 1
    assert {ax.texts[-1].get_text() for ax in named.values()} == {"10 mm"}


def test_without_points_the_whole_slice_is_shown():
    _, named = figures.panel_figure(["a"], 3, 3)
    figures.slice_panel(named["a"], scan_of(), around=[np.empty((0, 2))], margin_mm=3.0)
    left, right, bottom, top = panels.slice_extent(scan_of())
    assert named["a"].get_xlim() == (left, right) and named["a"].get_ylim() == pytest.approx((bottom, top))
