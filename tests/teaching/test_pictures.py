"""Pictures of the lessons: what is drawn lies where its mm say, in the colours that mean it."""

import numpy as np
import pytest
from cut_texts import cut_texts
from shapes import cube

from cranio_nb.drawing.palette import rgb_of
from cranio_nb.mesh import Mesh
from cranio_nb.teaching import pictures
from cranio_nb.volume import Volume

PX = 0.5


def colours_of(ax):
    """The colour that is on top at each pixel of the masks drawn, shape (R, C, 3), 0 to 255; white where none is."""
    seen = 255 * np.ones((*ax.images[0].get_array().shape[:2], 3))
    for image in ax.images:
        rgba = np.asarray(image.get_array())
        seen[rgba[..., 3] > 0] = 255 * rgba[rgba[..., 3] > 0][:, :3]
    return seen.round().astype(int)


def test_a_mask_lies_where_its_points_lie():
    mask = np.zeros((20, 30), bool)
    mask[8, 21] = True
    _, (ax,) = pictures.axes()
    pictures.show_mask(ax, mask, px=PX, meaning="patch")
    pictures.show_points(ax, np.argwhere(mask), px=PX, colour=pictures.BLUE)
    left, right, bottom, top = ax.images[0].get_extent()
    x, y = ax.lines[0].get_xydata()[0]
    assert (left + (21 + 0.5) * PX, top + (8 + 0.5) * PX) == pytest.approx((x, y))
    assert (right - left, bottom - top) == pytest.approx((30 * PX, 20 * PX))


def test_errors_are_told_apart_by_colour():
    bone, missing, patch = (np.zeros((10, 10), bool) for _ in range(3))
    bone[0], missing[2:5], patch[4:7] = True, True, True
    _, (ax,) = pictures.axes()
    pictures.show_errors(ax, patch, missing, bone, px=PX, title="")
    wanted = {0: "bone", 2: "missing", 4: "right", 6: "extra"}
    for row, meaning in wanted.items():
        assert tuple(colours_of(ax)[row, 5]) == rgb_of(pictures.MASKS[meaning][0]), meaning


def test_what_a_picture_of_errors_shows_is_named_below_it():
    bone, missing, patch = (np.zeros((10, 10), bool) for _ in range(3))
    figure, panels = pictures.axes(2)
    for ax in panels:
        pictures.show_errors(ax, patch, missing, bone, px=PX, title="")
    pictures.key(figure)
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert names == [pictures.MASKS[meaning][1] for meaning in ("bone", "right", "missing", "extra")]


def test_slices_of_a_head_have_sides_and_scale_and_keep_their_window():
    flipped = Volume(np.zeros((2, 20, 30), bool), np.array([[0, 0, -1.0, 0], [0, 1, 0, 0], [2, 0, 0, 0], [0, 0, 0, 1]]))
    _, (ax,) = pictures.slices(1, flipped, around=[np.array([[5, 10], [9, 20]])], margin_mm=3)
    pictures.show_mask(ax, flipped.voxels[0], px=1.0)
    assert ax.get_xlim() == (7, 23) and ax.get_ylim() == (12, 2)
    assert {text.get_text() for text in ax.texts} == {"L", "R", "A", "P", "2 mm"}
    assert {t.get_text(): t.get_position()[0] for t in ax.texts}["R"] > 0.9


def test_lines_are_told_apart_without_colour():
    assert len({style for _, style in pictures.LINES[:4]}) == 4
    _, (ax,) = pictures.axes()
    pictures.plot_lines(ax, [0, 1], {"a": [0, 1], "b": [1, 0]}, xlabel="x", ylabel="y")
    assert [line.get_linestyle() for line in ax.lines] == ["-", "--"]


def test_a_mesh_is_as_large_as_its_pixels_say():
    square = Mesh(np.array([[0.0, 0, 0], [0, 20, 0], [0, 20, 10], [0, 0, 10]]), np.array([[0, 1, 2], [0, 2, 3]]))
    _, (ax,) = pictures.axes()
    pictures.show_meshes(ax, [(square, pictures.BLUE)], (1, 0, 0), title="", px=0.25, shaded=False)
    seen = np.asarray(ax.images[0].get_array())
    drawn = np.argwhere((seen < 0.98).any(axis=2))
    assert np.ptp(drawn, axis=0) + 1 == pytest.approx([10 / 0.25, 20 / 0.25], abs=2)
    assert {text.get_text() for text in ax.texts} == {"A", "P", "S", "I", "5 mm"}


def test_a_curve_and_a_slice_of_hu_share_their_axes():
    _, (ax,) = pictures.axes()
    pictures.show_hu(ax, np.zeros((20, 30)), px=PX, centre=100, width=400)
    pictures.show_curve(ax, [[0, 0], [19, 29]], px=PX, line=1)
    assert ax.images[0].get_clim() == (-100, 300)
    np.testing.assert_allclose(ax.lines[0].get_xydata(), [[0, 0], [14.5, 9.5]])


@pytest.mark.parametrize("height", [2.0, 3.2, 4.2])
@pytest.mark.parametrize("n", [1, 3, 4])
def test_no_word_of_a_picture_is_cut_however_high_it_is(n, height):
    figure, panels = pictures.slices(
        n, Volume(np.zeros((2, 100, 80), bool), np.diag([2, 0.5, 0.5, 1.0])), height=height
    )
    for ax in panels:
        pictures.show_mask(ax, np.zeros((100, 80), bool), px=PX, title="raw, slightly")
    pictures.key(figure)
    assert cut_texts(figure) == []


@pytest.mark.parametrize("height", [2.6, 4.4])
def test_no_word_of_a_picture_of_meshes_is_cut(height):
    figure, panels = pictures.axes(2, height=height)
    for ax in panels:
        pictures.show_meshes(ax, [(cube(30), pictures.BLUE)], (1, 0.3, 0.4), title="raw, slightly")
    assert cut_texts(figure) == []
