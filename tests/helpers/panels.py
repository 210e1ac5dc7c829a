"""What the tests of panels share: the pixels of a panel, colours counted in them."""

import io

import numpy as np
from PIL import Image

from cranio_nb.drawing.palette import rgb_of

INSIDE = (200.0, 110.0)
"""(row, col) px on the inner side of the gap of the fixture `arch`."""


def pixels_of(panel):
    """The picture on the widget, decoded."""
    return np.asarray(Image.open(io.BytesIO(panel.front.widget.picture)).convert("RGB"))


def move(panel, **values):
    """Move controls in the browser."""
    panel.front.widget.values = panel.front.widget.values | values


def close(jpeg, rgb):
    return jpeg.shape == rgb.shape and np.abs(jpeg.astype(int) - rgb).mean() < 1.5


def count(rgb, colour):
    return int((np.abs(rgb.astype(int) - rgb_of(colour)).max(axis=-1) < 12).sum())
