"""The balloon panel moves as the stage says; its steps end at rest."""

import numpy as np
import pytest
from panels import INSIDE, count, move, pixels_of

from cranio_nb.curves import ChordFrame, GapEnds, cubic
from cranio_nb.drawing.palette import BLUE, BONE, TRUTH, faded, rgb_of
from cranio_nb.stages import deformable_model
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets import deformable_model as panel_module
from cranio_nb.teaching.widgets import inflation


@pytest.mark.parametrize("k", [0.0, 0.062, 0.3])
def test_moving_k_moves_the_balloon_as_the_stage_says(live, arch, k):
    panel = widgets.balloon(arch, INSIDE).set(step=300)
    move(panel, pressure=k)
    rise = np.radians(30)
    start = cubic(100.0, rise, np.pi - rise, 21)
    slopes = np.array([[5.0, 5 * np.tan(rise)], [5.0, -5 * np.tan(rise)]])
    curve = deformable_model.inflate(start, slopes, pressure=k).curve
    assert f"apex {curve[:, 1].max():.1f} px" in panel.view.line
    scene = panel_module.Scene(arch, ChordFrame.of(arch, INSIDE), None, None, None)
    at = scene.place(curve)[5:-5].round().astype(int)
    shown = pixels_of(panel)
    assert all(count(shown[y - 1 : y + 2, x - 1 : x + 2], BLUE) for x, y in at)


def test_a_balloon_that_sinks_below_its_chord_says_how_far(static, arch):
    panel = widgets.balloon(arch, INSIDE)
    assert "px above the chord" in panel.view.line
    panel.set(pressure=-0.1, step=300)
    rise = np.radians(30)
    low = (
        inflation.record_inflation(100.0, (rise, np.pi - rise), *list(panel.values.values())[:-1])
        .curves[-1][:, 1]
        .min()
    )
    assert low < -1 and f"px above and {-low:.1f} px below the chord" in panel.view.line


def test_the_player_follows_the_number_of_steps(live, arch):
    panel = widgets.balloon(arch, INSIDE)
    shown = panel.front.widget
    many = shown.limits["step"]
    assert shown.values["step"] == 0 < many
    move(panel, step=many)
    move(panel, dt=10.0)
    assert shown.values["step"] == shown.limits["step"] < many
    move(panel, dt=1.0)
    assert shown.values["step"] == shown.limits["step"] == many  # who stood at rest stays at rest
    move(panel, step=3)
    move(panel, pressure=0.1)
    assert shown.values["step"] == 3 and panel.view.line.startswith("Step 3 of ")


def test_the_end_pressure_leaves_k_without_effect(live, arch):
    panel = widgets.balloon(arch, INSIDE)
    move(panel, preset=inflation.PRESETS[1])
    assert panel.front.widget.off == ["pressure"]
    before = panel.view.rgb
    panel.set(pressure=0.2)
    assert (panel.view.rgb == before).all()


def test_the_panel_begins_with_the_start_curve_and_says_angles_and_parabola(static, arch):
    panel = widgets.balloon(arch, INSIDE)
    assert panel.view.line.startswith("Step 0 of ")
    start = cubic(100.0, np.radians(30), np.radians(150), 21)
    assert f"apex {start[:, 1].max():.1f} px" in panel.view.line
    assert "theta0 30.0, theta1 150.0 degrees" in panel.view.line
    stretch, bend = ((np.diff(start, n, axis=0) ** 2).sum() / 2 for n in (1, 2))
    assert f"energy {stretch + bend:.1f} px" in panel.view.line
    panel.set(n=41, pressure=0.1)
    assert "k = 0.1, k N\N{SUPERSCRIPT TWO}/8 = 20.0 px; " in panel.view.line


def turned(ends, degrees):
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    turn = np.array([[c, -s], [s, c]])
    return GapEnds(ends.points @ turn.T + [300, 300], ends.tangents @ turn.T), np.array(INSIDE) @ turn.T + [300, 300]


@pytest.mark.parametrize("degrees", [0, 40, 170])
def test_the_chord_lies_level_whichever_way_the_gap_lies(static, arch, degrees):
    ends, inside = turned(arch, degrees)
    frame = ChordFrame.of(ends, inside)
    # bone on the inner side of the chord only: the lower part of the picture
    rows, cols = np.mgrid[:700, :700]
    mask = frame.to_chord(np.stack([rows, cols], axis=-1))[..., 1] < 0
    scene = panel_module.Scene(ends, frame, panel_module._background(mask), None, None)
    (left, first), (right, second) = scene.place([[0, 0], [frame.length, 0]])
    assert first == second and right - left == pytest.approx(660 / 1.2)
    bone = (scene.level == rgb_of(BONE)).all(axis=-1)
    assert not bone[: int(first) - 6].any() and bone[int(first) + 6 :, int(left) : int(right)].all()


def test_the_true_bone_is_drawn_where_it_is_known(static, arch):
    frame = ChordFrame.of(arch, INSIDE)
    truth = frame.to_slice(cubic(100.0, 1.0, np.pi - 1.0, 50))
    without, known = (widgets.balloon(arch, INSIDE, truth=t).view.rgb for t in (None, truth))
    assert count(without, faded(TRUTH)) == 0 < 300 < count(known, faded(TRUTH))


@pytest.mark.parametrize("mode", ["widget", "static"])
def test_a_time_step_of_four_is_reached_with_and_without_widgets(monkeypatch, arch, mode):
    pytest.importorskip("anywidget")
    monkeypatch.setenv("CRANIO_NB_MODE", mode)
    panel = widgets.balloon(arch, INSIDE).set(dt=4, step=300)
    assert panel.values["dt"] == 4 and "at rest" in panel.view.line


def test_the_caption_says_how_far_the_truth_lies_off_the_balloon(static, arch):
    frame = ChordFrame.of(arch, INSIDE)
    panel = widgets.balloon(arch, INSIDE, truth=frame.to_slice(np.array([[0.0, 0.0], [50.0, 40.0], [100.0, 0.0]])))
    apex = cubic(100.0, np.radians(30), np.radians(150), 21)[:, 1].max()
    assert f"at most {40 - apex:.1f} px off the truth" in panel.view.line  # at its tip, above the start curve's apex
