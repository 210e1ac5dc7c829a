"""Panels: the picture follows the controls, and says what the stage computed; the static twin has alt text."""

import io
import json

import numpy as np
import pytest
from PIL import Image
from scipy import ndimage

from cranio_nb.curves import ChordFrame, GapEnds, cubic
from cranio_nb.drawing.canvas import BLUE, GREEN, Canvas, Window, rgb_of, round_length, windowed
from cranio_nb.drawing.described import described
from cranio_nb.errors import InputRefused
from cranio_nb.evaluation import scores
from cranio_nb.methods import slicewise
from cranio_nb.methods.catalogue import check_options, default_options
from cranio_nb.methods.you import method as you
from cranio_nb.pipeline import run
from cranio_nb.prosthesis import INNER, OUTER
from cranio_nb.stages import deformable_model, feature_extraction, segmentation
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets import inflation, tuning
from cranio_nb.vault import radius_measurement, symmetry
from cranio_nb.volume import Volume


@pytest.fixture
def live(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "widget")
    return pytest.importorskip("ipywidgets")


@pytest.fixture
def static(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "static")


@pytest.fixture(scope="session")
def ct(phantom):
    case = phantom()
    return Volume(case.hu, case.affine)


@pytest.fixture(scope="session")
def opening(openings):
    return openings()[0].sheet


@pytest.fixture(scope="session")
def arch():
    """A gap of 100 px whose tangents rise by 30 degrees at both ends."""
    rise = np.radians(30)
    tangents = [[-np.sin(rise), np.cos(rise)], [-np.sin(rise), -np.cos(rise)]]
    return GapEnds(np.array([[120.0, 60.0], [120.0, 160.0]]), np.array(tangents))


INSIDE = (200.0, 110.0)


def pixels_of(panel):
    """The picture on the widget, decoded."""
    return np.asarray(Image.open(io.BytesIO(panel.front.image.value)).convert("RGB"))


def close(jpeg, rgb):
    return jpeg.shape == rgb.shape and np.abs(jpeg.astype(int) - rgb).mean() < 1.5


def count(rgb, colour):
    return int((np.abs(rgb.astype(int) - rgb_of(colour)).max(axis=-1) < 12).sum())


@pytest.mark.parametrize(("asked", "found"), [("static", "static"), ("widget", "widget"), ("auto", "static")])
def test_the_mode_is_what_was_asked_and_static_without_a_front_end(monkeypatch, asked, found):
    monkeypatch.setenv("CRANIO_NB_MODE", asked)
    assert widgets.mode() == found


def test_an_unknown_mode_is_refused(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "movie")
    with pytest.raises(InputRefused, match="static, widget, auto"):
        widgets.mode()


def middle_plane(opening):
    return int(np.median(np.flatnonzero(opening.voxels.any((1, 2)))))


def make_all(ct, skull, opened, arch, made, true):
    opening = opened.sheet
    return {
        "ct_viewer": widgets.ct_viewer(ct),
        "threshold": widgets.threshold(ct),
        "features": widgets.features(skull, middle_plane(opening), opening=opening),
        "balloon": widgets.balloon(arch, INSIDE),
        "patch": widgets.patch(skull, opened),
        "surface": widgets.surface(made.patch),
        "evaluation": widgets.evaluation(made, true),
        "guiding_points": widgets.guiding_points(skull, opened, true),
        "symmetry_plane": widgets.symmetry_plane(skull, opened),
        "bent_plate": widgets.bent_plate(skull, opened, true),
        "elastic_sheet": widgets.elastic_sheet(skull, opened, true),
    }


@pytest.fixture(scope="session")
def design(skull, openings):
    return slicewise.design(skull(), openings(), directions=1)


@pytest.fixture(scope="session")
def true(phantom, skull, openings, design):
    return run.check_truth(design, skull().with_voxels(phantom().implant), skull(), openings()[0]).prosthesis


@pytest.fixture(scope="session")
def again(ct, skull, openings, arch, design, true):
    return lambda: make_all(ct, skull(), openings()[0], arch, design, true)


@pytest.fixture(scope="session")
def panels(again):
    """One panel of each kind, made once; tests may leave controls moved."""
    return again()


