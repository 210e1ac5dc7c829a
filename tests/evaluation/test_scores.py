import dataclasses
import json

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.errors import InputRefused
from cranio_nb.evaluation.rim_gap import distance_to_voxels, rim_gap
from cranio_nb.evaluation.scores import (
    assd,
    border_dice,
    dice,
    distance_stats,
    hd95,
    in_voxels,
    overlap,
    rmse,
    score,
    signed_distance,
    surface_distance,
    surface_distances,
    thickness,
    thickness_rmse,
    volume_ratio,
)
from cranio_nb.geometry.closest_point import nearest
from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.geometry.self_intersection import crossings
from cranio_nb.implant.workshop import DENSITIES, clearance, implant_data, to_trim, undercut
from cranio_nb.mesh import Mesh
from cranio_nb.prosthesis import INNER, OUTER, Prosthesis
from cranio_nb.volume import Volume

EMPTY = np.zeros((6, 7, 8), bool)


def oblique(spacing=(2.5, 0.45, 0.6), flip=(1, 1, 1)):
    rotation = np.linalg.qr(np.array([[0.2, 0.1, 1], [0.3, 1, 0], [1, -0.2, 0.1]]))[0]
    affine = np.eye(4)
    affine[:3, :3] = rotation * flip * spacing
    affine[:3, 3] = (40.0, -95.0, 812.0)
    return affine


def block(start, size=(6, 20, 20), shape=(16, 40, 40)):
    voxels = np.zeros(shape, bool)
    voxels[tuple(slice(a, a + n) for a, n in zip(start, size, strict=True))] = True
    return voxels


def sphere(radius=1.0, centre=(0, 0, 0), subdivisions=4):
    trimesh = pytest.importorskip("trimesh")
    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return Mesh(np.asarray(ball.vertices) + centre, np.asarray(ball.faces, np.intp))


def join(*meshes):
    offsets = np.cumsum([0] + [len(m.vertices) for m in meshes[:-1]])
    faces = [m.faces + n for m, n in zip(meshes, offsets, strict=True)]
    return Mesh(np.concatenate([m.vertices for m in meshes]), np.concatenate(faces))


def weld(mesh):
    vertices, which = np.unique(mesh.vertices.round(9), axis=0, return_inverse=True)
    return Mesh(vertices, which.ravel()[mesh.faces])


def box(size=(1, 1, 1), centre=(0, 0, 0)):
    trimesh = pytest.importorskip("trimesh")
    made = trimesh.creation.box(extents=size)
    return Mesh(np.asarray(made.vertices) + centre, np.asarray(made.faces, np.intp))


