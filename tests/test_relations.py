"""Relations between an input changed in a known way and its prosthesis, on small heads; hypothesis draws the changes.

Not here, as each method or reader has them among its own tests: 1 the mirrored skull, 10 the union of two holes,
11 finer voxels, in `methods/test_design.py`; 8 other encodings of one scan, in `readers/test_fault_set.py`.

`pytest tests/test_relations.py --hypothesis-profile=long` draws other and many more changes on every run.
"""

from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from dicom_series import head, save, series
from hypothesis import example, given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from cranio_nb.errors import NoOpening
from cranio_nb.evaluation import scores
from cranio_nb.evaluation.mesh_distances import surface_distance
from cranio_nb.grid import AxisOrder
from cranio_nb.methods.design import design
from cranio_nb.readers import read_ct
from cranio_nb.stages.segmentation import segment
from cranio_nb.stages.surface_reconstruction import extract_surface
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.volume import Volume
from data_synth import phantom_case

METHODS = st.sampled_from(("slicewise", "thin-plate", "hull"))
DEFECTS = st.sampled_from(("burr_hole", "unilateral"))
MOVES = st.tuples(*[st.floats(-900, 900)] * 3)


@cache
def head_with(defect, diameter=None):
    case = phantom_case("tiny", defect, 0, diameter=diameter)
    return case, Volume(case.bone, case.affine)


@cache
def designed(defect, method, diameter=None):
    return design(head_with(defect, diameter)[1], method=method)


def moved(volume, turn, shift):
    move = np.eye(4)
    move[:3, :3], move[:3, 3] = turn, shift
    return Volume(volume.voxels, move @ volume.affine)


@given(DEFECTS, st.permutations(range(3)), st.tuples(*[st.booleans()] * 3))
def test_2_quarter_turns_and_flips_of_the_stored_axes_change_nothing(defect, axes, flips):
    """Exact: a design starts from the canonical grid, which comes out bit for bit."""
    bone = head_with(defect)[1]
    stored = bone.reorder(AxisOrder(tuple(axes), flips)).canonical()
    np.testing.assert_array_equal(stored.voxels, bone.voxels)
    np.testing.assert_array_equal(stored.affine, bone.affine)


@example("unilateral", "slicewise", (0, 0, 1), (0, 0, 0))
@given(DEFECTS, METHODS, st.tuples(*[st.floats(-25, 25)] * 3), MOVES)
def test_3_a_turned_header_turns_the_mesh(defect, method, degrees, shift):
    """Also where rays meet voxels on their very border, which rounding moves to either side."""
    turn = Rotation.from_euler("xyz", degrees, degrees=True).as_matrix()
    here, there = designed(defect, method), design(moved(head_with(defect)[1], turn, shift), method=method)
    np.testing.assert_array_equal(there.patch.voxels, here.patch.voxels)
    np.testing.assert_allclose(there.mesh.vertices, here.mesh.vertices @ turn.T + shift, atol=1e-4)


@given(DEFECTS, METHODS, MOVES)
def test_4_a_moved_header_moves_the_mesh(defect, method, shift):
    here, there = designed(defect, method), design(moved(head_with(defect)[1], np.eye(3), shift), method=method)
    np.testing.assert_allclose(there.mesh.vertices, here.mesh.vertices + shift, atol=1e-4)


@given(st.permutations(range(12)))
def test_5_names_and_order_of_files_change_nothing(names):
    with TemporaryDirectory() as folder:
        paths = sorted(save(Path(folder) / "scan", series(head())).iterdir())[: len(names)]
        before = read_ct(paths[0].parent)[0]
        for path, name in zip(paths, names, strict=False):
            path.rename(path.with_name(f"{name:02d}.img"))
        after = read_ct(paths[0].parent)[0]
    np.testing.assert_array_equal(after.voxels, before.voxels)
    np.testing.assert_array_equal(after.affine, before.affine)


