"""Every panel: the picture follows the controls; the static twin has a description and is the same on every run."""

import io

import numpy as np
import pytest
from panels import INSIDE, close, move, pixels_of
from PIL import Image

from cranio_nb.errors import InputRefused
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.controls import Slider, View
from cranio_nb.teaching.widgets.parts import HEIGHT, WIDTH


def make_all(ct, skull, opened, arch, made, true):
    opening = opened.sheet
    return {
        "ct_viewer": widgets.ct_viewer(ct),
        "threshold": widgets.threshold(ct),
        "features": widgets.features(skull, sum(opened.planes) // 2, opening=opening),
        "balloon": widgets.balloon(arch, INSIDE),
        "patch": widgets.patch(skull, opened),
        "surface": widgets.surface(made.patch),
        "distances": widgets.distances(made, true),
        "guiding_points": widgets.guiding_points(skull, opened, true),
        "symmetry_plane": widgets.symmetry_plane(skull, opened),
        "bent_plate": widgets.bent_plate(skull, opened, true),
        "elastic_sheet": widgets.elastic_sheet(skull, opened, true),
    }


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
    moves = {
        "ct_viewer": ("width", 400),
        "threshold": ("threshold_hu", 900),
        "features": ("reach_mm", 25.0),
        "balloon": ("n", 41),
    }
    moves |= {"patch": ("curves", False), "surface": ("steps", 0), "distances": ("side", "inner")}
    moves |= {"guiding_points": ("n", 5), "symmetry_plane": ("turn_deg", 4.0)}
    moves |= {"bent_plate": ("second_mm", 9.0), "elastic_sheet": ("step", 1)}
    for name, panel in panels.items():
        assert close(pixels_of(panel), panel.view.rgb), name
        before = panel.front.widget.picture
        control, value = moves[name]
        move(panel, **{control: value})
        assert panel.front.widget.picture != before, name
        assert panel.values[control] == value
        assert close(pixels_of(panel), panel.picture(**panel.values).rgb), name


def test_the_picture_of_a_setting_is_that_of_the_panel_set_to_it_and_moves_nothing(static, arch):
    panel, moved = widgets.balloon(arch, INSIDE), widgets.balloon(arch, INSIDE).set(step=3, pressure=0.1)
    seen = panel.picture(step=3, pressure=0.1)
    assert (seen.rgb == moved.view.rgb).all() and seen.line == moved.view.line
    assert panel.values["step"] == 0 and panel.view is panel.first


def test_a_setting_that_cannot_be_drawn_says_why_on_a_faded_picture():
    def draw(n):
        if n > 1:
            raise InputRefused("TooMany", "There are too many.")
        return View(np.full((4, 4, 3), 30 * n, np.uint8), f"{n} drawn")

    panel = widgets.Panel((Slider("n", "number", 0, 3, 1),), draw, alt="A grey square.")
    refused = panel.picture(n=2)
    assert refused.line == "There are too many." and (refused.rgb == 30 // 2 + 127).all()


def test_every_control_begins_on_one_of_its_stops_and_so_do_the_presets(panels):
    for panel in panels.values():
        settings = [{name: control.value for name, control in panel.controls.items()}, *panel.presets.values()]
        assert all(value in panel.controls[name].stops for some in settings for name, value in some.items())


def test_a_panel_refuses_a_control_it_does_not_have(static, arch):
    with pytest.raises(InputRefused, match="pressure"):
        widgets.balloon(arch, INSIDE).set(kk=1)


def test_every_panel_refuses_a_number_beyond_its_sliders_and_moves_nothing(static, panels):
    """A number that was clipped in silence would be taken for the answer to another question."""
    for name, panel in panels.items():
        before = dict(panel.values)
        for slider in (control for control in panel.controls.values() if isinstance(control, Slider)):
            for value in (slider.low - slider.step, slider.high + slider.step, float("nan"), "much"):
                with pytest.raises(InputRefused, match=f"It takes {slider.low:g} to {slider.high:g}"):
                    panel.set(**{slider.name: value})
        assert panel.values == before, name


def test_a_control_without_effect_is_named_when_it_is_set_to_something_new(static):
    view = View(np.zeros((4, 4, 3), np.uint8), "A square.", off=("k",))
    panel = widgets.Panel((Slider("k", "k", 0, 3, 1), Slider("n", "n", 0, 3, 1)), lambda k, n: view, alt="A square.")
    assert panel.set(n=2, k=1).view.line == "A square."
    assert panel.set(n=3, k=2).view.line == "A square. No effect at this setting: k."


def test_all_panels_have_the_size_that_fits_a_laptop_and_few_controls_unfolded(panels):
    for name, panel in panels.items():
        assert panel.view.rgb.shape == (HEIGHT, WIDTH, 3), name
        labels = [control.label for control in panel.controls.values()]
        assert all(labels) and len(set(labels)) == len(labels), name
        assert 1 <= sum(not control.expert for control in panel.controls.values()) <= 4, name


def test_a_live_bundle_has_widget_picture_and_line(live, panels):
    data, _ = panels["threshold"]._repr_mimebundle_()
    assert {"application/vnd.jupyter.widget-view+json", "image/png", "text/plain"} <= set(data)