class TestMasks:
    @pytest.mark.parametrize("flip", [(1, 1, 1), (-1, 1, 1), (1, -1, -1)])
    @pytest.mark.parametrize("axis", [0, 1, 2])
    def test_a_block_shifted_along_an_axis_has_closed_forms(self, axis, flip):
        spacing, size, n = np.array((2.5, 0.45, 0.6)), np.array((6, 20, 20)), 2
        start = np.array((4, 8, 8))
        grid = oblique(spacing, flip)
        truth = Volume(block(start), grid)
        patch = Volume(block(start + n * np.eye(3, dtype=int)[axis]), grid)
        assert dice(patch, truth) == pytest.approx(1 - n / size[axis])
        assert volume_ratio(patch, truth) == 1
        assert overlap(patch, truth) == (size[axis] - n) * size.prod() // size[axis]
        far = surface_distances(patch, truth)
        assert far.max() == pytest.approx(n * spacing[axis])
        assert assd(patch, truth) == pytest.approx(far.mean())
        assert rmse(patch, truth) == pytest.approx(np.sqrt((far**2).mean()))
        assert 0 < assd(patch, truth) < rmse(patch, truth) < hd95(patch, truth) + 1e-12

    def test_concentric_balls_are_as_far_apart_as_their_radii(self):
        grid = Volume(np.zeros((60, 100, 80), bool), oblique((0.9, 0.5, 0.6)))
        centre = grid.to_world((29.4, 49.7, 39.1))
        radius = np.linalg.norm(grid.to_world(np.stack(np.indices(grid.shape), -1)) - centre, axis=-1)
        small, large = grid.with_voxels(radius <= 18), grid.with_voxels(radius <= 22)
        assert assd(small, large) == pytest.approx(4, abs=0.25)  # half a voxel: surfaces are sets of voxel centres
        assert rmse(small, large) == pytest.approx(4, abs=0.25)
        assert hd95(small, large) == pytest.approx(4, abs=0.6)
        assert dice(small, large) == pytest.approx(2 * 18**3 / (18**3 + 22**3), abs=0.002)
        assert volume_ratio(small, large) == pytest.approx((18 / 22) ** 3, rel=0.005)

    def test_a_missing_part_is_seen_from_both_sides(self):
        whole, half = (Volume(block((4, 8, 8), size), np.eye(4)) for size in ((6, 20, 20), (6, 20, 10)))
        np.testing.assert_allclose(np.sort(surface_distances(half, whole)), np.sort(surface_distances(whole, half)))
        assert hd95(half, whole) > 8

    def test_border_dice_counts_only_voxels_near_bone(self):
        skull = np.zeros((5, 60, 5), bool)
        skull[:, 0, :] = True
        patch, truth = np.zeros_like(skull), np.zeros_like(skull)
        truth[:, 1:40, :] = patch[:, 1:40, :] = True
        patch[:, 12:, :] = False  # wrong only farther than 10 mm from the bone
        at = oblique((1, 1, 1))
        patch, truth, skull = (Volume(v, at) for v in (patch, truth, skull))
        assert border_dice(patch, truth, skull, reach=10.0) == 1
        assert border_dice(patch, truth, skull, reach=12.0) == pytest.approx(2 * 11 / (11 + 12))
        assert dice(patch, truth) == pytest.approx(2 * 11 / (11 + 39))

    @pytest.mark.parametrize("spacing", [(1, 1, 1), (3, 0.5, 0.7)])
    def test_border_dice_agrees_with_a_distance_map(self, spacing):
        rng = np.random.default_rng(3)
        skull = rng.random((20, 40, 40)) < 0.001
        patch, truth = (rng.random(skull.shape) < 0.3 for _ in range(2))
        near = ndimage.distance_transform_edt(~skull, sampling=spacing) <= 5.0
        wanted = 2 * (patch & truth & near).sum() / ((patch & near).sum() + (truth & near).sum())
        at = oblique(spacing)
        found = border_dice(Volume(patch, at), Volume(truth, at), Volume(skull, at), reach=5.0)
        assert found == pytest.approx(wanted, abs=1e-12)

    def test_peer_agrees_on_dice_and_surface_distance(self):
        sitk = pytest.importorskip("SimpleITK")
        rng = np.random.default_rng(5)
        a, b = (ndimage.gaussian_filter(rng.standard_normal((20, 30, 30)), 3) > 0.02 for _ in range(2))
        spacing = (2.0, 0.5, 0.7)
        images = [sitk.GetImageFromArray(v.astype(np.uint8)) for v in (a, b)]
        for image in images:
            image.SetSpacing(spacing[::-1])
        peer = sitk.LabelOverlapMeasuresImageFilter()
        peer.Execute(*images)
        at = np.diag([*spacing, 1])
        assert dice(Volume(a, at), Volume(b, at)) == pytest.approx(peer.GetDiceCoefficient(), abs=1e-12)
        hausdorff = sitk.HausdorffDistanceImageFilter()
        hausdorff.Execute(*images)
        assert surface_distances(Volume(a, at), Volume(b, at)).max() == pytest.approx(hausdorff.GetHausdorffDistance())

    def test_two_empty_masks_agree(self):
        empty = Volume(EMPTY, np.eye(4))
        skull = Volume(~EMPTY, np.eye(4))
        assert dataclasses.astuple(score(empty, empty, skull)) == (1, 1, 0, 0, 0, 1, 0)

    @pytest.mark.parametrize("empty_one", [0, 1])
    def test_one_empty_mask_is_as_wrong_as_can_be(self, empty_one):
        filled = EMPTY.copy()
        filled[2:4, 2:4, 2:4] = True
        pair = [Volume(filled, np.eye(4)), Volume(filled, np.eye(4))]
        pair[empty_one] = Volume(EMPTY, np.eye(4))
        found = score(*pair, Volume(~filled, np.eye(4)))
        assert (found.dice, found.border_dice, found.overlap) == (0, 0, 0)
        assert (found.hd95, found.assd, found.rmse) == (np.inf,) * 3
        assert found.volume_ratio == (0 if empty_one == 0 else np.inf)

    def test_other_grids_and_a_missing_skull_are_refused(self):
        at_home, moved = Volume(EMPTY, np.eye(4)), Volume(EMPTY, oblique())
        for wrong in ((at_home, moved, at_home), (at_home, at_home, moved)):
            with pytest.raises(InputRefused) as refusal:
                score(*wrong)
            assert refusal.value.code == "GridMismatch"
        with pytest.raises(InputRefused) as refusal:
            score(at_home, at_home, at_home)
        assert refusal.value.code == "NoBone"

    def test_a_score_is_plain_numbers(self):
        filled = Volume(block((4, 8, 8)), oblique())
        found = dataclasses.asdict(score(filled, filled, filled.with_voxels(~filled.voxels)))
        assert json.loads(json.dumps(found)) == found
        assert found == dict(dice=1, border_dice=1, hd95=0, assd=0, rmse=0, volume_ratio=1, overlap=0)

    @pytest.mark.real
    @pytest.mark.parametrize("case", ["000", "003", "007"])
    def test_reference_measures_of_real_implants(self, real_data, case):
        nrrd = pytest.importorskip("nrrd")
        folder = real_data / "skullfix"
        reference = json.loads((folder / "reference_measures.json").read_text())[case]
        implant, header = nrrd.read(str(folder / "cases" / case / "implant.nrrd"))
        bone, _ = nrrd.read(str(folder / "cases" / case / "defective.nrrd"))
        implant, bone = (np.ascontiguousarray(v, bool) for v in (implant, bone))
        affine = np.eye(4)
        affine[:3, :3], affine[:3, 3] = header["space directions"].T, header["space origin"]
        changes = {
            "shift_i_plus_1": lambda: np.roll(implant, 1, 0),
            "shift_j_plus_2": lambda: np.roll(implant, 2, 1),
            "shift_k_minus_1": lambda: np.roll(implant, -1, 2),
            "eroded_1": lambda: ndimage.binary_erosion(implant),
            "dilated_1_minus_bone": lambda: ndimage.binary_dilation(implant) & ~bone,
        }
        assert set(reference) == set(changes)
        around = tuple(
            slice(max(s.start - 40, 0), s.stop + 40) for s in ndimage.find_objects(implant.view(np.uint8))[0]
        )
        implant, bone = implant[around], bone[around]  # more than 10 mm around: nothing else is measured
        truth, skull = Volume(implant, affine), Volume(bone, affine)
        for name, wanted in reference.items():
            found = score(truth.with_voxels(changes[name]()), truth, skull)
            ours = {
                "dsc": found.dice,
                "bdsc": found.border_dice,
                "hd95": found.hd95,
                "assd": found.assd,
                "overlap": found.overlap,
                "volume_ratio": found.volume_ratio,
            }
            assert ours == pytest.approx(wanted, abs=1e-3), name


