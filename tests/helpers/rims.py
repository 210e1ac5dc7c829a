"""Round rims of holes as polylines."""

import numpy as np


def circle(radius, n, height=0.0, start=0.0):
    """Points on a circle about the z axis, shape (n, 3)."""
    turn = np.linspace(0, 2 * np.pi, n, endpoint=False) + start
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(n, height)])
