"""Openings found without a hint, against the phantoms' known cutters."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.errors import InputRefused, NoOpening
from cranio_nb.stages.segmentation import bone_of
from cranio_nb.vault import opening_search
from cranio_nb.vault.head_frame import HeadFrame, find_head_frame
from cranio_nb.vault.opening_search import find_openings, survey_openings
from cranio_nb.vault.outermost_bone import STEP_DEG, OutermostBone, vertex_rays
from cranio_nb.vault.ray_grid import RayGrid
from cranio_nb.vault.smallest_hole import smallest_hole_mm
from cranio_nb.vault.thin_bone import Material
from cranio_nb.volume import Volume
from data_synth import DEFECTS, Pose, face_case, scan

OPEN = [name for name in DEFECTS if name != "partial"]


def holes(case):
    """Free part of every cutter: the planes (first, end) of the missing bone, its centre (mm), its mask."""
    labels, n = ndimage.label(case.implant, np.ones((3, 3, 3)))
    for i in range(1, n + 1):
        index = np.argwhere(labels == i)
        centre = index.mean(axis=0) @ case.affine[:3, :3].T + case.affine[:3, 3]
        yield (index[:, 0].min(), index[:, 0].max() + 1), centre, labels == i


def matched(openings, case):
    """Pairs of a true hole and the opening nearest to it."""
    for planes, centre, mask in holes(case):
        yield planes, centre, mask, min(openings, key=lambda found: np.linalg.norm(found.centre - centre))


@pytest.mark.parametrize("defect", OPEN)
def test_every_opening_of_a_named_defect_is_found_where_it_is(defect, phantom, openings):
    case, found = phantom(defect), openings(defect)
    assert len(found) == len(DEFECTS[defect])
    for planes, centre, mask, opening in matched(found, case):
        # the sheet and a bevelled piece of a sphere do not weigh a hole's places alike
        assert np.linalg.norm(opening.centre - centre) < 5.0
        np.testing.assert_allclose(opening.planes, planes, atol=1)
        covered = (opening.sheet.voxels & mask).sum()
        assert covered > 0.6 * opening.sheet.voxels.sum()
        assert not (opening.sheet.voxels & case.bone).any()
        outwards = centre - opening.head_centre
        assert opening.direction @ outwards / np.linalg.norm(outwards) > np.cos(np.radians(2))


def test_openings_come_largest_first_and_share_a_centre(openings):
    found = openings("multiple")
    sizes = [opening.sheet.voxels.sum() for opening in found]
    assert sizes == sorted(sizes, reverse=True)
    for opening in found[1:]:
        np.testing.assert_array_equal(opening.head_centre, found[0].head_centre)
        assert not (opening.sheet.voxels & found[0].sheet.voxels).any()


def test_two_openings_are_the_two_found_alone(phantom, openings):
    """Far-apart defects do not see each other: their union is that of the single runs."""
    case, both = phantom("bilateral"), openings("bilateral")
    for _, _, mask, opening in matched(both, case):
        alone = Volume(case.bone | (case.implant & ~mask), case.affine)
        (single,) = find_openings(alone)
        np.testing.assert_allclose(single.centre, opening.centre, atol=1.5)
        a, b = single.sheet.voxels, opening.sheet.voxels
        assert 2 * (a & b).sum() / (a.sum() + b.sum()) > 0.9


@pytest.mark.parametrize("defect", ["unilateral", "vertex", "partial"])
def test_a_complete_or_only_dented_skull_has_no_opening(defect, phantom):
    case = phantom(defect)
    for voxels in (case.complete, case.bone) if defect == "partial" else (case.complete,):
        with pytest.raises(NoOpening) as refused:
            find_openings(Volume(voxels, case.affine))
        assert refused.value.code == "NoOpening"


@pytest.mark.parametrize(
    ("defect", "axis", "keep"),
    [
        ("unilateral", 0, "low"),
        ("unilateral", 0, "high"),
        ("unilateral", 1, "low"),
        ("unilateral", 2, "low"),
        ("vertex", 0, "low"),
    ],
)
def test_an_opening_that_leaves_the_image_is_refused(defect, axis, keep, phantom, skull):
    """The image ends in the middle of the hole, so that half of its rim is missing."""
    hit = np.flatnonzero(phantom(defect).implant.any(axis=tuple({0, 1, 2} - {axis})))
    middle = int(hit[0] + hit[-1]) // 2
    box = [slice(None)] * 3
    box[axis] = slice(middle) if keep == "low" else slice(middle, None)
    with pytest.raises(InputRefused, match="outside the image") as refused:
        find_openings(skull(defect).crop(tuple(box)))
    assert refused.value.code == "OpeningLeavesImage"


def test_a_mask_without_bone_is_no_vault():
    with pytest.raises(InputRefused) as refused:
        find_openings(Volume(np.zeros((40, 64, 64), bool), np.eye(4)))
    assert refused.value.code == "NoVault"


def test_a_slab_of_bone_is_no_vault():
    voxels = np.zeros((40, 64, 64), bool)
    voxels[10:30, 20:40, 20:24] = True
    with pytest.raises(InputRefused, match="cavity") as refused:
        find_openings(Volume(voxels, np.eye(4)))
    assert refused.value.code == "NoVault"


def rotated(affine, degrees, shift):
    x, y, z = np.radians(degrees)
    cx, sx, cy, sy, cz, sz = np.cos(x), np.sin(x), np.cos(y), np.sin(y), np.cos(z), np.sin(z)
    turn = (
        np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
        @ np.array([[cy, 0, sy], [0, 1, 0], [-sy, 0, cy]])
        @ np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]])
    )
    moved = np.eye(4)
    moved[:3, :3], moved[:3, 3] = turn, shift
    return moved @ affine


@pytest.mark.parametrize("degrees", [(0, 0, 0), (38, 0, 0), (0, 25, 15), (-20, 12, -30)])
def test_where_the_header_puts_the_head_moves_nothing_in_the_voxels(degrees, skull, openings):
    bone, (here,) = skull("unilateral"), openings("unilateral")
    there_affine = rotated(bone.affine, degrees, (311.0, -47.5, 905.0))
    (there,) = find_openings(Volume(bone.voxels, there_affine))
    np.testing.assert_array_equal(there.sheet.voxels, here.sheet.voxels)
    move = there_affine @ np.linalg.inv(bone.affine)
    np.testing.assert_allclose(there.centre, move[:3, :3] @ here.centre + move[:3, 3], atol=1e-6)
    np.testing.assert_allclose(there.direction, move[:3, :3] @ here.direction, atol=1e-9)


@pytest.mark.parametrize("defect", ["unilateral", "frontal", "vertex"])
def test_flipping_left_and_right_mirrors_the_opening(defect, skull, openings):
    bone = skull(defect)
    (one,), (other,) = openings(defect), find_openings(Volume(bone.voxels[:, :, ::-1].copy(), bone.affine))
    a, b = one.sheet.voxels, other.sheet.voxels[:, :, ::-1]
    thick = np.ones((3, 3, 3), bool)
    assert not (a & ~ndimage.binary_dilation(b, thick)).any()
    assert not (b & ~ndimage.binary_dilation(a, thick)).any()
    assert one.planes == other.planes


def test_air_around_the_head_changes_nothing(skull, openings):
    bone = skull("round")
    padded_affine = bone.affine.copy()
    padded_affine[:3, 3] = bone.to_world([-3, -6, -9])
    padded = Volume(np.pad(bone.voxels, ((3, 3), (6, 6), (9, 9))), padded_affine)
    (here,), (there,) = openings("round"), find_openings(padded)
    np.testing.assert_allclose(there.head_centre, here.head_centre, atol=2.0)
    np.testing.assert_allclose(there.centre, here.centre, atol=1.0)


def test_a_wider_hole_contains_the_narrower(phantom):
    """Growing the defect never shrinks the opening."""
    case = phantom("round", 2)
    planes_before, sheet_before = None, 0
    for diameter in (25.0, 40.0, 55.0):
        cutter = case.head.cutters[0]
        sine = diameter / 2 / float(case.head.outer_radius(cutter.axes[2]))
        head = replace(case.head, cutters=(replace(cutter, half_angles=np.full(2, 2 * np.sin(np.arcsin(sine) / 2))),))
        (opening,) = find_openings(Volume(scan(head, case.affine, case.bone.shape)[1], case.affine))
        sheet = opening.sheet.voxels.sum()
        if planes_before:
            assert opening.planes[0] <= planes_before[0] and opening.planes[1] >= planes_before[1]
        assert sheet > sheet_before
        planes_before, sheet_before = opening.planes, sheet


def test_openings_narrower_than_asked_for_are_not_openings(skull):
    bone = skull("burr_hole")  # 12 to 15 mm
    assert len(find_openings(bone, min_diameter_mm=6.0)) == 1
    with pytest.raises(NoOpening):
        find_openings(bone, min_diameter_mm=25.0)


def test_the_bone_is_not_modified(phantom, skull):
    before = phantom("unilateral").bone.copy()
    find_openings(skull("unilateral"))  # its arrays are read-only
    np.testing.assert_array_equal(phantom("unilateral").bone, before)


# heads with three holes each, the last 12 to 14 mm wide: below the vault's border, blurred, filled where it is cut flat
HARDLY_SHOWN = [
    (20074, Pose(-17.000212419345093, -20.801298054095, 133.08742685568063), 4.603194502028268, ("holder",)),
    (20105, Pose(-17.08083568591129, 74.28321352455391, 5.526829291196151), 4.461219045, ("holder", "tube")),
    (21024, Pose(-16.94148617278539, 13.492497693373366, -16.948865211466426), 2.4918526903551323, ()),
]


@pytest.mark.parametrize(("seed", "pose", "slice_mm", "around"), HARDLY_SHOWN)
def test_a_hole_that_the_slices_hardly_show_is_doubtful_and_not_left_out(seed, pose, slice_mm, around):
    case = face_case("tiny", seed, holes=3, pose=pose, slice_mm=slice_mm, reach="vault", around=around)
    scan = Volume(case.hu, case.affine)
    found = survey_openings(bone_of(scan), scan=scan)
    assert [one.verdict.kind for one in found] == ["cut", "cut", "doubtful"]
    assert [one.number for one in found] == [1, 2, 3]
    # each over a hole of its own
    labels, _ = ndimage.label(case.implant, np.ones((3, 3, 3)))
    near = ndimage.grey_dilation(labels, size=(3, 5, 5))
    assert len({np.bincount(near[one.opening.sheet.voxels])[1:].argmax() for one in found}) == 3


@pytest.mark.parametrize("diameter_mm", [6.0, 9.0, 12.0])
def test_in_thick_slices_a_small_hole_is_named_and_in_thin_ones_what_is_too_small_is_none(diameter_mm):
    """A ball of bone with one round hole above it."""
    for slice_mm, least_mm in ((1.0, 8.0), (4.5, 6.0)):
        found = survey_openings(holed_ball(diameter_mm, slice_mm))
        assert bool(found) == (diameter_mm >= least_mm)


def test_a_hole_that_is_filled_as_a_pore_of_slices_that_cut_it_flat_is_named():
    """55 mm2, less than the pores of the diploe that are filled, at the top of a ball of bone."""
    scan = holed_ball(8.4, 1.0, at_top=True)
    bone = bone_of(scan)
    assert (bone.voxels & ~scan.voxels).any() and not survey_openings(bone)
    (found,) = survey_openings(bone, scan=scan)
    assert found.verdict.kind == "doubtful" and found.opening.direction[2] > 0.99
    hu = scan.with_voxels(np.where(scan.voxels, 1000, 40).astype(np.int16))
    assert [one.verdict for one in survey_openings(bone, scan=hu)] == [found.verdict]


def holed_ball(diameter_mm, slice_mm, *, at_top=False):
    """A hollow ball of 75 mm, its wall 6 mm, with a hole at its side or its top."""
    z, y, x = (np.arange(-84.0, 84.1, step) for step in (slice_mm, 1.5, 1.5))
    z, y, x = z[:, None, None], y[:, None], x
    away = np.sqrt(x**2 + y**2 + z**2)
    bone = (
        (away <= 75)
        & (away >= 69)
        & ~((np.hypot(y, x if at_top else z) <= diameter_mm / 2) & ((z if at_top else x) > 0))
    )
    return Volume(bone, np.array([[0, 0, 1.5, 0], [0, 1.5, 0, 0], [slice_mm, 0, 0, 0], [0, 0, 0, 1.0]]))


# What the steps of the search give on a hollow ball whose every length is known.

OUTER_MM, WALL_MM, VOXEL_MM, EDGE_MM = 75.0, 6.0, 1.5, 84.0
TOP = np.array([0.0, 0.0, 1.0])


def places():
    """World mm of the voxels (x, y, z), each (P, R, C), and the affine; the ball's centre is 0."""
    axis = np.arange(-EDGE_MM, EDGE_MM + 0.1, VOXEL_MM)
    z, y, x = np.meshgrid(axis, axis, axis, indexing="ij", sparse=True)
    affine = np.diag([VOXEL_MM] * 3 + [1.0])[[2, 1, 0, 3]]
    affine[:3, 3] = -EDGE_MM
    return (x, y, z), affine


