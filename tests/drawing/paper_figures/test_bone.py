"""Figures 1 to 3: parts, and what lies on the boundary."""

import numpy as np

from cranio_nb.drawing import figures, paper_figures
from cranio_nb.drawing.palette import INNER, OUTER, TANGENT, rgb_shares

PLANE = 1
WHOLE = 0


def painted(ax, colour):
    """Pixels painted in a colour, as a mask."""
    images = [np.asarray(image.get_array()) for image in ax.images]
    same = [im for im in images if im.ndim == 3 and np.allclose(im[im[..., 3] > 0][:, :3], rgb_shares(colour))]
    return same[-1][..., 3] > 0


def test_figure_1_is_a_slice_and_its_bone(round_head, letters):
    figure = paper_figures.figure_1(round_head.ct, round_head.bone, PLANE)
    assert letters(figure) == ["(a)", "(b)"]
    np.testing.assert_array_equal(figure.axes[0].images[0].get_array(), round_head.ct.voxels[PLANE])
    np.testing.assert_array_equal(figure.axes[1].images[0].get_array()[..., 3] > 0, round_head.bone.voxels[PLANE])


def test_figure_2_zooms_on_an_end_of_the_bone(round_head):
    figure = paper_figures.figure_2(round_head.bone, PLANE)
    whole, zoom = figure.axes
    spine = next(line for line in zoom.lines if line.get_label() == "skeleton").get_xydata()
    (left, right), (bottom, top) = zoom.get_xlim(), zoom.get_ylim()
    assert left < spine[-1, 0] < right and top < spine[-1, 1] < bottom
    assert [line.get_label() for line in whole.lines].count("skeleton") == 1
    assert figures.png(figure).startswith(b"\x89PNG")


def test_figure_3_parts_outer_from_inner_and_shows_both_ends(round_head, letters):
    head = round_head
    figure = paper_figures.figure_3(head.bone, PLANE, head.result.ends)
    whole, first, second = figure.axes
    assert letters(figure) == ["(a)"]
    from_centre = {
        colour: np.linalg.norm(np.argwhere(painted(whole, colour)) - 45, axis=1) for colour in (OUTER, INNER)
    }
    assert np.median(from_centre[OUTER]) > 37 and np.median(from_centre[INNER]) < 33
    for i, zoom in enumerate((first, second)):
        for ends in head.result.ends:
            y, x = 1.5 * ends.points[i]
            assert zoom.get_xlim()[0] < x < zoom.get_xlim()[1] and zoom.get_ylim()[1] < y < zoom.get_ylim()[0]


def test_a_tangent_line_runs_through_its_end_along_the_tangent(round_head):
    head = round_head
    figure = paper_figures.figure_3(head.bone, PLANE, head.result.ends)
    lines = [line.get_xydata() for line in figure.axes[WHOLE].lines if line.get_color() == TANGENT]
    points, tangents = (np.concatenate([getattr(e, name) for e in head.result.ends]) for name in ("points", "tangents"))
    for line, point, tangent in zip(lines, points, tangents, strict=True):
        np.testing.assert_allclose(line.mean(axis=0), 1.5 * point[::-1])
        along = np.diff(line, axis=0)[0] / 30.0
        np.testing.assert_allclose(along, tangent[::-1], atol=1e-9)
