"""Rational sheets of a few spans, for tests of the sheet and of its motion."""

import numpy as np

from cranio_nb.methods.dnurbs.sheet import Material, Sheet, Springs
from cranio_nb.methods.dnurbs.sheet_motion import Setting

SPANS = (5, 4)
SHAPE = (8, 7)
MATERIAL = Material((0.1, 0.2, 0.3, 0.4, 0.5))


def random_places(seed=7):
    """Parameters (v, u) of 40 places of a sheet."""
    rng = np.random.default_rng(seed)
    return rng.uniform(0, SPANS[0], 40), rng.uniform(0, SPANS[1], 40)


def random_sheet(seed=8):
    """A sheet of random control points and weights."""
    rng = np.random.default_rng(seed)
    return Sheet(rng.normal(size=(*SHAPE, 3)), rng.uniform(0.5, 2, SHAPE))


def random_setting(seed=9):
    """Springs to random points, and a random natural shape."""
    rng = np.random.default_rng(seed)
    springs = Springs(rng.normal(size=(40, 3)), *random_places(), rng.uniform(0.5, 2, 40))
    return Setting(springs, Sheet(rng.normal(size=(*SHAPE, 3)), np.ones(SHAPE)), MATERIAL)


def greville(spans):
    """Parameters whose own coefficients make s(x) = x."""
    knots = np.concatenate([np.zeros(3), np.arange(spans + 1.0), np.full(3, spans)])
    return (knots[1:-3] + knots[2:-2] + knots[3:-1]) / 3


def plane():
    """The plane z = v - u + 1 over x = 2 v, y = 3 u."""
    v, u = np.meshgrid(*(greville(n) for n in SPANS), indexing="ij")
    return Sheet(np.stack([2 * v, 3 * u, v - u + 1], axis=-1), np.ones(SHAPE))
