"""The stored pictures of a panel are those that it draws, each once."""

import io
from itertools import product

import numpy as np
import pytest
from panels import INSIDE, close
from PIL import Image

from cranio_nb.teaching import widgets
from cranio_nb.teaching.site.axes import Axis, axes_of
from cranio_nb.teaching.site.frames import draw_frames
from cranio_nb.teaching.widgets.controls import Slider, Switch, View


def decoded(data):
    return np.asarray(Image.open(io.BytesIO(data)).convert("RGB"))


def settings(frames):
    """Values of each setting, in the order of the frames."""
    for stops in product(*(axis.stops for axis in frames.axes)):
        yield {name: v for axis, stop in zip(frames.axes, stops, strict=True) for name, v in axis.values(stop).items()}


@pytest.mark.parametrize("kind", ["drawn", "grey levels"])
def test_each_stored_picture_is_the_live_one(kind, arch, ct):
    if kind == "drawn":
        panel = widgets.balloon(arch, INSIDE).set(dt=2)
        setting, preset, pressure, step = axes_of(panel, "", 1)
        few = (preset.control.stops[0], preset.control.stops[1])
        axes = (
            setting,
            Axis(preset.control, few, 0),
            Axis(pressure.control, (0.062, 0.4), 0),
            Axis(step.control, (0, 9), 0),
        )
        frames = draw_frames(panel, axes)
    else:
        panel = widgets.ct_viewer(ct)
        plane, width = panel.controls["plane"], panel.controls["width"]
        frames = draw_frames(panel, (Axis(plane, (0, panel.values["plane"]), 1), Axis(width, (400, 1500), 1)))
    as_shown = dict(panel.values)
    for values, name, line in zip(settings(frames), frames.names, frames.lines, strict=True):
        live = panel.update(as_shown | values)  # as by hand
        assert line == live.line and close(decoded(frames.files[name]), live.rgb), values


def test_the_first_one_is_what_the_lesson_shows(small_shown):
    panel = small_shown[0]
    axes = axes_of(panel, "", 200)
    frames = draw_frames(panel, axes)
    assert frames.lines[frames.start] == panel.view.line
    assert list(settings(frames))[frames.start] == panel.values
    assert len(frames.names) == 11 * 2 * 2 and set(frames.names) == set(frames.files)


def test_a_control_without_effect_is_not_drawn_again():
    drawn = []

    def draw(own, k):
        drawn.append((own, k))
        rgb = np.full((4, 4, 3), 10 * k if own else 7, np.uint8)
        return View(rgb, f"k is {k if own else 'found'}", off=() if own else ("k",))

    controls = (Switch("own", "own", True), Slider("k", "k", 0, 5, 2))
    panel = widgets.Panel(controls, draw, alt="Grey.")
    drawn.clear()
    frames = draw_frames(panel, axes_of(panel, "", 100))
    assert len(drawn) == 6 + 1 and len(frames.files) == 6 + 1
    assert frames.off[0] == ("k",) and frames.off[-1] == ()


def test_a_slider_ends_at_the_first_stop_that_shows_its_end():
    """Of stops 0, 2, 4, 6 an end of 3 is seen at 4: what is asked for beyond an end is drawn as that end."""

    def draw(last, step):
        shown = min(step, last)
        return View(np.full((4, 4, 3), 10 * shown, np.uint8), f"step {shown} of {last}", limits={"step": last})

    panel = widgets.Panel((Slider("last", "last", 2, 6, 6), Slider("step", "step", 0, 6, 0)), draw, alt="Grey.")
    last, step = panel.controls.values()
    frames = draw_frames(panel, (Axis(last, (2, 3, 6), 2), Axis(step, (0, 2, 4, 6), 0)))
    assert [frames.tops[4 * i]["step"] for i in range(3)] == [(1, 2), (2, 3), (3, 6)]
    for i, end in enumerate((2, 3, 6)):
        at, _ = frames.tops[4 * i]["step"]
        assert frames.lines[4 * i + at] == f"step {end} of {end}"
