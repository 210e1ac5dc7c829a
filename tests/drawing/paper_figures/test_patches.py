"""Figures 6 and 7: nothing of hull minus bone is lost between its colours, and zooms hold what they are for."""

import numpy as np
import pytest
from skimage.morphology import convex_hull_image

from cranio_nb.drawing import paper_figures
from cranio_nb.drawing.palette import PATCH, TRUTH, rgb_shares

PLANE = 1


@pytest.fixture
def dented(round_head):
    """A closed ring with a dent in its outside, and the dent."""
    ring = round_head.bone.voxels | round_head.lost.voxels
    dent = np.zeros_like(ring)
    dent[:, 40:51, 80:] = ring[:, 40:51, 80:]
    return round_head.bone.with_voxels(ring & ~dent), dent[PLANE]


def shown(ax):
    """The masks that are painted, by colour."""
    images = [np.asarray(image.get_array()) for image in ax.images]
    return {tuple(im[im[..., 3] > 0][0, :3]): im[..., 3] > 0 for im in images if im.ndim == 3 and im[..., 3].any()}


def test_figure_6_has_four_parts_and_a_zoom_below_each(round_head, dented, letters):
    bone, dent = dented
    figure = paper_figures.figure_6(round_head.ct, bone, PLANE, dent)
    assert letters(figure) == ["(a)", "(b)", "(c)", "(d)"] and len(figure.axes) == 8
    y, x = 1.5 * np.argwhere(dent).T
    for zoom in figure.axes[4:]:
        (left, right), (bottom, top) = zoom.get_xlim(), zoom.get_ylim()
        assert left < x.min() and x.max() < right and top < y.min() and y.max() < bottom


def test_figure_6_parts_hull_minus_bone_without_a_rest(round_head, dented):
    bone, dent = dented
    figure = paper_figures.figure_6(round_head.ct, bone, PLANE, dent)
    masks = shown(figure.axes[2])
    difference = convex_hull_image(bone.voxels[PLANE]) & ~bone.voxels[PLANE]
    kept = next(mask for colour, mask in masks.items() if np.allclose(colour, rgb_shares(PATCH)))
    np.testing.assert_array_equal(kept, dent)
    np.testing.assert_array_equal(sum(mask.astype(int) for mask in masks.values()), difference | dent)


def test_figure_7_zooms_into_its_last_slice(round_head, letters):
    head = round_head
    figure = paper_figures.figure_7([head.result] * 3, [0, 1, 2], head.bone, head.lost, head.lost)
    assert letters(figure) == ["(a)", "(b)", "(c)", "(d)"]
    *three, zoom = figure.axes
    assert len({(ax.get_xlim(), ax.get_ylim()) for ax in three}) == 1
    outline = zoom.collections[0]
    assert np.allclose(outline.get_edgecolor()[0, :3], rgb_shares(TRUTH))
    places = np.concatenate([path.vertices for path in outline.get_paths()])
    (left, right), (bottom, top) = zoom.get_xlim(), zoom.get_ylim()
    assert ((places > (left, top)) & (places < (right, bottom))).all()
    assert {line.get_label() for line in zoom.lines} >= {"outer balloon", "inner balloon"}
