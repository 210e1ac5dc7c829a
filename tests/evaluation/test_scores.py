"""Overlap and surface distances of masks: closed forms, another library, reference values of real implants."""

import dataclasses
import json

import numpy as np
import pytest
from measured_shapes import EMPTY, block, oblique
from scipy import ndimage

from cranio_nb.errors import InputRefused
from cranio_nb.evaluation.scores import assd, border_dice, dice, overlap, score, surface_distances, volume_ratio
from cranio_nb.volume import Volume


@pytest.mark.parametrize("flip", [(1, 1, 1), (-1, 1, 1), (1, -1, -1)])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_block_shifted_along_an_axis_has_closed_forms(axis, flip):
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
    found = score(patch, truth, skull=truth)
    assert found.assd == assd(patch, truth) == pytest.approx(far.mean())
    assert found.rmse == pytest.approx(np.sqrt((far**2).mean()))
    assert found.hd95 == pytest.approx(np.percentile(far, 95))
    assert 0 < found.assd < found.rmse < found.hd95 + 1e-12


def test_concentric_balls_are_as_far_apart_as_their_radii():
    grid = Volume(np.zeros((60, 100, 80), bool), oblique((0.9, 0.5, 0.6)))
    centre = grid.to_world((29.4, 49.7, 39.1))
    radius = np.linalg.norm(grid.to_world(np.stack(np.indices(grid.shape), -1)) - centre, axis=-1)
    small, large = grid.with_voxels(radius <= 18), grid.with_voxels(radius <= 22)
    found = score(small, large, skull=large)
    assert found.assd == pytest.approx(4, abs=0.25)  # half a voxel: surfaces are sets of voxel centres
    assert found.rmse == pytest.approx(4, abs=0.25)
    assert found.hd95 == pytest.approx(4, abs=0.6)
    assert dice(small, large) == pytest.approx(2 * 18**3 / (18**3 + 22**3), abs=0.002)
    assert volume_ratio(small, large) == pytest.approx((18 / 22) ** 3, rel=0.005)


def test_a_missing_part_is_seen_from_both_sides():
    whole, half = (Volume(block((4, 8, 8), size), np.eye(4)) for size in ((6, 20, 20), (6, 20, 10)))
    np.testing.assert_allclose(np.sort(surface_distances(half, whole)), np.sort(surface_distances(whole, half)))
    assert score(half, whole, skull=whole).hd95 > 8


def test_border_dice_counts_only_voxels_near_bone():
    skull = np.zeros((5, 60, 5), bool)
    skull[:, 0, :] = True
    patch, truth = np.zeros_like(skull), np.zeros_like(skull)
    truth[:, 1:40, :] = patch[:, 1:40, :] = True
    patch[:, 12:, :] = False  # wrong only farther than 10 mm from the bone
    at = oblique((1, 1, 1))
    patch, truth, skull = (Volume(v, at) for v in (patch, truth, skull))
    assert border_dice(patch, truth, skull, reach_mm=10.0) == 1
    assert border_dice(patch, truth, skull, reach_mm=12.0) == pytest.approx(2 * 11 / (11 + 12))
    assert dice(patch, truth) == pytest.approx(2 * 11 / (11 + 39))


@pytest.mark.parametrize("spacing", [(1, 1, 1), (3, 0.5, 0.7)])
def test_border_dice_agrees_with_a_distance_map(spacing):
    rng = np.random.default_rng(3)
    skull = rng.random((20, 40, 40)) < 0.001
    patch, truth = (rng.random(skull.shape) < 0.3 for _ in range(2))
    near = ndimage.distance_transform_edt(~skull, sampling=spacing) <= 5.0
    wanted = 2 * (patch & truth & near).sum() / ((patch & near).sum() + (truth & near).sum())
    at = oblique(spacing)
    found = border_dice(Volume(patch, at), Volume(truth, at), Volume(skull, at), reach_mm=5.0)
    assert found == pytest.approx(wanted, abs=1e-12)


def test_peer_agrees_on_dice_and_surface_distance():
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
    far = surface_distances(Volume(a, at), Volume(b, at))
    assert score(Volume(a, at), Volume(b, at), Volume(b, at)).hd95 == np.percentile(far, 95)
    hausdorff = sitk.HausdorffDistanceImageFilter()
    hausdorff.Execute(*images)
    assert far.max() == pytest.approx(hausdorff.GetHausdorffDistance())


def test_two_empty_masks_agree():
    empty = Volume(EMPTY, np.eye(4))
    skull = Volume(~EMPTY, np.eye(4))
    assert dataclasses.astuple(score(empty, empty, skull)) == (1, 1, 0, 0, 0, 1, 0)


