"""The phantom as a scan: truth masks, tissues, partial volume, options, seeds."""

from dataclasses import replace

import numpy as np
import pytest

from data_synth import SIZES, phantom_case, scan


@pytest.mark.parametrize("defect", ["unilateral", "ragged", "partial", "multiple", "near_base"])
def test_bone_and_implant_make_the_complete_skull(defect):
    case = phantom_case("tiny", defect, 7)
    whole = scan(replace(case.head, cutters=()), case.affine, case.bone.shape)[1]
    assert not (case.bone & case.implant).any()
    np.testing.assert_array_equal(case.complete, whole)
    assert case.implant.any()


@pytest.mark.parametrize("size", ["tiny", "class"])
def test_shape_frame_and_origin(size):
    case = phantom_case(size)
    assert case.hu.shape == case.bone.shape == SIZES[size].shape
    assert case.hu.dtype == np.int16
    np.testing.assert_allclose(np.linalg.norm(case.affine[:3, :3], axis=0), SIZES[size].spacing)
    assert np.linalg.det(case.affine[:3, :3][:, [2, 1, 0]]) > 0
    np.testing.assert_array_equal(np.argmax(np.abs(case.affine[:3, :3]), axis=0), [2, 1, 0])
    assert np.abs(case.affine[:3, 3]).min() > 50


def test_same_seed_same_bytes_other_seed_other_head():
    first, again, other = (phantom_case("tiny", "ragged", seed) for seed in (4, 4, 5))
    for name in ("hu", "bone", "implant", "affine"):
        assert getattr(first, name).tobytes() == getattr(again, name).tobytes()
    assert (first.complete != other.complete).any()


def test_scanner_options_change_the_picture_but_not_the_truth():
    plain = phantom_case("tiny", "unilateral", 1)
    busy = phantom_case("tiny", "unilateral", 1, noise=0.0, couch=True, metal=True)
    np.testing.assert_array_equal(plain.bone, busy.bone)
    np.testing.assert_array_equal(plain.implant, busy.implant)
    assert busy.hu.max() == 3071
    behind = busy.hu[:, 110:, :].max(axis=(1, 2))
    assert (behind > 500).all()  # the couch runs through every plane


def test_seeds_choose_both_sides():
    sides = {np.sign(phantom_case("tiny", "unilateral", seed).head.cutters[0].axes[2, 0]) for seed in range(6)}
    assert sides == {-1.0, 1.0}


def test_vertex_hole_crosses_the_midline():
    case = phantom_case("tiny", "vertex", 0)
    x = np.argwhere(case.implant)[:, 2] * case.affine[0, 2] + case.affine[0, 3] - case.head.centre[0]
    assert x.min() < -15 and x.max() > 15


def test_partial_loss_keeps_the_inner_table():
    case = phantom_case("tiny", "partial", 2)
    truths = [t for plane in range(4, 40, 4) for t in case.slice_truth(plane)]
    assert truths
    assert all(t.inner is None for t in truths)


def test_diameter_is_what_was_asked_for():
    case = phantom_case("class", "round", 3, diameter=40.0)
    p = np.argwhere(case.implant) @ case.affine[:3, :3].T + case.affine[:3, 3] - case.head.centre
    across = p @ case.head.cutters[0].axes[:2].T
    np.testing.assert_allclose(np.ptp(across, axis=0), 40.0, atol=4.0)  # bevel of 2 mm, and voxels


def test_tissues_have_their_hu():
    case = phantom_case("tiny", "burr_hole", 0, noise=10.0)
    p = np.moveaxis(np.indices(case.bone.shape), 0, -1) @ case.affine[:3, :3].T + case.affine[:3, 3] - case.head.centre
    radius = np.linalg.norm(p, axis=-1)
    d = p / radius[..., None]
    inner, outer = case.head.inner_radius(d), case.head.outer_radius(d)
    brain = radius < inner - 6.0
    assert case.hu[brain].mean() == pytest.approx(35.0, abs=0.5)
    assert case.hu[brain].std() == pytest.approx(10.0, abs=0.5)
    air = (radius > outer + case.head.scalp + 6.0) & (p[..., 2] > 0)
    assert case.hu[air].mean() == pytest.approx(-1000.0, abs=0.5)
    middle = np.abs(radius - (inner + outer) / 2) < 0.5
    diploe = case.hu[middle & case.bone]
    assert 600 < diploe.mean() < 900
    assert 0 < (diploe < 400).mean() < 0.05  # a few pits below a bone threshold


def test_hu_falls_steadily_from_scalp_to_air():
    case = phantom_case("tiny", "frontal", 0, noise=0.0)
    row, col = np.round(np.linalg.solve(case.affine[:3, :3], case.head.centre - case.affine[:3, 3])[1:]).astype(int)
    line = case.hu[20, row, col:].astype(int)  # through the left side, away from the skull
    last_bone = np.flatnonzero(line > 400)[-1]
    assert (np.diff(line[last_bone:]) <= 0).all()
    assert line[-1] == -1000


def test_partial_volume_is_the_mean_over_the_voxel():
    """A blended voxel must come much nearer to the mean of a 5 x 3 x 3 finer scan than its centre sample does."""
    case = phantom_case("tiny", "unilateral", 1)
    parts = np.array([5, 3, 3])
    fine = case.affine.copy()
    fine[:3, :3] /= parts
    coarse = case.affine.copy()
    coarse[:3, 3] += coarse[:3, 0] * 24
    fine[:3, 3] = coarse[:3, 3] - fine[:3, :3] @ ((parts - 1) / 2)
    shape = (5, 128, 128)
    blended = scan(case.head, coarse, shape, noise=0)[0].astype(float)
    detail = scan(case.head, fine, tuple(shape * parts), noise=0)[0].astype(float)
    cells = detail.reshape(5, 5, 128, 3, 128, 3)
    mean, centre = cells.mean(axis=(1, 3, 5)), cells[:, 2, :, 1, :, 1]
    error, plain = (np.sqrt(np.mean((x - mean) ** 2)) for x in (blended, centre))
    assert error < 0.5 * plain


def test_uneven_planes_show_the_same_head():
    case = phantom_case("tiny", "frontal", 1)
    positions = np.array([0.0, 3.0, 9.0, 12.0, 60.0])
    hu, bone, implant = scan(case.head, case.affine, (5, 128, 128), positions=positions, noise=0)
    whole = phantom_case("tiny", "frontal", 1, noise=0)
    planes = [0, 1, 3, 4, 20]
    np.testing.assert_array_equal(bone, whole.bone[planes])
    np.testing.assert_array_equal(implant, whole.implant[planes])
    soft = ~whole.bone[planes]
    assert np.abs(hu.astype(int) - whole.hu[planes])[soft].mean() < 10  # only the diploe's texture differs


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"size": "huge"}, "no size named 'huge'"),
        ({"defect": "ear"}, "no defect named 'ear'"),
        ({"diameter": 400.0}, "does not fit"),
        ({"diameter": -3.0}, "does not fit"),
    ],
)
def test_wrong_requests_are_refused(options, words):
    with pytest.raises(ValueError, match=words):
        phantom_case(**options)