class TestSurfaces:
    def test_nodes_of_a_sphere_lie_the_difference_of_radii_from_another(self):
        found = distance_stats(surface_distance(sphere(10).vertices, sphere(8)))
        assert found.min == pytest.approx(2, abs=1e-9)
        assert 2 <= found.mean <= found.max < 2.03
        assert found.std < 0.01

    def test_one_way_distance_is_zero_where_the_other_surface_is_larger(self):
        whole = sphere(5)
        part = Mesh(whole.vertices, whole.faces[whole.centres[:, 2] > 0])
        used = np.unique(part.faces)
        np.testing.assert_allclose(surface_distance(whole.vertices[used], part), 0, atol=1e-12)
        assert surface_distance(whole.vertices, part).max() > 5

    @pytest.mark.parametrize("size", [1.0, 30.0])
    def test_nearest_place_agrees_with_trimesh(self, size):
        trimesh = pytest.importorskip("trimesh")
        rng = np.random.default_rng(11)
        mesh = Mesh(rng.normal(size=(60, 3)) * size, rng.integers(0, 60, (40, 3)))
        mesh = Mesh(mesh.vertices, mesh.faces[mesh.areas > 1e-6])
        points = rng.normal(size=(300, 3)) * 20
        peer = np.full(300, np.inf)
        for corners in mesh.corners:
            place = trimesh.triangles.closest_point(np.repeat(corners[None], 300, axis=0), points)
            peer = np.minimum(peer, np.linalg.norm(place - points, axis=1))
        found = nearest(points, mesh)
        np.testing.assert_allclose(found.distance, peer, atol=1e-9)
        np.testing.assert_allclose(np.linalg.norm(found.places(mesh) - points, axis=1), peer, atol=1e-9)

    def test_a_few_long_faces_among_many_small_ones_are_not_missed(self):
        far_plate = Mesh(np.array([[-500, -500, -3.0], [500, -500, -3], [0, 800, -3]]), np.array([[0, 1, 2]]))
        mesh = join(sphere(1), far_plate)
        points = np.array([[0, 0, 1.5], [100, 0, 0], [0, 0, -2.5]])
        np.testing.assert_allclose(surface_distance(points, mesh), (0.5, 3, 0.5), atol=0.01)

    def test_sign_tells_outside_from_inside_at_faces_edges_and_corners(self):
        rng = np.random.default_rng(2)
        points = rng.uniform(-2, 2, (2000, 3))
        outside = np.maximum(np.abs(points) - 0.5, 0)
        wanted = np.linalg.norm(outside, axis=1) - np.maximum(0.5 - np.abs(points).max(axis=1), 0)
        np.testing.assert_allclose(signed_distance(points, box()), wanted, atol=1e-12)

    def test_distances_in_voxels_do_not_depend_on_the_grid_in_the_world(self):
        grid = Volume(np.zeros((2, 2, 2), bool), oblique((2.5, 0.45, 0.45)))
        inner, outer = (in_voxels(Mesh(grid.to_world(m.vertices), m.faces), grid) for m in (sphere(8), sphere(10)))
        np.testing.assert_allclose(surface_distance(outer.vertices, inner), 2, atol=0.03)

    def test_thickness_of_a_shell(self):
        thin, thick = (_shell(10, inner) for inner in (8.0, 7.5))
        np.testing.assert_allclose(thickness(thin), 2, atol=0.03)
        assert thickness_rmse(thin, thin) == 0
        assert thickness_rmse(thin, thick) == pytest.approx(0.5, abs=0.03)

    def test_no_surface_is_refused(self):
        nothing = Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
        for measure in (lambda: surface_distance(np.zeros((1, 3)), nothing), lambda: distance_stats(np.zeros(0))):
            with pytest.raises(InputRefused) as refusal:
                measure()
            assert refusal.value.code == "EmptyMesh"


