"""Widgets of a panel: labelled, within their limits, as fast as the hand and no faster."""

import asyncio

from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.live import Latest


def test_of_many_waiting_calls_only_the_last_is_made(live):

    done, wanted = [], []
    later = Latest(lambda: done.append(wanted[-1]))

    async def flood():
        for i in range(50):
            wanted.append(i)
            later()
        await asyncio.sleep(0.1)

    asyncio.run(flood())
    assert done == [0, 49]


def test_a_hand_on_a_slider_finds_each_value_that_set_takes(live, ct):
    panel = widgets.ct_viewer(ct)
    for width in (80, 83):
        panel.set(width=width)
        assert panel.front.controls["width"].value == panel.values["width"] == 80
    assert panel.front.controls["width"].step == 10
