"""The picture: slices are means of layers, partial volume keeps sums, tissues have their HU."""

import numpy as np
import pytest

from data_synth.face.anatomy import Anatomy, depths
from data_synth.face.base_map import base_map
from data_synth.face.braincase import braincase
from data_synth.face.render import AIR, BRAIN, SOFT, _share, layers, plane_at, render


@pytest.fixture(scope="module")
def head():
    rng = np.random.default_rng(5)
    return Anatomy(braincase(rng, np.zeros(3), np.eye(3)), base_map(rng), np.ones(3))


def axial(low, slice_mm, pixel=1.6, half=112.0):
    """Grid whose first slice begins at the height `low`."""
    n = int(2 * half / pixel)
    affine = np.eye(4)
    affine[:3, :3] = np.fliplr(np.diag([pixel, pixel, slice_mm]))
    affine[:3, 3] = [-pixel * (n - 1) / 2, -pixel * (n - 1) / 2, low + slice_mm / 2]
    return affine, (n, n)


def scan(head, low, slice_mm, count, **options):
    affine, shape = axial(low, slice_mm, **options)
    return render(head, affine, (count, *shape), noise=0.0)


@pytest.mark.parametrize("thickness", [0.5, 1.0, 1.25, 2.0, 2.5, 3.0, 3.75, 5.0])
def test_layers_are_odd_even_and_thin(thickness):
    places = layers(thickness)
    assert len(places) % 2 == 1 and 0.0 in places
    assert thickness / len(places) <= 1.25 + 1e-9
    np.testing.assert_allclose(places.sum(), 0, atol=1e-12)
    np.testing.assert_allclose(np.diff(places), 1 / len(places))


@pytest.mark.parametrize("low", [-70.0, -12.0, 70.0])
def test_a_thick_slice_is_the_mean_of_thin_ones(head, low):
    thick = scan(head, low, 5.0, 1)[0][0].astype(float)
    thin = scan(head, low, 1.0, 5)[0].astype(float).mean(0)
    np.testing.assert_allclose(thick, thin, atol=1.0)  # both were rounded


def test_thick_slices_hide_thin_bone(head):
    """The same roofs of the orbits are brighter in 1 mm slices than in 5 mm slices."""
    thin = scan(head, -12.0, 1.0, 20, pixel=1.0)[0]
    thick = scan(head, -12.0, 5.0, 4, pixel=1.0)[0]
    centre = 112
    roof = np.s_[:, centre - 62 : centre - 50, centre + 22 : centre + 34]
    assert np.median(thin[roof].max(0)) > np.median(thick[roof].max(0)) + 60


def test_the_sum_of_bone_shares_is_the_volume(head):
    affine, shape = axial(30.0, 2.0, pixel=1.0)
    _, bone, _ = render(head, affine, (12, *shape), noise=0.0)
    fine_affine, fine_shape = axial(30.0, 1.0, pixel=0.5)
    _, fine, _ = render(head, fine_affine, (24, *fine_shape), noise=0.0)
    fine_volume = fine.sum() * 0.25
    assert bone.sum() * 2.0 == pytest.approx(fine_volume, rel=0.01)
    shares = sum(_share(depths(head, plane_at(head, affine, k, shape)).bone, 1.3).sum() for k in range(12))
    assert shares * 2.0 == pytest.approx(fine_volume, rel=0.003)


def test_tissues_have_their_hu(head):
    hu, bone, implant = scan(head, 38.0, 2.0, 2)
    assert not implant.any()
    middle = hu.shape[1] // 2
    assert hu[0, middle, middle] == BRAIN
    assert hu[0, 0, 0] == AIR
    assert 700 < np.median(hu[bone]) < 1300
    skin = (hu > SOFT - 3) & (hu < SOFT + 3)
    assert skin.sum() > 100
    low = scan(head, -46.0, 2.0, 1, pixel=1.0)[0][0]
    assert low[112 - 62, 112 + 5] == AIR  # nose
    assert low[112 - 60, 112 + 25] == AIR  # cheek's sinus
    eye = scan(head, -19.0, 2.0, 1, pixel=1.0)[0][0]
    assert abs(eye[112 - 75, 112 + 33] - 15) < 2 and eye[112 - 62, 112 + 27] < -60  # eye, fat behind it


def test_noise_and_blur(head):
    affine, shape = axial(40.0, 2.0)
    clean, noisy, blurred = (
        render(head, affine, (2, *shape), **options)[0].astype(float)
        for options in ({"noise": 0.0}, {"noise": 12.0, "seed": 1}, {"noise": 0.0, "blur_mm": 0.8})
    )
    soft = (clean > -900) & (clean < 100)
    assert (noisy - clean)[soft].std() == pytest.approx(12.0, rel=0.1)
    assert blurred.sum() == pytest.approx(clean.sum(), rel=1e-3)
    assert np.abs(np.diff(blurred, axis=1)).max() < np.abs(np.diff(clean, axis=1)).max()
