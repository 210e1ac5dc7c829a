"""Controls are plain values that cannot be changed."""

import dataclasses

import pytest

from cranio_nb.teaching.widgets.controls import Choice, Slider, Switch


@pytest.mark.parametrize("control", [Slider("k", "k (px)", 0, 1, 0.5), Choice("side", "side", ("a", "b"), "a")])
def test_a_control_stays_what_it_is(control):
    with pytest.raises(dataclasses.FrozenInstanceError):
        control.value = 3
    assert control == dataclasses.replace(control)
    assert Switch("on", "on", True) != Switch("on", "on", False)
