"""Drawn holes: in the vault, apart, of the sizes asked for."""

import numpy as np
import pytest

from data_synth.face.holes import LARGEST, SMALLEST, draw_holes


@pytest.mark.parametrize("count", [1, 2, 3])
def test_holes_keep_apart_and_above_the_base(count):
    for seed in range(40):
        specs = draw_holes(np.random.default_rng(seed), count)
        sizes = np.array([spec.diameter[0] for spec in specs])
        directions = np.array([spec.direction for spec in specs])
        half = np.rad2deg(np.arcsin(sizes / 160.0))
        assert ((sizes >= SMALLEST) & (sizes <= LARGEST)).all() and (np.diff(sizes) <= 0).all()
        assert (np.rad2deg(np.arcsin(directions[:, 2])) - half > -6).all()
        angles = np.rad2deg(np.arccos(np.clip(directions @ directions.T, -1, 1)))
        for a in range(count):
            for b in range(a):
                assert angles[a, b] > half[a] + half[b] + 9


def test_given_diameters_are_kept_in_their_order():
    specs = draw_holes(np.random.default_rng(0), 2, (20.0, 90.0))
    assert [spec.diameter for spec in specs] == [(20.0, 20.0), (90.0, 90.0)]


@pytest.mark.parametrize(
    ("count", "diameters", "words"),
    [
        (4, None, "1 to 3 holes"),
        (0, None, "1 to 3 holes"),
        (2, (30.0,), "one diameter each"),
        (1, (9.0,), "10 to 120 mm"),
        (1, (130.0,), "10 to 120 mm"),
        (3, (120.0, 120.0, 120.0), "do not fit"),
    ],
)
def test_what_cannot_be_drawn_is_refused(count, diameters, words):
    with pytest.raises(ValueError, match=words):
        draw_holes(np.random.default_rng(0), count, diameters)