@given(DEFECTS, st.integers(-80, 80), st.integers(200, 500))
def test_6_hu_and_threshold_shifted_alike_give_the_same_bone(defect, shift, threshold):
    case, _ = head_with(defect)
    here = segment(Volume(case.hu, case.affine), threshold=threshold)
    there = segment(Volume(case.hu + np.int16(shift), case.affine), threshold=threshold + shift)
    np.testing.assert_array_equal(there.voxels, here.voxels)


@given(DEFECTS, METHODS, st.floats(0.25, 4.0))
def test_7_a_scaled_grid_scales_the_volume_by_the_cube(defect, method, scale):
    patch = designed(defect, method).patch
    here, there = (extract_surface(Volume(patch.voxels, patch.affine @ np.diag([s, s, s, 1]))) for s in (1.0, scale))
    np.testing.assert_array_equal(there.faces, here.faces)
    assert there.volume == pytest.approx(here.volume * scale**3, rel=1e-9)


@given(METHODS, st.tuples(*[st.integers(0, 2)] * 2), st.tuples(*[st.integers(0, 7)] * 3))
def test_9_air_beside_and_above_the_head_changes_nothing(method, before, after):
    """Exact where whole blocks of the coarse look at the head, 4 voxels, lie in front of it."""
    before = 4 * np.array([0, *before])
    _, bone = head_with("unilateral")
    affine = bone.affine.copy()
    affine[:3, 3] = bone.to_world(-before)
    padded = Volume(np.pad(bone.voxels, list(zip(before, after, strict=True))), affine)
    inside = tuple(slice(low, low + n) for low, n in zip(before, bone.shape, strict=True))
    made = design(padded, method=method).patch.voxels
    assert made.sum() == made[inside].sum()
    np.testing.assert_array_equal(made[inside], designed("unilateral", method).patch.voxels)


@given(st.integers(0, 40))
def test_12_a_whole_head_has_no_opening(seed):
    case = phantom_case("tiny", "round", seed)
    with pytest.raises(NoOpening):
        find_openings(Volume(case.complete, case.affine))


@given(METHODS, st.sampled_from((25.0, 35.0, 45.0)))
def test_13_a_prosthesis_shares_no_voxel_with_bone_and_15_leaves_nothing_to_close(method, diameter):
    case, bone = head_with("round", diameter)
    patch = designed("round", method, diameter).patch.voxels
    assert patch.any() and not (patch & bone.voxels).any()
    with pytest.raises(NoOpening):
        find_openings(Volume(case.bone | patch, case.affine))


@given(METHODS, st.sampled_from((25.0, 35.0)))
def test_14_a_wider_hole_gets_a_larger_prosthesis(method, diameter):
    narrow, wide = (designed("round", method, d) for d in (diameter, diameter + 10))
    assert wide.mesh.volume > narrow.mesh.volume


@given(DEFECTS, METHODS, st.sampled_from((-4.0, 4.0, 8.0, 12.0)))
def test_16_leaning_planes_give_the_same_mesh(defect, method, tilt):
    """Within 0.3 of the largest side of a voxel, in the mean of both ways."""
    case = phantom_case("tiny", defect, 0, tilt_deg=tilt)
    here, there = designed(defect, method).mesh, design(Volume(case.bone, case.affine), method=method).mesh
    apart = [surface_distance(a.vertices, b).mean() for a, b in ((here, there), (there, here))]
    assert np.mean(apart) < 0.3 * head_with(defect)[1].spacing.max()


@given(st.floats(0.25, 4.0), st.integers(0, 9))
def test_lengths_scale_with_the_grid_and_ratios_stay(scale, seed):
    """The measures under relation 7."""
    rng = np.random.default_rng(seed)
    masks = [rng.random((7, 8, 9)) < 0.4 for _ in range(2)]
    (a, b), (c, d) = ([Volume(mask, np.diag([2.0 * s, 1.5 * s, s, 1])) for mask in masks] for s in (1.0, scale))
    assert scores.dice(c, d) == scores.dice(a, b)
    assert scores.assd(c, d) == pytest.approx(scale * scores.assd(a, b), rel=1e-9)