def ball(hole=TOP, angle_deg=15.0):
    """The ball with a cone cut out about a direction, and the radius of each voxel."""
    xyz, affine = places()
    away = np.sqrt(sum(a**2 for a in xyz))
    cone = sum(a * h for a, h in zip(xyz, hole, strict=True)) >= away * np.cos(np.radians(angle_deg))
    return Volume((away <= OUTER_MM) & (away >= OUTER_MM - WALL_MM) & ~cone, affine), away, cone


def rays_of_ball(hole=TOP, angle_deg=15.0, seen_mm=EDGE_MM):
    """The same in closed form: rays about the vertex, the outer radius along them, and the rays through the hole."""
    grid = RayGrid(np.zeros(3), np.eye(3), np.radians(STEP_DEG), 153)
    through = grid.directions @ hole >= np.cos(np.radians(angle_deg))
    radius = np.where(through, np.nan, OUTER_MM)
    return OutermostBone(grid, radius, np.full(radius.shape, seen_mm)), through


def signs_of(bone, scan=None, hole=TOP, angle_deg=15.0, confidence=0.7):
    outermost, rays = rays_of_ball(hole, angle_deg)
    frame = HeadFrame(np.zeros(3), np.eye(3), np.eye(3), confidence, 0.0, 0.0, "")
    met = outermost.grid.directions[~rays]
    material = Material.of(bone, scan, outermost.grid.centre, met)
    return opening_search._signs(bone, outermost, rays, np.full(rays.shape, OUTER_MM), material, frame)


