import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import ndimage
from spherical_cap import CENTRE, HALF_ANGLE, RADIUS, THICKNESS, spherical_cap

from cranio_nb.errors import InputRefused
from cranio_nb.geometry.face_sides import label_faces
from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.mesh import INNER, OUTER, RIM
from cranio_nb.stages.surface_reconstruction import extract_surface, measure_deviation
from cranio_nb.volume import Volume


def tilted(spacing, angle=0.3, flip=(1, 1, 1), origin=(40.0, -90.0, 812.0)):
    """Affine with a tilt, unequal spacing, optional flips and a far origin."""
    c, s = np.cos(angle), np.sin(angle)
    axes = np.array([[0, 0, 1], [0, c, -s], [s, 0, c]]).T[:, ::-1]
    axes = np.linalg.qr(axes)[0] * flip
    affine = np.eye(4)
    affine[:3, :3] = axes * spacing
    affine[:3, 3] = origin
    return affine


def broad_faces(mesh, towards, thickness=THICKNESS):
    """Faces well inside the cap, the true radius for each, and its outward direction."""
    offset = mesh.centres - CENTRE
    radius = np.linalg.norm(offset, axis=1)
    angle = np.degrees(np.arccos(offset @ towards / radius))
    truth = np.where(radius > RADIUS - thickness / 2, RADIUS, RADIUS - thickness)
    return angle < HALF_ANGLE - 8, truth, radius, offset / radius[:, None]


@pytest.mark.parametrize("flip", [(1, 1, 1), (-1, 1, 1), (1, -1, -1), (-1, -1, -1)])
@pytest.mark.parametrize("smooth", [False, True])
def test_a_ball_on_any_grid_has_its_volume_and_stands_in_its_place(flip, smooth):
    affine = tilted((1.1, 0.45, 0.6), flip=flip)
    grid = Volume(np.zeros((30, 60, 50), bool), affine)
    centre = grid.to_world((14.3, 29.6, 24.2))
    inside = np.linalg.norm(grid.to_world(np.stack(np.indices(grid.shape), axis=-1)) - centre, axis=-1) <= 11
    mesh = extract_surface(grid.with_voxels(inside), smooth=smooth)
    assert check_mesh(mesh).sound
    np.testing.assert_allclose(mesh.volume, 4 / 3 * np.pi * 11**3, rtol=0.01)
    np.testing.assert_allclose(mesh.vertices.mean(axis=0), centre, atol=0.1)


def test_raw_surface_stands_midway_between_voxels():
    voxels = np.zeros((5, 6, 7), bool)
    voxels[1:4, 2:5, 3:6] = True
    mesh = extract_surface(Volume(voxels, np.eye(4)), smooth=False)
    np.testing.assert_array_equal(mesh.vertices.min(axis=0), (0.5, 1.5, 2.5))
    np.testing.assert_array_equal(mesh.vertices.max(axis=0), (3.5, 4.5, 5.5))


def test_a_patch_that_fills_its_grid_is_closed():
    assert check_mesh(extract_surface(Volume(np.ones((3, 4, 5), bool), np.eye(4)))).sound


def test_one_voxel_has_a_surface():
    assert check_mesh(extract_surface(Volume(np.ones((1, 1, 1), bool), np.eye(4)))).sound


def test_an_empty_patch_is_refused():
    with pytest.raises(InputRefused) as refusal:
        extract_surface(Volume(np.zeros((3, 3, 3), bool), np.eye(4)))
    assert refusal.value.code == "EmptyPatch"


def test_the_patch_is_not_changed_and_the_result_is_the_same_twice():
    patch, _, _ = spherical_cap((2.5, 1.0, 1.0))
    before = patch.voxels.copy()
    first, second = extract_surface(patch), extract_surface(patch)
    np.testing.assert_array_equal(patch.voxels, before)
    np.testing.assert_array_equal(first.vertices, second.vertices)