def test_every_static_panel_is_one_picture_with_alt_text_and_one_line(static, panels):
    for name, panel in panels.items():
        data, metadata = panel._repr_mimebundle_()
        assert set(data) == {"image/png", "text/plain"}, name
        shape = np.asarray(Image.open(io.BytesIO(data["image/png"]))).shape
        assert shape == panel.view.rgb.shape and metadata["image/png"]["width"] == shape[1]
        assert len(metadata["image/png"]["alt"]) > 40 and "\n" not in data["text/plain"], name


def test_a_static_panel_is_the_same_on_every_run_and_makes_no_widget(static, panels, again):
    first, second = ({n: p._repr_mimebundle_()[0] for n, p in some.items()} for some in (panels, again()))
    assert first == second
    assert not any("front" in vars(panel) for panel in panels.values())


def test_a_live_panel_shows_the_pure_picture_of_its_controls(live, panels):
    moves = {"ct_viewer": ("width", 400), "threshold": ("hu", 900), "features": ("reach", 25.0), "balloon": ("n", 41)}
    moves |= {"patch": ("curves", False), "surface": ("steps", 0), "evaluation": ("side", "inner")}
    moves |= {"guiding_points": ("n", 5), "symmetry_plane": ("turn", 4.0)}
    moves |= {"bent_plate": ("second", 9.0), "elastic_sheet": ("step", 1)}
    for name, panel in panels.items():
        assert close(pixels_of(panel), panel.view.rgb), name
        before = panel.front.image.value
        control, value = moves[name]
        panel.front.controls[control].value = value
        assert panel.front.image.value != before, name
        assert panel.values[control] == value
        assert close(pixels_of(panel), panel._picture(**panel.values).rgb), name


def test_every_control_is_labelled_and_within_its_limits(live, panels):
    for panel in panels.values():
        for name, widget in panel.front.controls.items():
            assert widget.description and widget.tabbable is not False, name
            if hasattr(widget, "max"):
                assert widget.min <= widget.value <= widget.max


def test_a_live_bundle_has_widget_picture_and_line(live, panels):
    data, _ = panels["threshold"]._repr_mimebundle_()
    assert {"application/vnd.jupyter.widget-view+json", "image/png", "text/plain"} <= set(data)


def test_a_grey_window_is_black_and_white_at_its_ends():
    level = windowed(np.array([[-51.0, -50.0, 50.0, 150.0, 151.0]]), 50, 200)
    np.testing.assert_array_equal(level[0, :, 0], [0, 0, 127, 255, 255])


def test_the_threshold_line_counts_the_bone_of_the_slice(static, ct):
    panel = widgets.threshold(ct).set(hu=700, max_hole=0, plane=25)
    area = np.count_nonzero(segmentation.apply_threshold(ct.voxels[25], 700)) * np.prod(ct.spacing[1:]) / 100
    assert f"{area:.1f} cm" in panel.view.line


def test_holes_filled_are_drawn_green(static):
    hu = np.full((1, 60, 60), 1000, np.int16)
    hu[0, :8] = hu[0, -8:] = hu[0, :, :8] = hu[0, :, -8:] = hu[0, 28:32, 28:32] = -1000
    ct = Volume(hu, np.diag([1.0, 1, 1, 1])[[2, 1, 0, 3]])
    legend = count(widgets.threshold(ct).set(max_hole=0).view.rgb, GREEN)
    hole = count(widgets.threshold(ct).set(max_hole=20).view.rgb, GREEN) - legend
    assert hole == pytest.approx(16 * (512 / 60) ** 2, rel=0.1)


def test_the_features_line_counts_the_points_of_the_stage(static, skull, opening):
    bone, plane, px = skull(), middle_plane(opening), float(skull().spacing[1])
    panel = widgets.features(bone, plane, opening=opening).set(skip=5.0, reach=12.0)
    seen = feature_extraction.extract_features(bone.voxels[plane])
    ends = feature_extraction.find_gap_ends(seen, opening.voxels[plane], skip_px=5 / px, reach_px=12 / px)
    width = np.hypot(*np.diff(ends[0].points, axis=0)[0]) * px
    assert f"{width:.1f} mm apart" in panel.view.line