@pytest.mark.parametrize("angle_deg", [6.0, 15.0, 25.0])
def test_signs_of_a_round_hole_at_the_vertex(angle_deg):
    bone, _, _ = ball(angle_deg=angle_deg)
    signs = signs_of(bone, angle_deg=angle_deg)
    # distances from the middle of the map are arcs; the hole is counted in rays of 2 mm
    assert signs.diameter_mm == pytest.approx(2 * np.radians(angle_deg) * OUTER_MM, abs=1.0)
    assert (signs.across_mm, signs.on_vault, signs.two_walls) == (0, 1, 0)
    assert signs.rim_mm == pytest.approx(WALL_MM, abs=VOXEL_MM / 2)
    assert (signs.frame, signs.plain, signs.with_hu) == (0.7, True, False)


@pytest.mark.parametrize(("from_mm", "to_mm", "across_mm"), [(72, 75, 3), (78, 79.5, 1.5), (83, 84.5, 0), (50, 60, 0)])
def test_bone_counts_as_lying_across_up_to_where_the_head_may_bulge(from_mm, to_mm, across_mm):
    """Above a hole of 39 mm: 2 mm, and a fifth of half its width."""
    bone, away, cone = ball()
    closed = bone.with_voxels(bone.voxels | (cone & (away >= from_mm) & (away < to_mm)))
    assert signs_of(closed).across_mm == pytest.approx(across_mm, abs=VOXEL_MM / 2)


