"""Fans of slices through a radius map: closed-form frames, profiles of a known vault, pictures of a mask."""

import numpy as np
import pytest

from cranio_nb.vault.ray_grid import RadiusMap, RayGrid
from cranio_nb.vault.slicing import axial_frames, make_fans, read_profile, sample_mask
from cranio_nb.volume import Volume

STEP = np.radians(1.0)
N = 121
CENTRE = np.array([31.0, -47.0, 812.0])
WIDE, LONG = 0.25, 0.45  # half axes of the hole across and along, radians


def turned():
    """A right-handed frame that stands askew in the world."""
    q, _ = np.linalg.qr(np.random.default_rng(8).normal(size=(3, 3)))
    return q * np.linalg.det(q)


@pytest.fixture(scope="module")
def vault():
    """A radius map about an oval hole, 8 mm of bone, with an outer radius of 80 mm that grows towards u."""
    v, u = (np.mgrid[:N, :N] - (N - 1) / 2) * STEP
    hole = (u / WIDE) ** 2 + (v / LONG) ** 2 < 1
    outer = np.where(hole, np.nan, 80 + 5 * u)
    return RadiusMap(RayGrid(CENTRE, turned(), STEP, N), outer=outer, inner=outer - 8, hole=hole)


@pytest.mark.parametrize("n", [1, 2, 6])
def test_every_ray_of_every_fan_is_found_again(vault, n):
    made = make_fans(vault, n)
    assert len(made) == n
    for fan in made:
        np.testing.assert_allclose(fan.axes @ fan.axes.T, np.eye(3), atol=1e-12)
        assert np.linalg.det(fan.axes) == pytest.approx(np.linalg.det(vault.grid.axes))
        np.testing.assert_allclose(np.linalg.norm(fan.directions, axis=-1), 1, atol=1e-12)
        slice_, ray = np.indices(fan.directions.shape[:2])
        np.testing.assert_allclose(fan.locate(fan.directions), [slice_, ray], atol=1e-6)


def test_a_ray_lies_in_its_slice_at_its_angle(vault):
    """Frame and angle give the same ray: angle 0 against the rows, growing towards the columns."""
    fan = make_fans(vault, 3)[1]
    origin, row, col = np.moveaxis(fan.frames(CENTRE), 1, 0)
    np.testing.assert_array_equal(origin, np.tile(CENTRE, (len(origin), 1)))
    a = fan.angles[None, :, None]
    np.testing.assert_allclose(-np.cos(a) * row[:, None] + np.sin(a) * col[:, None], fan.directions, atol=1e-12)
    np.testing.assert_allclose((row * col).sum(axis=1), 0, atol=1e-12)


def test_the_first_fan_crosses_the_short_side_and_the_others_turn_evenly(vault):
    crossed = []
    for fan in make_fans(vault, 6):
        seen = read_profile(vault, fan)
        middle = np.argmin(np.abs(fan.tilts))
        first, last = seen.gap[middle]
        crossed.append(seen.angles[last] - seen.angles[first])
    assert int(np.argmin(crossed)) == 0 and int(np.argmax(crossed)) == 3
    turn = np.arange(6) * np.pi / 6
    chord = 2 / np.hypot(np.cos(turn) / WIDE, np.sin(turn) / LONG)
    np.testing.assert_allclose(crossed, chord, atol=1.5 * STEP)


def test_slices_are_a_millimetre_apart_and_cover_the_hole(vault):
    for fan in make_fans(vault, 4):
        radius = np.nanmedian(vault.outer)
        np.testing.assert_allclose(np.diff(fan.tilts) * radius, 1.0)
        slice_, ray = fan.locate(vault.grid.directions[vault.hole])
        assert slice_.min() >= 1 and slice_.max() <= len(fan.tilts) - 1
        beside = np.minimum(ray.min(), len(fan.angles) - 1 - ray.max()) * np.diff(fan.angles)[0]
        assert beside >= 0.7  # radians of bone to fit on


def test_a_profile_reads_the_vaults_radii(vault):
    fan = make_fans(vault, 6)[2]
    seen = read_profile(vault, fan)
    v, u = (vault.grid.locate(fan.directions) - (N - 1) / 2) * STEP
    known = np.isfinite(seen.outer)
    assert known.mean() > 0.5
    np.testing.assert_allclose(seen.outer[known], (80 + 5 * u)[known], atol=1e-3)
    np.testing.assert_allclose((seen.outer - seen.inner)[known], 8, atol=1e-9)
    deep = (u / (WIDE - STEP)) ** 2 + (v / (LONG - STEP)) ** 2 < 1
    far = (u / (WIDE + STEP)) ** 2 + (v / (LONG + STEP)) ** 2 > 1
    assert seen.missing[deep].all() and not seen.missing[far].any()
    assert np.isnan(seen.outer[seen.missing & deep]).all()
    outside = np.maximum(np.abs(u), np.abs(v)) > (N - 1) / 2 * STEP
    assert np.isnan(seen.outer[outside]).all()


@pytest.fixture(scope="module")
def box():
    """Random blocks on a leaning, unequal grid far from the origin."""
    affine = np.eye(4)
    affine[:3, :3] = turned() * (3.0, 0.8, 0.8)
    affine[:3, 3] = CENTRE
    return Volume(np.random.default_rng(2).random((6, 20, 30)) < 0.5, affine)


def test_the_picture_of_an_axial_frame_is_the_slice_itself(box):
    frames = axial_frames(box, range(2, 6))
    for plane, frame in zip(range(2, 6), frames, strict=True):
        np.testing.assert_array_equal(sample_mask(box, frame, np.arange(20.0), np.arange(30.0)), box.voxels[plane])


def test_a_picture_shows_any_part_and_nothing_beyond_the_grid(box):
    (frame,) = axial_frames(box, range(3, 4))
    seen = sample_mask(box, frame, np.arange(-5, 12.0), np.array([4.0, 28.0, 35.0]))
    assert not seen[:5].any() and not seen[:, 2].any()
    np.testing.assert_array_equal(seen[5:, :2], box.voxels[3, :12, [4, 28]].T)


def test_a_fan_shows_a_ball_about_its_eye_as_a_disk_in_every_slice(vault):
    affine = np.eye(4)
    affine[:3, 3] = CENTRE - 30
    index = np.indices((61, 61, 61)) - 30
    ball = Volume((index**2).sum(axis=0) <= 25**2, affine)
    across = np.arange(-30, 31.0)
    disk = across[:, None] ** 2 + across**2
    for frame in make_fans(vault, 2)[1].frames(CENTRE)[::20]:
        seen = sample_mask(ball, frame, across, across)
        assert seen[disk <= 24**2].all() and not seen[disk >= 26**2].any()