def test_a_slice_without_a_gap_says_so(static, skull, opening):
    line = widgets.features(skull(), 2, opening=opening).view.line
    assert line.startswith("Slice 2: ") and "carry" not in line


def settings(panel):
    return {name: value for name, value in panel.values.items() if name != "step"}


@pytest.mark.parametrize("k", [0.0, 0.062, 0.3])
def test_moving_k_moves_the_balloon_as_the_stage_says(live, arch, k):
    panel = widgets.balloon(arch, INSIDE)
    panel.front.controls["pressure"].value = k
    rise = np.radians(30)
    start = cubic(100.0, rise, np.pi - rise, 21)
    slopes = np.array([[5.0, 5 * np.tan(rise)], [5.0, -5 * np.tan(rise)]])
    curve = deformable_model.inflate(start, slopes, pressure=k).curve
    assert f"apex {curve[:, 1].max():.1f} px" in panel.view.line
    window = Window.around((0, 0, 512, 512), [48, 48], [162, 172])
    at = window.px(ChordFrame.of(arch, INSIDE).to_slice(curve))[5:-5].round().astype(int)
    shown = pixels_of(panel)
    assert all(count(shown[y - 1 : y + 2, x - 1 : x + 2], BLUE) for x, y in at)


def test_a_balloon_that_sinks_below_its_chord_says_how_far(static, arch):
    panel = widgets.balloon(arch, INSIDE)
    assert "px above the chord" in panel.view.line
    panel.set(pressure=-0.1)
    rise = np.radians(30)
    low = inflation.inflation(100.0, (rise, np.pi - rise), *list(panel.values.values())[:-1]).curves[-1][:, 1].min()
    assert low < -1 and f"px above and {-low:.1f} px below the chord" in panel.view.line


def test_all_steps_are_kept_and_the_last_is_at_rest(arch):
    run = inflation.inflation(100.0, (0.5, 2.6), inflation.PRESETS[0], 0.062, 21, 1.0, 1.0, 1.0, 1e-3)
    assert run.converged and len(run.curves) == len(run.change) + 1
    np.testing.assert_allclose(np.linalg.norm(np.diff(run.curves, axis=0), axis=(1, 2)), run.change, rtol=1e-9)
    assert run.change[-1] <= 1e-3 < run.change[-2]


def test_a_spiral_between_equal_angles_is_an_arc_from_the_start():
    run = inflation.inflation(100.0, (0.5, np.pi - 0.5), inflation.PRESETS[2], 0.0, 41, 1.0, 1.0, 1.0, 1e-3)
    radius = 50 / np.sin(0.5)
    off = np.hypot(*(run.curves[0] - [50, -radius * np.cos(0.5)]).T) - radius
    assert np.abs(off).max() < 1e-6


def test_the_player_follows_the_number_of_steps(live, arch):
    panel = widgets.balloon(arch, INSIDE)
    step = panel.front.controls["step"]
    assert step.value == step.max
    few = step.max
    panel.front.controls["dt"].value = 10.0
    assert step.value == step.max < few
    panel.front.controls["dt"].value = 1.0
    assert step.value == step.max == few  # who stood at rest stays at rest
    step.value = 3
    panel.front.controls["pressure"].value = 0.1
    assert step.value == 3 and panel.view.line.startswith("Step 3 of ")


def test_the_end_pressure_leaves_k_without_effect(live, arch):
    panel = widgets.balloon(arch, INSIDE)
    panel.front.controls["preset"].value = inflation.PRESETS[1]
    assert panel.front.controls["pressure"].disabled
    before = panel.view.rgb
    panel.set(pressure=0.2)
    assert (panel.view.rgb == before).all()


def test_the_patch_of_a_slice_is_what_fill_and_hull_say(static, skull, openings):
    stack = widgets.stack.fill_slices(skull(), openings()[0], widgets.stack.PRESSURES[1])
    made = slicewise.design(skull(), openings(), **slicewise.paper_options(skull())).patch.voxels
    own = stack.patches & ~made[stack.first : stack.first + len(stack.slices)]
    assert own.sum() <= 0.02 * stack.patches.sum()  # all but loose crumbs
    panel = widgets.patch(skull(), openings()[0]).set(pressure=widgets.stack.PRESSURES[1])
    at = panel.values["plane"] - stack.first
    assert f"patch of {stack.areas[at]:.0f} mm" in panel.view.line and stack.areas[at] > 0


