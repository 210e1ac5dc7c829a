"""The midline of an egg with a chin, whose plane of symmetry is known."""

import numpy as np
import pytest

from cranio_nb.vault.midline import find_midline
from cranio_nb.volume import Volume

FACE = np.array([0.0, -0.8, -0.6])
STEP = 4.0


def egg(normal, shift):
    """An ellipsoid with a chin in blocks of 4 mm about the origin; its midline lies `shift` mm along the normal."""
    n = 61
    affine = np.array([[0, 0, STEP, 0], [0, STEP, 0, 0], [STEP, 0, 0, 0], [0, 0, 0, 1.0]])
    affine[:3, 3] = -STEP * (n - 1) / 2
    points = STEP * (np.stack(np.indices((n, n, n))[::-1], axis=-1) - (n - 1) / 2)
    back = np.cross([0, 0, 1.0], normal)
    back /= np.linalg.norm(back)
    x, y, z = np.moveaxis(points @ np.stack([normal, back, np.cross(normal, back)]).T, -1, 0)
    x = x - shift
    shell = np.abs(np.sqrt((x / 65) ** 2 + (y / 85) ** 2 + (z / 70) ** 2) - 1) < 0.06
    chin = (np.abs(x) < 25) & (y < -50) & (y > -90) & (z < -40) & (z > -80)
    return Volume(shell | chin, affine)


@pytest.mark.parametrize("lean_deg", [0.0, 12.0])
@pytest.mark.parametrize("shift", [-6.0, 0.0, 5.0])
def test_the_plane_of_symmetry_is_found(lean_deg, shift):
    normal = np.array([np.cos(np.radians(lean_deg)), 0, np.sin(np.radians(lean_deg))])
    found, away, asymmetry = find_midline(egg(normal, shift), np.zeros(3), FACE)
    side = np.sign(found @ normal)
    # to one block at the wall, 65 mm away
    assert np.linalg.norm(side * found - normal) < STEP / 65
    assert side * away == pytest.approx(shift, abs=1.0)
    assert asymmetry < STEP / 2


def test_what_is_no_mirror_image_of_itself_has_a_larger_misfit():
    whole = egg(np.array([1.0, 0, 0]), 0.0)
    voxels = whole.voxels.copy()
    voxels[:, :, :25] = False
    assert find_midline(whole.with_voxels(voxels), np.zeros(3), FACE)[2] > find_midline(whole, np.zeros(3), FACE)[2] + 1
