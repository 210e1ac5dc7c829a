"""The picture of a scene: sizes in pixels, a length, names, and the colours of numbers."""

import numpy as np
import pytest
from shapes import cube

from cranio_nb.drawing.palette import BLUE, ORANGE, rgb_of
from cranio_nb.drawing.scene_picture import HEIGHT, WIDTH, Part, draw_parts, top_of_scale

FRONT = np.array([0.0, -1.0, 0.0])


def test_a_scene_just_fits_its_picture():
    for size in (20.0, 40.0, 400.0):
        shown = draw_parts([Part(cube(size), BLUE, "", None)], FRONT)
        body = np.flatnonzero(shown[:-30, WIDTH // 2 + 30].min(axis=1) < 200)
        assert np.ptp(body) == pytest.approx(HEIGHT - 80, abs=4) and shown.shape[1] == WIDTH


def test_named_parts_are_in_the_legend():
    parts = [Part(cube(40), BLUE, "large", None), Part(cube(10, (0, 50, 0)), ORANGE, "hidden", None)]
    shown = draw_parts(parts, FRONT)
    assert (shown[:60, :60] == rgb_of(ORANGE)).all(axis=2).sum() == pytest.approx(200, abs=40)


def test_a_part_coloured_by_numbers_is_in_the_legend_with_its_scale():
    named, nameless = (draw_parts([Part(cube(40), BLUE, name, np.arange(8.0))], FRONT) for name in ("distance", ""))
    swatch = named[18, 14:34].astype(int)  # dark blue at the left, yellow at the right
    assert swatch[1, 2] > swatch[1, 0] and swatch[-2, 0] > swatch[-2, 2] + 100
    assert (nameless[18, 14:34] > 250).all()


def test_the_top_of_the_scale_is_above_nearly_all():
    values = np.arange(8.0)
    assert top_of_scale([Part(cube(1), BLUE, "", None)]) is None
    assert top_of_scale([Part(cube(1), BLUE, "", values), Part(cube(1), BLUE, "", None)]) == np.percentile(values, 99)
    assert top_of_scale([Part(cube(1), BLUE, "", np.zeros(8))]) > 0


def test_numbers_bring_a_colour_scale():
    plain, coloured = (draw_parts([Part(cube(40), BLUE, "", v)], FRONT) for v in (None, np.arange(8.0)))
    assert len(coloured) > len(plain)
    bar = coloured[len(plain) + 8, WIDTH // 2 - 140 : WIDTH // 2 + 140].astype(int)
    assert bar[2, 2] > bar[2, 0] and bar[-3, 0] > bar[-3, 2] + 100
