"""The cavity of heads that lie in any way."""

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.vault.cavity import cavity_ball, coarse_bone, enclosed
from cranio_nb.volume import Volume


def shell(radius=60.0, wall=6.0, n=50, spacing=3.0, hole=0.0):
    """A spherical shell about the origin, open in a cone about x; `hole` is its half-angle in degrees."""
    z, y, x = (np.indices((n, n, n)) - (n - 1) / 2) * spacing
    r = np.sqrt(x**2 + y**2 + z**2)
    closed = x < r * np.cos(np.radians(hole)) if hole else np.ones(r.shape, bool)
    affine = np.diag([spacing] * 3 + [1.0])[:, [2, 1, 0, 3]]
    affine[:3, 3] = -(n - 1) / 2 * spacing
    return Volume((abs(r - radius) < wall / 2) & closed, affine)


def test_inside_a_closed_shell_bone_is_met_everywhere_and_outside_never_by_half():
    met = enclosed(shell().voxels)
    assert met[25, 25, 25] == 26
    assert met[0, 0, 0] <= 13 and met[25, 25, 1] <= 13


def test_one_voxel_is_met_from_all_that_lie_on_a_line_with_it():
    bone = np.zeros((6, 5, 7), bool)
    at = np.array([2, 1, 4])
    bone[tuple(at)] = True
    away = np.abs(np.indices(bone.shape) - at[:, None, None, None])
    on_line = ((away == 0) | (away == away.max(axis=0))).all(axis=0) & ~bone
    np.testing.assert_array_equal(enclosed(bone), on_line)


@pytest.mark.parametrize("hole", [0.0, 20.0, 45.0])
def test_the_largest_ball_lies_in_the_shell_even_where_a_hole_is_wide(hole):
    centre, radius = cavity_ball(coarse_bone(shell(hole=hole)))
    assert np.linalg.norm(centre) < 20.0
    assert radius == pytest.approx(57.0, abs=8.0) or hole == 45.0


def test_turning_the_grid_turns_the_result():
    one = shell(hole=30.0)
    centre, radius = cavity_ball(coarse_bone(one))
    turned = Volume(one.voxels.transpose(1, 0, 2).copy(), one.affine[:, [1, 0, 2, 3]])
    there, same = cavity_ball(coarse_bone(turned))
    assert radius == same
    np.testing.assert_allclose(np.linalg.norm(there), np.linalg.norm(centre), atol=1e-9)


@pytest.mark.parametrize("filled", [True, False])
def test_neither_a_solid_nor_nothing_encloses_a_cavity(filled):
    with pytest.raises(InputRefused) as refused:
        cavity_ball(coarse_bone(Volume(np.full((30, 30, 30), filled), np.diag([3.0, 3, 3, 1]))))
    assert refused.value.code == "NoVault"


def test_blocks_keep_every_bone_and_its_place():
    voxels = np.zeros((9, 8, 7), bool)
    voxels[8, 7, 6] = True
    one = Volume(voxels, np.diag([1.0, 1.0, 1.0, 1.0]))
    coarse = coarse_bone(one, 4.0)
    (index,) = np.argwhere(coarse.voxels)
    assert np.abs(coarse.to_world(index) - one.to_world([8, 7, 6])).max() <= 1.5 + 2.0
