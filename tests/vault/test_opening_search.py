"""Openings found without a hint, against the phantoms' known cutters."""

from dataclasses import replace

import numpy as np
import pytest
from hollow_ball import pierced
from scipy import ndimage

from cranio_nb.errors import InputRefused, NoOpening
from cranio_nb.methods.design import design
from cranio_nb.stages.segmentation import bone_of
from cranio_nb.vault import opening_search
from cranio_nb.vault.opening_search import find_openings, survey_openings
from cranio_nb.vault.smallest_hole import smallest_hole_mm
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


# heads with three holes each, the last 10 to 14 mm wide: below the border of the vault, blurred, filled where it is cut
# flat; then seen aslant by six rays, blurred to a sixth of its rim, and to a third of it
HARDLY_SHOWN = [
    (20074, Pose(-17.000212419345093, -20.801298054095, 133.08742685568063), 4.603194502028268, "vault", ("holder",)),
    (20105, Pose(-17.08083568591129, 74.28321352455391, 5.526829291196151), 4.461219045, "vault", ("holder", "tube")),
    (21024, Pose(-16.94148617278539, 13.492497693373366, -16.948865211466426), 2.4918526903551323, "vault", ()),
    (
        52002,
        Pose(25.038237138436436, -15.548204739675946, -30.535507374497286),
        2.405105637729946,
        "neck",
        ("drain", "plates"),
    ),
    (52028, Pose(26.872020257320415, 29.410560118651205, 129.79138231653252), 4.621466080659742, "neck", ("couch",)),
    (63149, Pose(28.896591385976592, -17.37081424309858, 153.390395852829), 4.870200955188263, "neck", ("holder",)),
]


@pytest.mark.parametrize(("seed", "pose", "slice_mm", "reach", "around"), HARDLY_SHOWN)
def test_a_hole_that_the_voxels_hardly_show_is_doubtful_and_not_left_out(seed, pose, slice_mm, reach, around):
    case = face_case("tiny", seed, holes=3, pose=pose, slice_mm=slice_mm, reach=reach, around=around)
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
        found = survey_openings(pierced(diameter_mm, slice_mm))
        assert bool(found) == (diameter_mm >= least_mm)


def test_a_hole_that_is_filled_as_a_pore_of_slices_that_cut_it_flat_is_named():
    """55 mm2, less than the pores of the diploe that are filled, at the top of a ball of bone."""
    scan = pierced(8.4, 1.0, at_top=True)
    bone = bone_of(scan)
    assert (bone.voxels & ~scan.voxels).any() and not survey_openings(bone)
    (found,) = survey_openings(bone, scan=scan)
    assert found.verdict.kind == "doubtful" and found.opening.direction[2] > 0.99
    hu = scan.with_voxels(np.where(scan.voxels, 1000, 40).astype(np.int16))
    assert [one.verdict for one in survey_openings(bone, scan=hu)] == [found.verdict]


def test_the_bone_that_is_closed_is_open_where_a_chosen_opening_was_filled():
    scan = pierced(8.4, 1.0, at_top=True)
    bone = bone_of(scan)
    (found,) = survey_openings(bone, scan=scan)
    opened = opening_search.bone_around(bone, scan, [found.opening])
    np.testing.assert_array_equal(opened.voxels, scan.voxels & bone.voxels)  # there is no other pore
    made = design(opened, [found.opening])
    hole = np.pi * 8.4**2 / 4 * 6
    # a rim of pixels of 1.5 mm more or less
    assert abs(made.patch.voxels.sum() * 2.25 - hole) < np.pi * 8.4 * 6 * 0.75
    # an opening that was not filled leaves the bone as it is
    cut = pierced(30.0, 1.0)
    openings = find_openings(cut)
    assert opening_search.bone_around(cut, cut, openings) is cut


@pytest.mark.parametrize("slice_mm", [1.5, 4.5])
def test_where_nothing_is_open_the_smallest_hole_that_would_be_seen_is_said(slice_mm):
    with pytest.raises(NoOpening, match=f"can show for sure is {smallest_hole_mm(slice_mm):.0f} mm wide"):
        find_openings(pierced(0.0, slice_mm))


def test_a_hint_across_which_bone_lies_is_left_out():
    """A hole of 6 mm in slices of 4.5 mm: soft it is doubtful, with a film of bone in it nothing."""
    bone = pierced(6.0, 4.5)
    whole = pierced(0.0, 4.5)
    for hu_of_film, kinds in ((40, ["doubtful"]), (700, [])):
        hu = np.where(bone.voxels, 1000, np.where(whole.voxels, hu_of_film, 40)).astype(np.int16)
        found = survey_openings(bone, scan=bone.with_voxels(hu))
        assert [one.verdict.kind for one in found] == kinds


@pytest.mark.parametrize(
    ("strip_mm", "kind"), [(0, "cut"), (5, "cut"), (14, "doubtful"), (30, "natural")], ids=lambda value: f"{value}"
)
def test_a_drain_over_a_hole_is_no_bone_and_a_film_all_over_it_is(strip_mm, kind):
    """A hole of 24 mm in a ball of bone, crossed by a strip of 300 HU, 3 mm thick, of some width."""
    bone = pierced(24.0, 1.0)
    away_xyz = bone.to_world(np.moveaxis(np.indices(bone.shape), 0, -1)) - 84.0  # from the middle of the ball
    (x, y, _), away = np.moveaxis(away_xyz, -1, 0), np.linalg.norm(away_xyz, axis=-1)
    strip = (np.abs(y) < strip_mm / 2) & (x > 0) & (away > 72) & (away < 75) & ~bone.voxels
    scan = bone.with_voxels(np.where(bone.voxels, 1000, np.where(strip, 300, 40)).astype(np.int16))
    assert [one.verdict.kind for one in survey_openings(bone, scan=scan)] == [kind]
