"""Widgets of a panel: labelled, within their limits, as fast as the hand and no faster."""

import asyncio

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
