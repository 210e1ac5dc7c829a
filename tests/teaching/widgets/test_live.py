"""A panel in the browser: what it is told, and what it does with what comes back."""

import asyncio

import numpy as np
from panels import INSIDE, move

from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.controls import Choice, Slider, Switch, View

VIEW = View(np.zeros((2, 2, 3), np.uint8), "A dot.")


def test_each_kind_of_control_is_declared_with_all_it_needs(live):
    from cranio_nb.teaching.widgets.live import declared

    slider = declared(Slider("k", "pressure", 0, 1, 0.5, 0.5, unit="px", player=True, expert=True), slow=True)
    assert slider == {
        "name": "k",
        "label": "pressure",
        "unit": "px",
        "kind": "slider",
        "stops": [0, 0.5, 1],
        "player": True,
        "expert": True,
        "slow": True,
    }
    assert declared(Choice("side", "side", ("a", "b"), "a"), slow=False)["kind"] == "choice"
    assert declared(Switch("on", "on", True), slow=False)["stops"] == [False, True]


def test_a_hand_on_a_slider_finds_each_value_that_set_takes(live, ct):
    panel = widgets.ct_viewer(ct)
    for width in (80, 83):
        panel.set(width=width)
        assert panel.front.widget.values["width"] == panel.values["width"] == 80
    assert 80 in panel.front.widget.controls[2]["stops"]


def test_each_move_is_one_picture_and_a_value_that_stays_is_none(live, arch):
    panel = widgets.balloon(arch, INSIDE)
    drawn = panel.front.widget.drawn
    move(panel, step=2)
    move(panel, step=2)
    assert panel.front.widget.drawn == drawn + 1
    assert panel.front.widget.caption == panel.view.line


def test_the_start_can_be_gone_back_to(live, arch):
    panel = widgets.balloon(arch, INSIDE)
    move(panel, **panel.presets["k = 0.4"])
    assert panel.values["pressure"] == 0.4
    move(panel, **panel.front.widget.presets["as at the start"])
    assert panel.view.line == panel.first.line


def test_a_button_says_what_came_of_it(live):
    panel = widgets.Panel((), lambda: VIEW, alt="A dot.", actions={"wave": lambda panel: "Waved."})
    panel.front.widget._handle_custom_msg({"action": "wave"}, [])
    assert panel.front.widget.caption == "Waved."


def test_while_the_kernel_rests_each_stop_is_drawn_once_the_near_ones_first(live, monkeypatch):
    from cranio_nb.teaching.widgets import live as front

    monkeypatch.setattr(front, "REST_S", 0.0)
    monkeypatch.setattr(front, "LATE_S", np.inf)
    drawn = []

    def draw(n):
        drawn.append(n)
        if len(drawn) == 5:
            done.set()
        return VIEW

    async def kernel():
        shown = panel.front.widget.drawn
        await asyncio.wait_for(done.wait(), timeout=60)
        return panel.front.widget.drawn - shown

    done = asyncio.Event()
    panel = widgets.Panel((Slider("n", "number", 0, 4, 3),), draw, alt="A dot.", ahead="n")
    assert asyncio.run(kernel()) == 0  # nothing moves
    assert drawn[:4] == [3, 2, 4, 1] and sorted(drawn) == [0, 1, 2, 3, 4]
    assert panel.values == {"n": 3} and panel.view is panel.first


def test_a_busy_kernel_draws_nothing_ahead(live, monkeypatch):
    from cranio_nb.teaching.widgets import live as front

    monkeypatch.setattr(front, "REST_S", 0.0)
    monkeypatch.setattr(front, "LATE_S", 0.0)  # every call comes late
    drawn = []
    panel = widgets.Panel((Slider("n", "number", 0, 4, 3),), lambda n: drawn.append(n) or VIEW, alt="", ahead="n")

    async def kernel():
        assert panel.front.widget.drawn
        for _ in range(20):
            await asyncio.sleep(0)

    asyncio.run(kernel())
    assert drawn == [3]