def _shell(outer, inner):
    out, within = sphere(outer), sphere(inner)
    mesh = join(out, Mesh(within.vertices, within.faces[:, ::-1]))
    sides = np.repeat(np.array([OUTER, INNER], np.uint8), [len(out.faces), len(within.faces)])
    return Prosthesis(mesh, sides, None, "none")


class TestFit:
    def test_distance_to_a_voxel_is_to_its_box(self):
        mask = Volume(block((4, 8, 8), (1, 1, 1)), oblique((2.5, 0.45, 0.6)))
        index = np.array([[4, 8, 8], [4.4, 8.5, 7.6], [5.5, 8, 8], [4, 9.5, 8], [4, 8.2, 5.5], [6.5, 10.5, 8]])
        wanted = [0, 0, 2.5, 0.45, 1.2, np.hypot(5, 0.9)]
        np.testing.assert_allclose(distance_to_voxels(mask.to_world(index), mask), wanted, atol=1e-9)

    def test_gap_of_a_rim_that_stands_off_is_known(self):
        bone = Volume(block((0, 0, 0), (16, 40, 20)), np.eye(4))  # its face stands at column 19.5
        for gap in (0.0, 0.3, 1.5):
            wall = Mesh(np.array([[2, 2, 19.5 + gap], [12, 2, 19.5 + gap], [2, 30, 19.5 + gap]]), np.array([[0, 1, 2]]))
            found = rim_gap(wall, bone)
            np.testing.assert_allclose(dataclasses.astuple(found), gap, atol=1e-9)

    def test_gap_is_weighted_by_area(self):
        bone = Volume(block((0, 0, 0), (16, 40, 20)), np.eye(4))
        near = [[2, 2, 19.5], [12, 2, 19.5], [2, 22, 19.5]]  # 100 mm2 that touch
        off = [[2, 2, 21.5], [4, 2, 21.5], [2, 3, 21.5]]  # 1 mm2 at 2 mm
        found = rim_gap(Mesh(np.array(near + off, float), np.array([[0, 1, 2], [3, 4, 5]])), bone)
        assert found.mean == pytest.approx(2 / 101)
        assert (found.p95, found.max) == (0, 2)

    def test_clearance_leaves_the_gap_and_no_more_than_a_voxel(self):
        bone = Volume(block((0, 0, 0), (16, 40, 20)), oblique((2.5, 0.45, 0.6)))
        patch = bone.with_voxels(block((4, 8, 20), (6, 20, 15)))
        for gap, layers in ((0.25, 1), (0.6, 1), (0.61, 2), (1.3, 3)):
            kept = clearance(patch, bone, gap).voxels
            assert not (kept & ~patch.voxels).any()
            assert np.flatnonzero(kept.any(axis=(0, 1)))[0] == 20 + layers
        assert clearance(patch, bone.with_voxels(~bone.voxels & False), 0.4).voxels.sum() == patch.voxels.sum()
        with pytest.raises(InputRefused):
            clearance(patch, bone, 0)

    @pytest.mark.parametrize("lean, share", [(0.0, 0.0), (20.0, 0.0), (-20.0, 1.0), (-3.0, 0.0)])
    def test_undercut_is_the_share_of_walls_that_lean_over(self, lean, share):
        around = np.linspace(0, 2 * np.pi, 60, endpoint=False)
        ring = np.stack([np.cos(around), np.sin(around)], axis=1)
        top, bottom = 20.0, 20 - 5 * np.tan(np.deg2rad(lean))  # lean > 0: narrower below
        vertices = np.vstack([np.c_[top * ring, np.full(60, 5.0)], np.c_[bottom * ring, np.zeros(60)]])
        i, j = np.arange(60), (np.arange(60) + 1) % 60
        rim = Mesh(vertices, np.vstack([np.stack([i, i + 60, j], 1), np.stack([j, i + 60, j + 60], 1)]))
        assert np.einsum("fd,fd->f", rim.normals, rim.centres * [1, 1, 0]).min() > 0
        assert undercut(rim, np.array([0, 0, 2.0])) == pytest.approx(share)

    def test_only_what_lies_under_bone_must_be_trimmed(self):
        bone = Volume(block((8, 0, 0), (6, 40, 15)), np.diag([1, 1, 1, 1]))
        patch = bone.with_voxels(block((2, 5, 5), (6, 30, 30)))  # lies below, its columns 5 to 14 under the bone
        up = np.array([1.0, 0, 0])
        caught = to_trim(patch, bone, up).voxels
        assert caught.any() and not (caught & ~patch.voxels).any()
        assert np.flatnonzero(caught.any(axis=(0, 1))).tolist() == list(range(5, 14))
        assert not to_trim(patch, bone, -up).voxels.any()

    def test_mass_is_volume_times_density(self):
        data = implant_data(box((20, 30, 50), (5, 6, 700)))
        assert data.volume_cm3 == pytest.approx(30)
        assert data.mass_g == pytest.approx({name: 30 * density for name, density in DENSITIES.items()})