def test_unsmoothed_vertices_have_not_moved_and_smoothed_stay_in_their_voxel(static, design):
    panel = widgets.surface(design.patch)
    assert "0.00 mm on average, 0.00 mm at most" in panel.set(steps=0).view.line
    most = float(panel.set(steps=30).view.line.split(" mm at most")[0].split()[-1])
    assert 0 < most <= np.linalg.norm(design.patch.spacing) / 2 + 0.005


def test_the_evaluation_line_counts_nodes(static, design, true):
    panel = widgets.evaluation(design, true).set(side="inner", limit=0.4)
    distances = scores.surface_distance(design.surface(INNER).vertices, true.surface(INNER))
    assert f"{100 * (distances <= 0.4).mean():.0f} % of the nodes lie within 0.4 mm" in panel.view.line
    assert f"max {distances.max():.2f} mm" in panel.view.line


def test_the_map_of_distances_shows_the_distances_of_the_nodes(design, true):
    seen = widgets.solid.distance_map(design, true, INNER)
    shown = seen.seen[np.isfinite(seen.seen)]
    assert 0 <= shown.min() and shown.max() <= seen.distances.max() + 1e-6
    assert np.median(shown) == pytest.approx(np.median(seen.distances), rel=0.3)


def test_guiding_points_say_what_the_method_fills(static, skull, openings, true):
    panel = widgets.guiding_points(skull(), openings()[0], true).set(n=8)
    made = you.fill_between(
        skull(), openings()[0], you.find_guides(radius_measurement.measure_around(skull(), openings()[0]), 8)
    )
    off = scores.surface_distance(made.outer.mesh.vertices, true.surface(OUTER))
    assert panel.view.line.startswith("8 guiding points: ")
    assert f"{off.mean():.2f} mm from the true surface on average, {off.max():.2f} mm at most" in panel.view.line


def test_guiding_points_need_no_truth(static, skull, openings):
    line = widgets.guiding_points(skull(), openings()[0]).view.line
    assert line.startswith("12 guiding points") and "true" not in line


def test_the_found_plane_has_the_least_residual(static, skull, openings):
    found = symmetry.find_symmetry_plane(skull(), openings()[0].head_centre)
    panel = widgets.symmetry_plane(skull(), openings()[0])
    moves = ({}, {"turn": 4.0}, {"turn": 0.0, "lean": -5.0}, {"lean": 0.0, "shift": 3.0})
    lines = [panel.set(**move).view.line for move in moves]
    least, *others = (float(line.split("residual ")[1].split(" mm")[0]) for line in lines)
    assert least == pytest.approx(found.residual, abs=0.01)
    assert all(other > 2 * least for other in others)


def test_a_plane_shifted_by_one_mm_moves_the_image_by_two(skull, openings):
    centre = openings()[0].head_centre
    found, surface = symmetry.find_symmetry_plane(skull(), centre), symmetry.measure_outer_surface(skull(), centre)
    other = widgets.rivals.moved(found, surface, turn=0.0, lean=0.0, shift=1.0)
    np.testing.assert_allclose(other.mirror(centre) - found.mirror(centre), 2 * found.normal, atol=1e-9)


def error_of(line):
    return float(line.split("rms ")[1].split(" mm")[0])


def test_a_plate_that_is_held_by_nothing_errs_most(static, skull, openings, true):
    panel = widgets.bent_plate(skull(), openings()[0], true)
    bent = error_of(panel.view.line)
    assert bent < 1.0 < error_of(panel.set(second=0.0, third=0.0, mirror=0.0).view.line)


