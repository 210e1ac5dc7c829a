"""The nod of a head with a face, whose axes are known."""

from dataclasses import replace

import numpy as np
import pytest

from cranio_nb.stages.segmentation import segment
from cranio_nb.vault.cavity import cavity_ball, coarse_bone
from cranio_nb.vault.cavity_walls import measure_walls
from cranio_nb.vault.nod import find_nod
from cranio_nb.volume import Volume
from data_synth import Pose, face_case


@pytest.fixture(scope="module")
def head():
    one = face_case("tiny", 3, holes=0, pose=Pose())
    bone = segment(Volume(one.hu, one.affine))
    return one.landmarks, measure_walls(bone, cavity_ball(coarse_bone(bone))[0])


@pytest.mark.parametrize("side", [1, -1])
def test_the_top_and_the_left_do_not_depend_on_the_side_the_normal_points_to(head, side):
    landmarks, walls = head
    axes, spread, brow = find_nod(walls, side * landmarks.left)
    np.testing.assert_allclose(axes[0], landmarks.left, atol=1e-9)
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-9)
    assert axes[2] @ landmarks.up > np.cos(np.radians(20))
    assert spread < 12 and brow > 4


def test_turned_rays_turn_the_axes(head):
    landmarks, walls = head
    axes, spread, brow = find_nod(walls, landmarks.left)
    turn = Pose(20, -25, 70).rotation()
    turned = find_nod(replace(walls, directions=walls.directions @ turn.T), turn @ landmarks.left)
    np.testing.assert_allclose(turned[0], axes @ turn.T, atol=1e-6)
    assert turned[1:] == (pytest.approx(spread, abs=1e-6), pytest.approx(brow, abs=1e-6))