def test_only_the_middle_of_an_opening_says_whether_bone_lies_across():
    """A shelf of bone along the rim, to 11 of 15 degrees: seven tenths of the way lie free."""
    bone, away, cone = ball()
    _, _, inner = ball(angle_deg=11.0)
    shelf = cone & ~inner & (away <= OUTER_MM) & (away >= OUTER_MM - 3)
    assert signs_of(bone.with_voxels(bone.voxels | shelf)).across_mm == 0
    half = cone & (places()[0][0] > 6) & (away <= OUTER_MM) & (away >= OUTER_MM - 3)
    assert signs_of(bone.with_voxels(bone.voxels | half)).across_mm == 0  # less than half of the middle


def test_with_hu_thin_bone_counts_by_what_it_attenuates():
    bone, away, cone = ball()
    hu = np.where(bone.voxels, 1040, 40)
    hu[cone & (away >= 72) & (away < 75)] = 540  # half of it bone
    signs = signs_of(bone, bone.with_voxels(hu.astype(np.int16)))
    assert signs.across_mm == pytest.approx(1.5, abs=VOXEL_MM / 2) and signs.with_hu


@pytest.mark.parametrize("degrees", [80.0, 88.0, 96.0])
def test_share_of_an_opening_above_the_base(degrees):
    """At the side of the head the base begins 88 degrees from the vertex."""
    side = np.array([np.sin(np.radians(degrees)), 0.0, np.cos(np.radians(degrees))])
    bone, _, _ = ball(side, 12.0)
    # of a disk, the part within a distance of its middle; a row of rays more or less
    t = np.clip((88.0 - degrees) / 12.0, -1, 1)
    share = 0.5 + (t * np.sqrt(1 - t**2) + np.arcsin(t)) / np.pi
    assert signs_of(bone, hole=side, angle_deg=12.0).on_vault == pytest.approx(share, abs=1.5 / 24 + 0.02)


