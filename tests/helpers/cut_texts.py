"""Which words of a figure lie beyond its edges."""

import numpy as np
from matplotlib.text import Text


def cut_texts(figure):
    """The words that the edge of a drawn figure cuts, by more than a hundredth of a pixel; numbers at axes apart."""
    figure.draw_without_rendering()  # lays it out
    renderer = figure.canvas.get_renderer()
    ticks = {
        label for ax in figure.axes for axis in (ax.xaxis, ax.yaxis) for label in axis.get_ticklabels(which="both")
    }
    edge = np.array([figure.bbox.min - 0.01, figure.bbox.max + 0.01])
    shown = [t for t in figure.findobj(Text) if t.get_visible() and t.get_text().strip() and t not in ticks]
    boxes = [text.get_window_extent(renderer) for text in shown]
    return [
        t.get_text() for t, b in zip(shown, boxes, strict=True) if (b.min < edge[0]).any() or (b.max > edge[1]).any()
    ]
