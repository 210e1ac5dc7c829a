"""A small sheet of known shape and material, for the tests of D-NURBS."""

import numpy as np

from cranio_nb.methods.dnurbs.sheet import Material, Sheet

SPANS = (5, 4)
SHAPE = (8, 7)
MATERIAL = Material((0.1, 0.2, 0.3, 0.4, 0.5))


def greville(spans):
    """Parameters whose own coefficients make s(x) = x."""
    knots = np.concatenate([np.zeros(3), np.arange(spans + 1.0), np.full(3, spans)])
    return (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3


def plane():
    v, u = np.meshgrid(*(greville(n) for n in SPANS), indexing="ij")
    return Sheet(np.stack([2 * v, 3 * u, v - u + 1], axis=-1), np.ones(SHAPE))