def test_walls_behind_the_rim_are_another_wall_from_16_mm_on():
    bone, away, _ = ball()
    right = places()[0][0] > 0
    far = bone.voxels | (right & (away >= 45) & (away <= 50))
    signs = signs_of(bone.with_voxels(far))
    assert signs.two_walls == pytest.approx(0.5, abs=0.08)  # a line of rays along the border
    assert signs.rim_mm == pytest.approx(WALL_MM, abs=VOXEL_MM / 2)
    # nearer it is taken for the diploe, and for a part of the rim
    near = signs_of(bone.with_voxels(bone.voxels | ((away >= 61) & (away <= 66))))
    assert near.two_walls == 0 and near.rim_mm == pytest.approx(WALL_MM + 5, abs=VOXEL_MM)
    assert signs_of(bone.with_voxels(bone.voxels | ((away >= 10) & (away <= 13)))).two_walls == 0  # 60 mm are looked at


def test_a_membrane_continues_what_is_linear_and_leaves_the_bone():
    outermost, rays = rays_of_ball(angle_deg=12.0)
    v, u = outermost.grid.offsets
    _, other = rays_of_ball(np.array([np.sin(0.9), 0.0, np.cos(0.9)]), 9.0)
    slope = 70 + 8 * v - 5 * u
    known = OutermostBone(outermost.grid, np.where(rays | other, np.nan, slope), outermost.seen)
    radius = opening_search._bridged_radius(known, [rays, other])
    np.testing.assert_array_equal(radius[~(rays | other)], slope[~(rays | other)])
    # what 200 rounds leave of the nearest rim's radius: the slowest wave of a disk of 8 rays fades to 1e-4
    assert np.abs(radius - slope).max() < 0.02


