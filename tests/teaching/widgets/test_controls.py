"""Controls are plain values that cannot be changed."""

import dataclasses

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.teaching.widgets.controls import Choice, Slider, Switch


@pytest.mark.parametrize("control", [Slider("k", "k (px)", 0, 1, 0.5), Choice("side", "side", ("a", "b"), "a")])
def test_a_control_stays_what_it_is(control):
    with pytest.raises(dataclasses.FrozenInstanceError):
        control.value = 3
    assert control == dataclasses.replace(control)
    assert Switch("on", "on", True) != Switch("on", "on", False)


@pytest.mark.parametrize(
    ("slider", "asked", "taken"),
    [
        (Slider("width", "width (HU)", 50, 4000, 1500, 10), 80, 80),
        (Slider("width", "width (HU)", 50, 4000, 1500, 10), 9000, 4000),
        (Slider("k", "k (px)", -0.1, 0.4, 0.062, 0.002), 0.0621, 0.062),
        (Slider("k", "k (px)", -0.1, 0.4, 0.062, 0.002), -0.1, -0.1),
        (Slider("dt", "dt", 0.1, 10, 1, log=True), 4, 4.0),
        (Slider("dt", "dt", 0.1, 10, 1, log=True), 0.3, 0.315),
        (Slider("tol", "tol", 1e-4, 1, 1e-3, log=True), 0.0, 1e-4),
    ],
)
def test_a_slider_takes_the_nearest_of_its_stops(slider, asked, taken):
    assert slider.taken(asked) == taken
    assert slider.taken(slider.value) == slider.value  # it begins on a stop


def test_logarithmic_stops_are_even_and_end_at_the_limits():
    stops = np.array(Slider("damping", "damping", 0.1, 100, 1, log=True).stops)
    assert len(stops) == 31 and stops[0] == 0.1 and stops[-1] == 100
    # series R10 rounds the tenth roots of ten by at most 1.3 %, so ratios of neighbours by twice that
    np.testing.assert_allclose(np.diff(np.log10(stops)), 0.1, atol=np.log10(1.026))


def test_a_word_that_is_no_option_is_refused_with_those_that_are():
    with pytest.raises(InputRefused, match="inner") as refusal:
        Choice("side", "side", ("outer", "inner"), "outer").taken("left")
    assert refusal.value.code == "UnknownOption"


@pytest.mark.parametrize(
    "control",
    [
        Slider("width", "width", 50, 4000, 1500, 10, unit="HU"),
        Slider("k", "k", -0.1, 0.4, 0.062, 0.002),
        Slider("n", "snaxels", 8, 61, 20, 2),
        Slider("dt", "time step", 0.1, 10, 1, log=True),
        Choice("side", "side", ("outer", "inner"), "outer"),
        Switch("on", "on", True),
    ],
)
def test_stops_are_what_a_control_takes_and_its_start_is_one(control):
    assert control.value in control.stops and len(set(control.stops)) == len(control.stops)
    assert [control.taken(stop) for stop in control.stops] == list(control.stops)
    if isinstance(control, Slider):
        assert control.stops[0] == control.low and control.high - control.stops[-1] < control.step