@pytest.mark.parametrize("empty_one", [0, 1])
def test_one_empty_mask_is_as_wrong_as_can_be(empty_one):
    filled = EMPTY.copy()
    filled[2:4, 2:4, 2:4] = True
    pair = [Volume(filled, np.eye(4)), Volume(filled, np.eye(4))]
    pair[empty_one] = Volume(EMPTY, np.eye(4))
    found = score(*pair, Volume(~filled, np.eye(4)))
    assert (found.dice, found.border_dice, found.overlap) == (0, 0, 0)
    assert (found.hd95, found.assd, found.rmse) == (np.inf,) * 3
    assert found.volume_ratio == (0 if empty_one == 0 else np.inf)


def test_other_grids_and_a_missing_skull_are_refused():
    at_home, moved = Volume(EMPTY, np.eye(4)), Volume(EMPTY, oblique())
    for wrong in ((at_home, moved, at_home), (at_home, at_home, moved)):
        with pytest.raises(InputRefused) as refusal:
            score(*wrong)
        assert refusal.value.code == "GridMismatch"
    with pytest.raises(InputRefused) as refusal:
        score(at_home, at_home, at_home)
    assert refusal.value.code == "NoBone"


def test_a_score_is_plain_numbers():
    filled = Volume(block((4, 8, 8)), oblique())
    found = dataclasses.asdict(score(filled, filled, filled.with_voxels(~filled.voxels)))
    assert json.loads(json.dumps(found)) == found
    assert found == dict(dice=1, border_dice=1, hd95=0, assd=0, rmse=0, volume_ratio=1, overlap=0)


def test_a_refusal_says_which_masks_do_not_fit():
    home, moved = Volume(~EMPTY, np.eye(4)), Volume(~EMPTY, oblique())
    for measure in (dice, volume_ratio, surface_distances):
        with pytest.raises(InputRefused, match="patch and truth"):
            measure(home, moved)
    with pytest.raises(InputRefused, match="patch and skull"):
        overlap(home, moved)
    for measure in (score, border_dice):
        with pytest.raises(InputRefused, match="patch and skull"):
            measure(home, home, moved)
    with pytest.raises(InputRefused, match="patch and truth"):
        border_dice(home, moved, home)
    with pytest.raises(InputRefused, match="truth and skull"):
        score(home, moved, home)
    with pytest.raises(InputRefused, match="skull mask is empty") as refusal:
        border_dice(home, home, home.with_voxels(EMPTY))
    assert refusal.value.code == "NoBone"


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_the_border_reaches_as_far_along_each_axis_and_no_farther(axis):
    step = (3.0, 0.5, 0.75)
    for steps, inside in ((6 / step[axis], True), (6 / step[axis] + 1, False)):
        skull, patch = np.zeros((2, 12, 30, 20), bool)
        at = np.array([8, 20, 14])
        patch[tuple(at)] = True  # wrong: the truth is empty
        skull[tuple(at - int(steps) * np.eye(3, dtype=int)[axis])] = True
        found = border_dice(*(Volume(v, oblique(step)) for v in (patch, np.zeros_like(patch), skull)), reach_mm=6.0)
        assert found == (0 if inside else 1)


@pytest.mark.parametrize("steps", [16, 17, 18])
def test_the_border_reaches_as_far_from_the_corner_of_a_block(steps):
    skull, patch = np.zeros((2, 44, 44, 44), bool)
    skull[:24, :24, :24] = True
    patch[(23 + steps,) * 3] = True  # wrong: the truth is empty
    at = np.diag([0.1, 0.1, 0.1, 1])
    found = border_dice(*(Volume(v, at) for v in (patch, np.zeros_like(patch), skull)), reach_mm=3.0)
    assert found == (0 if steps * 0.1 * np.sqrt(3) <= 3 else 1)


@pytest.mark.real
@pytest.mark.parametrize("case", ["000", "003"])
def test_reference_measures_of_real_implants(real_data, case):
    nrrd = pytest.importorskip("nrrd")
    folder = real_data / "skullfix"
    reference = json.loads((folder / "reference_measures.json").read_text())[case]
    implant, header = nrrd.read(str(folder / "cases" / case / "implant.nrrd"))
    bone, _ = nrrd.read(str(folder / "cases" / case / "defective.nrrd"))
    # more than 10 mm around: nothing else is measured
    around = tuple(slice(max(s.start - 40, 0), s.stop + 40) for s in ndimage.find_objects(implant)[0])
    implant, bone = (np.ascontiguousarray(v[around], bool) for v in (implant, bone))
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