def test_the_hole_of_a_coarse_chart_holds_the_hole_and_nothing_far_from_it(skull, openings):
    fine = radius_measurement.measure_around(skull(), openings()[0])
    vault = widgets.plates.coarse(fine, 3)
    start = (len(fine.hole) // 2) % 3
    assert vault.hole[fine.hole[start::3, start::3]].all()
    grown = ndimage.binary_dilation(fine.hole, np.ones((3, 3)))[start::3, start::3]
    assert not (vault.hole & ~grown).any()


def test_panels_of_plates_need_no_truth(static, skull, openings):
    for panel in (widgets.bent_plate, widgets.elastic_sheet):
        assert "in the hole" not in panel(skull(), openings()[0]).view.line


def test_mass_and_friction_do_not_move_the_place_of_rest(skull, openings):
    vault = widgets.plates.coarse(radius_measurement.measure_around(skull(), openings()[0]), 4)
    ways = [widgets.plates.relaxing(vault, 40.0, mass, damping) for mass, damping in ((0.0, 1.0), (3.0, 2.0))]
    first, second = (way.motions[-1].sheet.control for way in ways)
    assert all(way.motions[-1].converged for way in ways)
    np.testing.assert_allclose(first, second, atol=0.2)
    for way in ways:
        energy = [motion.energy for motion in way.motions]
        assert (np.diff(energy) <= 1e-9 * energy[0]).all()


def test_the_step_of_a_sheet_is_kept_within_its_way(static, skull, openings, true):
    panel = widgets.elastic_sheet(skull(), openings()[0], true)
    last = panel.view.limits["step"]
    assert panel.view.line.startswith(f"Step {last} of {last}, at rest")
    assert panel.set(step=0).view.line.startswith(f"Step 0 of {last}, not at rest")


def test_the_tuner_hands_its_parameters_to_the_design_command(static, phantom, tmp_path):
    panel = widgets.tuner(phantom()).set(slices=tuning.SLICES[0], reach=20.0, own=True, pressure=0.5)
    check_options("slicewise", panel.parameters)
    assert json.loads(panel.save(tmp_path / "p.json").read_text()) == panel.parameters
    assert panel.parameters["axial"] and panel.parameters["pressure"] == 0.5
    case = phantom()
    bone = Volume(case.bone, case.affine)
    made = slicewise.design(bone, **panel.parameters)
    dice = scores.dice(made.patch, bone.with_voxels(case.implant))
    assert panel.view.line.startswith(f"DSC {dice:.3f}")


def test_the_tuner_starts_at_the_defaults(static, phantom):
    wanted = default_options("slicewise")
    assert all(wanted[name] == value for name, value in widgets.tuner(phantom()).parameters.items())


def test_a_panel_refuses_a_control_it_does_not_have(static, arch):
    with pytest.raises(InputRefused, match="pressure"):
        widgets.balloon(arch, INSIDE).set(kk=1)


def test_of_many_waiting_calls_only_the_last_is_made(live):
    import asyncio

    from cranio_nb.teaching.widgets.live import Latest

    done, wanted = [], []
    later = Latest(lambda: done.append(wanted[-1]))

    async def flood():
        for i in range(50):
            wanted.append(i)
            later()
        await asyncio.sleep(0.1)

    asyncio.run(flood())
    assert done == [0, 49]


def test_a_static_twin_wants_words(static):
    twin = described(np.zeros((4, 6, 3), np.uint8), "A black box.", "black")
    data, metadata = twin._repr_mimebundle_()
    assert data["image/png"][:4] == b"\x89PNG" and metadata["image/png"]["alt"] == "A black box."
    with pytest.raises(InputRefused):
        described(b"", " ", "line")


def test_a_canvas_puts_a_slice_where_its_window_says():
    rgb = np.zeros((40, 60, 3), np.uint8)
    rgb[10, 20] = 255
    canvas, window = Canvas(240, 160), Window.whole((0, 0, 240, 160), rgb.shape)
    canvas.show(rgb, window)
    y, x = np.argwhere(canvas.array()[..., 0] > 128).mean(axis=0)
    np.testing.assert_allclose(window.px([10, 20]), [x + 0.5, y + 0.5], atol=0.6)


@pytest.mark.parametrize(("longest", "length"), [(0.9, 0.5), (7.0, 5.0), (10.0, 10.0), (49.0, 20.0)])
def test_round_lengths(longest, length):
    assert round_length(longest) == length
