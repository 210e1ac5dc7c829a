"""The balloon panel moves as the stage says; its steps end at rest."""

import numpy as np
import pytest
from panels import INSIDE, count, pixels_of

from cranio_nb.curves import ChordFrame, cubic
from cranio_nb.drawing.palette import BLUE
from cranio_nb.drawing.pixels import Window
from cranio_nb.stages import deformable_model
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets import deformable_model as panel_module


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
    low = (
        panel_module.record_inflation(100.0, (rise, np.pi - rise), *list(panel.values.values())[:-1])
        .curves[-1][:, 1]
        .min()
    )
    assert low < -1 and f"px above and {-low:.1f} px below the chord" in panel.view.line


def test_all_steps_are_kept_and_the_last_is_at_rest(arch):
    run = panel_module.record_inflation(100.0, (0.5, 2.6), panel_module.PRESETS[0], 0.062, 21, 1.0, 1.0, 1.0, 1e-3)
    assert run.converged and len(run.curves) == len(run.change) + 1
    np.testing.assert_allclose(np.linalg.norm(np.diff(run.curves, axis=0), axis=(1, 2)), run.change, rtol=1e-9)
    assert run.change[-1] <= 1e-3 < run.change[-2]


def test_a_spiral_between_equal_angles_is_an_arc_from_the_start():
    run = panel_module.record_inflation(
        100.0, (0.5, np.pi - 0.5), panel_module.PRESETS[2], 0.0, 41, 1.0, 1.0, 1.0, 1e-3
    )
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
    panel.front.controls["preset"].value = panel_module.PRESETS[1]
    assert panel.front.controls["pressure"].disabled
    before = panel.view.rgb
    panel.set(pressure=0.2)
    assert (panel.view.rgb == before).all()