@pytest.mark.parametrize("seen_mm", [84.0, 66.0])
def test_a_sheet_fills_the_opening_below_the_outer_surface_or_the_edge_of_the_image(seen_mm):
    bone, away, _ = ball()
    outermost, rays = rays_of_ball(seen_mm=seen_mm)
    sheet = opening_search._sheet(bone, outermost, rays, np.full(rays.shape, OUTER_MM))
    top = min(seen_mm, OUTER_MM)
    voxels, half = sheet.voxels, VOXEL_MM * np.sqrt(3) / 2
    assert away[voxels].max() <= top + half and away[voxels].min() >= top - 4.0 - half
    assert not (voxels & bone.voxels).any()
    # half a ray more or less at the border
    _, _, wide = ball(angle_deg=15.0 + STEP_DEG)
    _, _, narrow = ball(angle_deg=15.0 - STEP_DEG)
    assert not (voxels & ~wide & (np.abs(away - top + 2) < 1)).any()
    assert voxels[narrow & (away <= top) & (away >= top - 4.0)].all()


def test_pores_that_were_filled_are_those_that_the_scan_shows_soft():
    bone, _, _ = ball()
    assert opening_search._unfilled(bone, None) is bone
    before = bone.voxels.copy()
    hu = np.full(bone.shape, 1000, np.int16)
    soft = np.argwhere(bone.voxels)[::5]
    hu[tuple(soft.T)], hu[tuple(soft[::2].T)] = 150, 149
    kept = opening_search._unfilled(bone, bone.with_voxels(hu))
    np.testing.assert_array_equal(kept.voxels, bone.voxels & (hu >= 150))
    mask = bone.with_voxels(hu >= 150)
    np.testing.assert_array_equal(opening_search._unfilled(bone, mask).voxels, kept.voxels)
    np.testing.assert_array_equal(bone.voxels, before)


def test_an_opening_holds_where_rays_start_how_the_head_lies_and_its_room_in_the_image():
    bone, _, _ = ball(np.array([1.0, 0.0, 0.0]), 14.0)
    frame = replace(find_head_frame(bone), confidence=0.25)
    (one,) = survey_openings(bone, frame=frame)
    np.testing.assert_array_equal(one.opening.head_centre, vertex_rays(bone, frame.trusted_axes).centre)
    np.testing.assert_array_equal(one.opening.head_axes, frame.ray_axes)
    assert one.room_mm == pytest.approx(EDGE_MM - OUTER_MM, abs=VOXEL_MM)
    assert one.verdict.confidence == pytest.approx(0.6 + 0.4 * 0.25)
    (found,) = find_openings(bone, frame=frame)
    np.testing.assert_array_equal(found.sheet.voxels, one.opening.sheet.voxels)


@pytest.mark.parametrize("slice_mm", [1.5, 4.5])
def test_where_nothing_is_open_the_smallest_hole_that_would_be_seen_is_said(slice_mm):
    with pytest.raises(NoOpening, match=f"can show for sure is {smallest_hole_mm(slice_mm):.0f} mm wide"):
        find_openings(holed_ball(0.0, slice_mm))


def test_a_hint_across_which_bone_lies_is_left_out():
    """A hole of 6 mm in slices of 4.5 mm: soft it is doubtful, with a film of bone in it nothing."""
    bone = holed_ball(6.0, 4.5)
    whole = holed_ball(0.0, 4.5)
    for hu_of_film, kinds in ((40, ["doubtful"]), (700, [])):
        hu = np.where(bone.voxels, 1000, np.where(whole.voxels, hu_of_film, 40)).astype(np.int16)
        found = survey_openings(bone, scan=bone.with_voxels(hu))
        assert [one.verdict.kind for one in found] == kinds
