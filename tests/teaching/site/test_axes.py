"""Which stops are drawn ahead: those that are asked for, and not more than there is room for."""

from math import prod

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from cranio_nb.teaching.site.axes import axes_of, presets_on, share_frames, thinned, wanted_values
from cranio_nb.teaching.widgets import Panel, View
from cranio_nb.teaching.widgets.controls import Choice, Slider, Switch

GREY = View(np.zeros((2, 2, 3), np.uint8), "grey")


def panel(*controls, **more):
    return Panel(controls, lambda **values: GREY, alt="Grey.", **more)


@given(st.lists(st.integers(1, 300), min_size=1, max_size=4), st.integers(16, 500))
def test_all_combinations_come_to_no_more_than_asked_for(lengths, n):
    counts = share_frames(lengths, n)
    assert prod(counts) <= n
    assert all(min(length, 2) <= count <= length for count, length in zip(counts, lengths, strict=True))


@given(st.integers(1, 60), st.integers(2, 20), st.booleans())
def test_a_thinned_slider_keeps_its_ends_and_what_is_wanted(last, n, player):
    slider = Slider("n", "n", 0, last, 0, player=player)
    stops = thinned(slider, n, {last // 2})
    assert {0, last // 2, last} <= set(stops) <= set(slider.stops) and list(stops) == sorted(stops)
    assert len(stops) <= n + 1


def test_stops_near_the_first_one_are_drawn_where_a_slider_says_so():
    shown = panel(Slider("plane", "slice", 0, 63, 33, ahead=4, near=3))
    (axis,) = axes_of(shown, "", 100)
    assert set(axis.stops) == {0, 21, 42, 63} | set(range(30, 37))
    (axis,) = axes_of(shown.set(plane=1), "", 100)
    assert set(axis.stops) == {0, 21, 42, 63, 33} | set(range(5))


def test_a_film_has_its_close_stops_at_the_beginning():
    stops = thinned(Slider("step", "step", 0, 300, 0, player=True), 10, set())
    gaps = np.diff(stops)
    assert (np.diff(gaps) >= 0).all() and gaps[0] == 1


def test_values_that_are_shown_named_or_set_by_a_preset_are_drawn():
    hu = Slider("hu", "threshold", -200, 1500, 400, 5)
    shown = panel(hu, presets={"low": {"hu": 200}}).set(hu=625)
    text = "Move it: `panel.set(hu = 803)`, `set(plane=3, hu=-100)`; not `other_hu=7`, nor hu=9999."
    assert wanted_values(shown, hu, text) == {400, 625, 200, 805, -100, 1500}
    (axis,) = axes_of(shown, text, 4)
    assert set(axis.stops) >= {625, 200, 805, -100} and axis.stops[axis.start] == 625


def test_folded_controls_stay_as_they_are_shown():
    controls = (
        Slider("n", "n", 7, 61, 21, 2, expert=True),
        Switch("fine", "fine", True),
        Choice("k", "k", ("a",), "a"),
    )
    assert [axis.control.name for axis in axes_of(panel(*controls), "", 100)] == ["fine", "k"]


def test_a_control_may_say_how_many_are_drawn_ahead():
    few, rest = Slider("few", "few", 0, 100, 30, ahead=3), Slider("rest", "rest", 0, 100, 0)
    axes = axes_of(panel(few, rest), "", 100)
    assert axes[0].stops == (0, 30, 50, 100) and len(axes[1].stops) == 25


def test_where_pictures_are_slow_presets_of_folded_controls_are_left_out():
    controls = (Slider("k", "k", 0, 9, 1), Slider("n", "n", 0, 9, 3, expert=True))
    shown = panel(*controls, presets={"here": {"k": 5, "n": 3}, "away": {"k": 5, "n": 4}}, slow=True)
    axes = axes_of(shown, "", 10)
    assert [axis.control.name for axis in axes] == ["k"]
    assert presets_on(axes, shown) == {"as at the start": {"k": 1}, "here": {"k": 5}}


def test_where_presets_move_folded_controls_one_more_control_chooses_among_them():
    controls = (Slider("k", "k", 0, 9, 1), Slider("n", "n", 0, 9, 3, expert=True))
    shown = panel(*controls, presets={"here": {"k": 5}, "away": {"k": 6, "n": 4}})
    setting, k = axes_of(shown, "", 20)
    assert setting.stops == ("as shown", "away") and k.stops == tuple(range(10))
    assert [setting.values(stop) for stop in setting.stops] == [{}, {"n": 4}] and k.values(7) == {"k": 7}
    assert presets_on((setting, k), shown) == {
        "as at the start": {"k": 1, "setting": "as shown"},
        "here": {"k": 5},
        "away": {"k": 6, "setting": "away"},
    }