def test_a_patch_in_a_large_empty_grid_gives_the_same_mesh_as_cropped():
    patch, _, _ = spherical_cap((2.0, 1.0, 1.0))
    box = ndimage.find_objects(patch.voxels.view(np.uint8))[0]
    np.testing.assert_allclose(extract_surface(patch).vertices, extract_surface(patch.crop(box)).vertices, atol=1e-9)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), sigma=st.sampled_from([0, 0.7, 1.0, 2.0]), planes=st.sampled_from([0.45, 1, 5]))
def test_any_mask_gives_a_solid_raw_and_smooth(seed, sigma, planes):
    noise = np.random.default_rng(seed).standard_normal((8, 9, 10))
    mask = (ndimage.gaussian_filter(noise, sigma) if sigma else noise) > 0
    patch = Volume(mask, np.diag([planes, 0.45, 0.45, 1]))
    for smooth in (False, True):
        report = check_mesh(extract_surface(patch, smooth=smooth))
        assert report.sound, report


@pytest.mark.parametrize("planes", [0.6, 2.5, 5.0])
def test_smoothing_moves_no_vertex_more_than_half_a_voxel_and_keeps_faces_and_volume(planes):
    patch, _, _ = spherical_cap((planes, 0.8, 0.8))
    raw, smooth = extract_surface(patch, smooth=False), extract_surface(patch)
    np.testing.assert_array_equal(raw.faces, smooth.faces)
    moved = patch.to_voxel(smooth.vertices) - patch.to_voxel(raw.vertices)
    assert np.abs(moved).max() <= 0.5 + 1e-6
    np.testing.assert_allclose(smooth.volume, raw.volume, rtol=0.01)
    found = measure_deviation(raw, smooth)
    assert 0 < found.mean_mm < found.max_mm <= np.linalg.norm(patch.spacing) / 2 + 1e-6


@pytest.mark.parametrize("planes, surface_gain, normal_gain", [(0.8, 2.5, 7), (2.5, 3, 5), (5.0, 3, 5)])
def test_smoothing_brings_the_surface_and_its_normals_nearer_to_a_sphere(planes, surface_gain, normal_gain):
    patch, _, towards = spherical_cap((planes, 0.8, 0.8))
    error, turn = {}, {}
    for smooth in (False, True):
        mesh = extract_surface(patch, smooth=smooth)
        broad, truth, radius, away = broad_faces(mesh, towards)
        error[smooth] = np.average(np.abs(radius - truth)[broad], weights=mesh.areas[broad])
        lean = np.abs(np.einsum("fd,fd->f", mesh.normals, away))[broad]
        turn[smooth] = np.average(np.degrees(np.arccos(np.clip(lean, 0, 1))) ** 2, weights=mesh.areas[broad]) ** 0.5
    assert error[True] * surface_gain < error[False]
    assert turn[True] * normal_gain < turn[False]


@pytest.mark.real
def test_a_true_implant_of_a_real_skull_comes_out_as_a_solid_with_three_sides(real_data):
    nrrd = pytest.importorskip("nrrd")
    masks = []
    for name in ("implant", "defective"):
        data, header = nrrd.read(str(real_data / "skullfix" / "cases" / "003" / f"{name}.nrrd"))
        affine = np.eye(4)
        affine[:3, :3], affine[:3, 3] = header["space directions"].T, header["space origin"]
        masks.append(Volume(np.ascontiguousarray(data, bool), affine).canonical())
    implant, skull = masks
    mesh = extract_surface(implant)
    report = check_mesh(mesh)
    assert report.manifold and report.n_crossings == 0 and report.n_unclear == 0
    np.testing.assert_allclose(mesh.volume, implant.voxels.sum() * implant.voxel_volume, rtol=0.01)
    bone = skull.to_world(np.argwhere(skull.voxels[::4, ::4, ::4]) * 4)
    sides = label_faces(mesh, skull, (bone.min(axis=0) + bone.max(axis=0)) / 2)
    share = np.bincount(sides, weights=mesh.areas, minlength=3) / mesh.areas.sum()
    assert share[OUTER] > share[INNER] > share[RIM] > 0.1
