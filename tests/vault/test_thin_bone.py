"""Thickness of bone from what it attenuates."""

import numpy as np
import pytest

from cranio_nb.vault.thin_bone import Material
from cranio_nb.volume import Volume

RAYS = np.array([[0.0, 0.0, 1.0]])


def plate(thick_mm, spacing=5.0, medium=40.0, bone=900.0):
    """A plate across z at 60 mm in slices `spacing` apart, each the mean over its thickness; HU."""
    fine = np.full(2000, medium)  # 0.05 mm
    fine[1200 : 1200 + round(thick_mm / 0.05)] = bone
    per = round(spacing / 0.05)
    hu = fine.reshape(-1, per).mean(axis=1)
    affine = np.array([[0, 0, 2.0, -8], [0, 2.0, 0, -8], [spacing, 0, 0, spacing / 2], [0, 0, 0, 1]])
    return Volume(np.broadcast_to(hu[:, None, None], (len(hu), 9, 9)).astype(np.float32), affine)


@pytest.mark.parametrize("thick_mm", [1.0, 2.0, 4.0])
@pytest.mark.parametrize("spacing", [1.0, 2.5, 5.0])
def test_what_a_slice_blurs_is_not_lost(thick_mm, spacing):
    ct = plate(thick_mm, spacing)
    material = Material(ct, 40.0, 900.0, 0.0)
    found = material.thickness(np.zeros(3), RAYS, np.array([60.0 + thick_mm]), above_mm=9.0)
    assert found == pytest.approx(thick_mm, abs=0.25)


def test_soft_tissue_is_no_bone():
    material = Material(plate(0.0), 40.0, 900.0, 100.0)
    assert material.thickness(np.zeros(3), RAYS, np.array([60.0]), above_mm=2.0) == 0


@pytest.mark.parametrize("soft_hu", [-90.0, 0.0, 45.0, 95.0])
def test_soft_tissue_in_a_head_full_of_air_is_no_bone(soft_hu):
    """A dry skull whose hole is closed by skin, gel or plastic."""
    material = Material(plate(7.0, 1.0, medium=-1000.0, bone=soft_hu), -1000.0, 1400.0, 100.0)
    assert material.thickness(np.zeros(3), RAYS, np.array([66.0]), above_mm=5.0) == 0


@pytest.mark.parametrize("spacing", [1.0, 2.5])
def test_thin_bone_in_a_head_full_of_air_is_bone(spacing):
    """Blurred to the HU of soft tissue, but nowhere a layer of it."""
    material = Material(plate(0.45 * spacing, spacing, medium=-1000.0, bone=1400.0), -1000.0, 1400.0, 100.0)
    found = material.thickness(np.zeros(3), RAYS, np.array([60.5]), above_mm=9.0)
    assert found == pytest.approx(0.45 * spacing, abs=0.25)


def test_metal_counts_no_more_than_bone():
    loud = Material(plate(2.0, 1.0, bone=3000.0), 40.0, 900.0, 0.0)
    assert loud.thickness(np.zeros(3), RAYS, np.array([61.0]), above_mm=5.0) <= 3.0


def test_a_mask_is_its_own_scale():
    mask = Volume(plate(4.0, 1.0).voxels > 400, plate(4.0, 1.0).affine)
    material = Material.of(mask, None, np.zeros(3), RAYS)
    assert material.thickness(np.zeros(3), RAYS, np.array([63.0]), above_mm=5.0) == pytest.approx(4.0, abs=0.4)
