"""Solids: volumes in closed form, distances where they are exact, mirror images, balls."""

import numpy as np
import pytest

from data_synth.face.bones import hollows, loose_solids, skull_solids, tooth_solids
from data_synth.face.solids import Box, Cells, Cone, Ellipsoid, Ring, both, chain
from data_synth.face.tissue import airways, body_solids, fillings

CAPSULE = Cone((1.0, 2.0, 3.0), (4.0, 6.0, 3.0), 2.0, 2.0)
EVERY = [
    *skull_solids(), *loose_solids(), *tooth_solids(), *body_solids(),
    *(part.solid for part in (*hollows(), *airways(), *fillings())),
]  # fmt: skip


def volume(solid, step=0.15):
    """By counting points of a grid over the solid's ball."""
    centre, radius = solid.ball
    axis = np.arange(-radius - step, radius + 2 * step, step)
    p = np.array(np.meshgrid(axis, axis, axis, indexing="ij")) + np.reshape(centre, (3, 1, 1, 1))
    return float((solid.depth(p) > 0).sum() * step**3)


@pytest.mark.parametrize(
    ("solid", "truth"),
    [
        (CAPSULE, np.pi * 4 * 5 + 4 / 3 * np.pi * 8),
        (Cone((0.0, 0, 0), (0.0, 0, 0), 3.0, 3.0), 4 / 3 * np.pi * 27),
        (Ellipsoid((1.0, 0, 0), (2.0, 3.0, 4.0)), 4 / 3 * np.pi * 24),
        (Box((0.0, 0, 0), (2.0, 3.0, 4.0), 1e-3), 8 * 24.0),
        (Ring((0.0, 0, 0), 6.0, 1.5, 2.0), 2 * np.pi * 6 * np.pi * 3),  # Pappus
    ],
)
def test_volumes(solid, truth):
    assert volume(solid) == pytest.approx(truth, rel=0.01)


def test_depth_is_the_distance():
    p = np.array([[1.0, 2.0, 8.0], [9.0, 6.0, 3.0], [2.5, 4.0, 3.0]]).T
    ends = np.linalg.norm(np.subtract([9.0, 6.0], [4.0, 6.0]))
    np.testing.assert_allclose(CAPSULE.depth(p), [2.0 - 5.0, 2.0 - ends, 2.0], atol=1e-12)
    box = Box((0.0, 0, 0), (2.0, 2.0, 2.0), 0.5)
    assert box.depth(np.array([[5.0], [0], [0]])) == pytest.approx(-3.0)
    assert box.depth(np.array([[0.0], [0], [0]])) == pytest.approx(2.0)


def test_cells_have_walls_between_them():
    ball = Cone((0.0, 0, 0), (0.0, 0, 0), 10.0, 10.0)
    cells = Cells(ball, 5.0, 1.0)
    middle, wall = np.full((3, 1), 2.5), np.array([[2.5], [2.5], [0.0]])
    assert cells.depth(middle) == pytest.approx(2.0)
    assert cells.depth(wall) == pytest.approx(-0.5)


@pytest.mark.parametrize("solid", EVERY, ids=lambda solid: type(solid).__name__)
def test_a_ball_holds_its_solid_and_mirror_images_are_mirrored(solid):
    centre, radius = solid.ball
    rng = np.random.default_rng(0)
    d = rng.standard_normal((3, 500))
    shell = np.reshape(centre, (3, 1)) + d / np.linalg.norm(d, axis=0) * (radius + 1e-6)
    assert (solid.depth(shell) <= 1e-9).all()
    p = shell + rng.standard_normal(shell.shape)
    np.testing.assert_allclose(solid.on_side(-1.0).depth(p * [[-1], [1], [1]]), solid.depth(p), atol=1e-9)


def test_chains_and_pairs():
    cones = chain(((0.0, 0, 0), (1.0, 0, 0), (1.0, 1, 0)), (1.0, 2.0, 3.0))
    assert [(cone.ra, cone.rb) for cone in cones] == [(1.0, 2.0), (2.0, 3.0)]
    assert len(both(*cones)) == 4
