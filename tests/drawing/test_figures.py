"""Pictures: the renderer against closed forms, and that drawings show what they claim, at the scale they claim."""

import subprocess
import sys

import numpy as np
import pytest
from skimage.measure import marching_cubes

from cranio_nb.curves import GapEnds
from cranio_nb.drawing import figures, shading
from cranio_nb.drawing.shading import Solid
from cranio_nb.mesh import Mesh
from cranio_nb.methods.slicewise.slices import SlicedDesign, SliceResult
from cranio_nb.opening import Opening
from cranio_nb.vault import slicing
from cranio_nb.volume import Volume

RED, GREEN = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])


def ball(centre=(0.0, 0.0, 0.0), radius: float = 20.0) -> Mesh:
    axis = np.arange(-radius - 3, radius + 4)
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    vertices, faces, _, _ = marching_cubes(np.sqrt(x**2 + y**2 + z**2), radius, gradient_direction="ascent")
    mesh = Mesh(vertices + axis[0] + np.array(centre), faces.astype(np.intp))
    return mesh if mesh.volume > 0 else Mesh(mesh.vertices, mesh.faces[:, ::-1])


@pytest.mark.parametrize("towards", [(0, 0, 1), (1, 0, 0), (0.3, -0.8, 0.4), (0, 0, -1)])
def test_a_ball_looks_round_from_everywhere(towards):
    picture = shading.render([Solid(ball(), RED)], towards, px=0.25)
    seen = np.isfinite(picture.depth)
    assert seen.sum() * picture.px**2 == pytest.approx(np.pi * 20**2, rel=0.02)
    assert picture.depth.max() == pytest.approx(20, abs=0.1)
    rows, cols = np.nonzero(seen)
    distance = np.hypot(rows - rows.mean(), cols - cols.mean()) * picture.px
    inside = distance < 18
    depth = picture.depth[rows, cols]
    np.testing.assert_allclose(depth[inside], np.sqrt(400 - distance[inside] ** 2), atol=0.6)


def test_no_pixel_is_missed_inside():
    picture = shading.render([Solid(ball(), RED)], (0.2, 0.5, 0.6), px=0.11)
    rows, cols = np.indices(picture.depth.shape)
    middle = (np.array(picture.depth.shape) - 1) / 2
    inside = np.hypot(rows - middle[0], cols - middle[1]) * picture.px < 19
    assert np.isfinite(picture.depth[inside]).all()


