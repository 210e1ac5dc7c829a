"""The renderer against closed forms: size, depth, who hides whom, colours, light, axes."""

import numpy as np
import pytest
from shapes import ball

from cranio_nb.drawing import shading
from cranio_nb.drawing.shading import Solid

RED, GREEN = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])


@pytest.mark.parametrize("towards", [(0, 0, 1), (1, 0, 0), (0.3, -0.8, 0.4), (0, 0, -1)])
def test_a_ball_looks_round_from_everywhere(towards):
    picture = shading.render([Solid(ball(), RED)], towards, px_mm=0.25)
    seen = np.isfinite(picture.depth)
    assert seen.sum() * picture.frame.px_mm**2 == pytest.approx(np.pi * 20**2, rel=0.02)
    assert picture.depth.max() == pytest.approx(20, abs=0.1)
    rows, cols = np.nonzero(seen)
    distance = np.hypot(rows - rows.mean(), cols - cols.mean()) * picture.frame.px_mm
    inside = distance < 18
    depth = picture.depth[rows, cols]
    np.testing.assert_allclose(depth[inside], np.sqrt(400 - distance[inside] ** 2), atol=0.6)


def test_no_pixel_is_missed_inside():
    picture = shading.render([Solid(ball(), RED)], (0.2, 0.5, 0.6), px_mm=0.11)
    rows, cols = np.indices(picture.depth.shape)
    middle = (np.array(picture.depth.shape) - 1) / 2
    inside = np.hypot(rows - middle[0], cols - middle[1]) * picture.frame.px_mm < 19
    assert np.isfinite(picture.depth[inside]).all()


def test_the_nearer_solid_hides_the_farther():
    near, far = Solid(ball((0, -40, 0), 10), RED), Solid(ball((0, 40, 0), 20), GREEN)
    for towards, middle in (((0, -1, 0), RED), ((0, 1, 0), GREEN)):
        picture = shading.render([near, far], towards, shaded=False)
        height, width = picture.depth.shape
        np.testing.assert_allclose(picture.rgb[height // 2, width // 2], middle, atol=1e-6)


def test_solids_drawn_one_by_one_make_the_same_picture():
    """The depth of each pixel is that of the nearer of two pictures, and so is its colour."""
    solids = Solid(ball((0, -40, 0), 10), RED), Solid(ball((3, 40, 0), 20), GREEN)
    whole = shading.render(solids, (0.2, -1, 0.1))
    axes = shading.view_axes((0.2, -1, 0.1))
    frame = shading.frame_around([solid.mesh for solid in solids], axes, px_mm=0.5)
    each = [shading.draw_solid(solid, frame) for solid in solids]
    picture = shading.nearest_of(each[::-1])
    np.testing.assert_array_equal(picture.depth, np.maximum(each[0].depth, each[1].depth))
    np.testing.assert_array_equal(picture.depth, whole.depth)
    np.testing.assert_array_equal(picture.rgb, whole.rgb)


def test_a_frame_holds_what_lies_within_its_margin():
    frame = shading.frame_around([ball(radius=20)], shading.view_axes((0, -1, 0)), px_mm=0.5, margin_mm=3.0)
    assert frame.holds(ball(radius=22.9)) and frame.holds(ball((0, -90, 2.9), 20))
    assert not frame.holds(ball((0, 0, 3.6), 20)) and not frame.holds(ball((-3.6, 0, 0), 20))


def test_unshaded_colours_are_exact_and_shaded_ones_darker():
    plain, lit = (shading.render([Solid(ball(), RED)], (0, -1, 0), shaded=s) for s in (False, True))
    seen = np.isfinite(plain.depth)
    np.testing.assert_allclose(plain.rgb[seen], np.broadcast_to(RED, (seen.sum(), 3)), atol=1e-6)
    assert (plain.rgb[~seen] == 1).all()
    assert lit.rgb[seen][:, 0].min() < 0.6 < lit.rgb[seen][:, 0].max() <= 1


def test_light_comes_from_the_upper_left():
    rgb = shading.render([Solid(ball(), RED)], (0, -1, 0)).rgb
    height, width = rgb.shape[:2]
    upper_left, lower_right = rgb[height // 4, width // 4, 0], rgb[-height // 4, -width // 4, 0]
    assert upper_left > lower_right + 0.2


def test_views_are_upright_as_a_viewer_meets_the_patient():
    np.testing.assert_allclose(shading.view_axes((0, -1, 0)), [[1, 0, 0], [0, 0, -1], [0, -1, 0]], atol=1e-12)
    np.testing.assert_allclose(shading.view_axes((1, 0, 0)), [[0, 1, 0], [0, 0, -1], [1, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(shading.view_axes((0, 0, 2)), [[-1, 0, 0], [0, 1, 0], [0, 0, 1]], atol=1e-12)


def test_a_place_is_told_its_pixel():
    """The node nearest to the viewer is where the picture is nearest."""
    mesh, towards = ball((3, -7, 11), 20), (0.3, -0.8, 0.4)
    picture, axes = shading.render([Solid(mesh, RED)], towards, px_mm=0.25), shading.view_axes(towards)
    nearest = mesh.vertices[np.argmax(mesh.vertices @ axes[2])]
    col, row = np.rint(picture.pixel_of(nearest)).astype(int)
    assert picture.depth[row, col] == pytest.approx(picture.depth.max(), abs=0.01)
    assert picture.depth[row, col] == pytest.approx(nearest @ axes[2], abs=0.01)