class TestMeshCheck:
    def test_a_ball_is_sound_and_as_thick_as_its_diameter(self):
        report = check_mesh(sphere(5, (3, 4, 800)))
        assert report.sound and report.n_parts == 1
        assert report.volume == pytest.approx(4 / 3 * np.pi * 125, rel=0.01)
        assert report.wall_p1 == pytest.approx(10, rel=0.02)

    def test_the_wall_of_a_shell_is_found(self):
        shell = _shell(10, 8.5).mesh
        report = check_mesh(shell)
        assert report.sound and report.n_parts == 2
        assert report.wall_p1 == pytest.approx(1.5, abs=0.1)

    def test_faults_of_single_faces(self):
        ball = sphere(1, subdivisions=2)
        open_ball = check_mesh(Mesh(ball.vertices, ball.faces[1:]))
        assert not open_ball.closed and open_ball.n_open_edges == 3
        flipped = ball.faces.copy()
        flipped[0] = flipped[0, ::-1]
        report = check_mesh(Mesh(ball.vertices, flipped))
        assert report.closed and not report.manifold and report.n_flipped_edges == 3
        assert check_mesh(Mesh(ball.vertices, np.vstack([ball.faces, ball.faces[:1]]))).n_unclear == 1
        assert check_mesh(Mesh(ball.vertices, np.vstack([ball.faces, [[0, 0, 1]]]))).n_unclear == 1
        inverted = check_mesh(Mesh(ball.vertices, ball.faces[:, ::-1]))
        assert inverted.manifold and inverted.volume < 0 and not inverted.sound
        broken = ball.vertices.copy()
        broken[0, 0] = np.nan
        assert not check_mesh(Mesh(broken, ball.faces)).sound

    def test_cubes_that_share_an_edge_or_a_corner_are_not_manifold(self):
        along_edge = check_mesh(weld(join(box(), box(centre=(1, 1, 0)))))
        assert not along_edge.closed and along_edge.n_crossings == 0
        at_corner = check_mesh(weld(join(box(), box(centre=(1, 1, 1)))))
        assert at_corner.closed and at_corner.n_pinches == 1 and not at_corner.manifold
        assert at_corner.n_parts == 2 and at_corner.n_crossings == 0
        assert check_mesh(join(box(), box(centre=(1, 1, 1)))).sound  # apart, merely touching

    def test_self_intersections_that_other_checks_let_pass(self):
        assert check_mesh(join(sphere(), sphere(centre=(0.7, 0.1, 0.2)))).n_crossings > 50
        assert check_mesh(join(sphere(), sphere(0.5))).n_crossings == 0  # nested, not crossing
        spiked = sphere(1, subdivisions=3)
        spike = spiked.vertices.copy()
        spike[0] = -3 * spike[0]
        report = check_mesh(Mesh(spike, spiked.faces))
        assert report.manifold and report.n_crossings > 0 and not report.sound

    def test_crossings_agree_with_edges_through_faces(self):
        rng = np.random.default_rng(8)
        for size in (0.1, 0.5, 2.0):
            corners = rng.random((60, 1, 3)) + size * rng.standard_normal((60, 3, 3))
            soup = Mesh(corners.reshape(-1, 3), np.arange(180).reshape(-1, 3))
            wanted = {(i, j) for i in range(60) for j in range(i) if _pierces(corners[i], corners[j])}
            assert {(max(p), min(p)) for p in crossings(soup).tolist()} == wanted

    def test_faces_in_one_plane_cross_only_where_they_overlap(self):
        a = np.array([[0, 0, 0], [4, 0, 0], [0, 4, 0]], float)
        for shift, crossing in (((1, 1, 0), 1), ((4, 0, 0), 0), ((1, 1, 1e-3), 0), ((0, 0, 0), 1)):
            pair = Mesh(np.vstack([a, a + np.array(shift)]), np.arange(6).reshape(2, 3))
            assert len(crossings(pair)) == crossing

    def test_a_face_folded_back_onto_its_neighbour_crosses_it(self):
        vertices = np.array([[0, 0, 0], [2, 0, 0], [1, 1, 0], [1, 0.5, 0], [1, -1, 0]])
        assert len(crossings(Mesh(vertices, np.array([[0, 1, 2], [1, 0, 3]])))) == 1
        assert len(crossings(Mesh(vertices, np.array([[0, 1, 2], [1, 0, 4]])))) == 0

    def test_no_mesh_is_not_sound(self):
        report = check_mesh(Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp)))
        assert not report.closed and not report.sound and report.n_parts == 0


def _pierces(a, b):
    """Whether an edge of one triangle goes through the other, by signed volumes."""

    def through(segment, triangle):
        def volume(*points):
            p, q, r, s = points
            return np.linalg.det([q - p, r - p, s - p])

        start, end = segment
        sides = [volume(start, end, triangle[k], triangle[(k + 1) % 3]) for k in range(3)]
        crosses_plane = volume(start, *triangle) * volume(end, *triangle) < 0
        return crosses_plane and (min(sides) > 0 or max(sides) < 0)

    return any(through((p[k], p[(k + 1) % 3]), q) for p, q in ((a, b), (b, a)) for k in range(3))