def test_the_nearer_solid_hides_the_farther():
    near, far = Solid(ball((0, -40, 0), 10), RED), Solid(ball((0, 40, 0), 20), GREEN)
    for towards, middle in (((0, -1, 0), RED), ((0, 1, 0), GREEN)):
        picture = shading.render([near, far], towards, shaded=False)
        height, width = picture.depth.shape
        np.testing.assert_allclose(picture.rgb[height // 2, width // 2], middle, atol=1e-6)


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


def test_views_stand_as_a_viewer_meets_the_patient():
    np.testing.assert_allclose(shading.view_axes((0, -1, 0)), [[1, 0, 0], [0, 0, -1], [0, -1, 0]], atol=1e-12)
    np.testing.assert_allclose(shading.view_axes((1, 0, 0)), [[0, 1, 0], [0, 0, -1], [1, 0, 0]], atol=1e-12)
    np.testing.assert_allclose(shading.view_axes((0, 0, 2)), [[-1, 0, 0], [0, 1, 0], [0, 0, 1]], atol=1e-12)


def shell(spacing: tuple[float, float, float]) -> Volume:
    """A hollow ball of radii 40 and 34 mm about the world's origin."""
    shape = [int(100 / s) for s in spacing]
    affine = np.eye(4)
    affine[:3, :3] = np.array([[0, 0, spacing[2]], [0, spacing[1], 0], [spacing[0], 0, 0]])
    affine[:3, 3] = [-50.0, -50.0, -50.0]
    grid = Volume(np.zeros(shape, bool), affine)
    radius = np.linalg.norm(grid.to_world(np.moveaxis(np.indices(shape), 0, -1)), axis=-1)
    return grid.with_voxels((radius < 40) & (radius > 34))


@pytest.mark.parametrize("spacing", [(1.0, 0.5, 0.5), (2.5, 0.5, 0.5), (3.0, 1.75, 1.75)])
def test_coarse_skull_stays_where_it_is(spacing):
    mesh = shading.skull_surface(shell(spacing))
    radius = np.linalg.norm(mesh.vertices, axis=1)
    outer = radius[radius > 37]
    away = np.abs(mesh.vertices[radius > 37][:, 2]) < 30
    assert np.abs(outer[away] - 40).mean() < 0.7 and mesh.volume > 0
    cut = shading.skull_surface(shell(spacing), floor=5.0)
    assert cut.vertices[:, 2].min() > 5.0 - spacing[0]
    assert len(shading.skull_surface(shell(spacing), floor=500.0).faces) == 0


def test_three_views_show_the_opening():
    views = figures.views_of([(0.9, 0.1, 0.4)])
    assert list(views) == ["facing the opening", "from the left", "from above"]
    np.testing.assert_allclose(views["facing the opening"], (0.9, 0.1, 0.4))
    assert list(figures.views_of([(1, 0, 0), (-0.9, 0, 0.1), (-0.9, 0, 0.1)]))[1] == "from the right"
    three = figures.views_of([(0.8, 0, 0.6), (-0.4, 0.8, 0.4), (0, -1, 0)])
    assert set(three) == {"facing the opening", "from the front", "from the back"}


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
    assert np.median(outer.get_ydata()) == pytest.approx(15, abs=0.36) and outer.get_color() == figures.OUTER_COLOUR
    assert np.median(inner.get_ydata()) == pytest.approx(19.5, abs=0.36) and inner.get_color() == figures.INNER_COLOUR


@pytest.mark.parametrize("plane", [0, 1, 2])
@pytest.mark.parametrize("skeleton", [False, True])
def test_every_kind_of_slice_can_be_drawn(sliced, bone, patch, plane, skeleton):
    figure = figures.slice_figure(sliced, sliced.slices[plane], bone, patch, skeleton=skeleton)
    assert figures.png(figure).startswith(b"\x89PNG")


def test_distance_map_has_the_colours_of_its_scale():
    mesh = ball()
    figure = figures.distance_figure(mesh, mesh, np.full(len(mesh.vertices), 1.0), (0, -1, 0), 2.0)
    shown = np.asarray(figure.axes[0].images[0].get_array())
    middle = shown[shown.shape[0] // 2, shown.shape[1] // 2]
    np.testing.assert_allclose(middle, figures.colour_scale(2.0).to_rgba(1.0)[:3], atol=0.01)
    assert "mm" in figure.axes[0].texts[-1].get_text()


def test_view_names_the_patients_sides():
    figure = figures.view_figure(ball(radius=30), ball((0, -25, 0), 8), (0, -1, 0))
    places = {t.get_text(): t.get_position() for t in figure.axes[0].texts}
    assert places["L"][0] > places["R"][0] and "S" in places and "50 mm" in places
    bar = figure.axes[0].lines[-1].get_xdata()
    assert np.ptp(bar) * 0.6 == pytest.approx(50)


def test_pictures_leave_no_global_state():
    modules = "cranio_nb.drawing.figures, cranio_nb.output.design_page"
    code = f"import sys, {modules}; sys.exit('matplotlib.pyplot' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], timeout=60, check=False).returncode == 0


def test_lines_over_each_other_are_told_apart():
    styles = [figures.line_style(i) for i in range(49)]
    assert len(set(styles)) == 49
    assert len({dashes for _, dashes in styles[:7]}) == len({colour for colour, _ in styles[:7]}) == 7
