"""What the lessons work on: a case from a seed or a scan of one's own, a slice with both ends, distances to a curve."""

import numpy as np
import pytest

import cranio_nb as cn
from cranio_nb.errors import InputRefused
from cranio_nb.stages import feature_extraction
from cranio_nb.teaching import classroom
from data_synth import write_dicom


@pytest.fixture
def clean(monkeypatch):
    for name in ("CRANIO_NB_SIZE", "CRANIO_NB_SCAN", "CRANIO_NB_TRUTH"):
        monkeypatch.delenv(name, raising=False)


def test_the_environment_chooses_the_size_of_a_lesson_but_not_of_a_synthetic_head(clean, monkeypatch):
    monkeypatch.setenv("CRANIO_NB_SIZE", "tiny")
    assert classroom.load("class").ct.shape == classroom.synthetic("tiny").ct.shape
    assert classroom.synthetic("class").ct.shape != classroom.load("class").ct.shape


def test_a_scan_of_ones_own_has_no_truth(clean, phantom, tmp_path):
    case = phantom()
    write_dicom(tmp_path / "ct", case.hu, case.affine)
    own = classroom.load(scan=tmp_path / "ct")
    assert own.truth is None and own.phantom is None and own.true_curves(20) == own.true_angles(20) == ()
    np.testing.assert_array_equal(own.ct.voxels, case.hu)
    with pytest.raises(InputRefused, match="not known"):
        classroom.load(scan=tmp_path / "ct", needs_truth=True)


def test_the_true_curves_end_where_their_angles_say(clean):
    case = classroom.synthetic("tiny")
    (outer, _), (angles, _) = case.true_curves(20), case.true_angles(20)
    chord = outer[-1] - outer[0]
    for step, angle in ((outer[1] - outer[0], angles[0]), (outer[-1] - outer[-2], 180 - angles[1])):
        cosine = step @ chord / np.linalg.norm(step) / np.linalg.norm(chord)
        assert np.degrees(np.arccos(cosine)) == pytest.approx(angle, abs=1.5)


def test_a_bridged_plane_has_both_ends(skull, openings):
    bone, opening = skull(), openings()[0]
    plane = classroom.bridged_plane(bone, opening, skip_px=3, reach_px=8)
    assert opening.planes[0] <= plane < opening.planes[1]
    found = feature_extraction.extract_features(bone.voxels[plane])
    stage = feature_extraction.find_gap_ends(found, opening.sheet.voxels[plane], skip_px=3, reach_px=8)
    for ends, same in zip(classroom.gap_ends(bone, opening, plane, skip_px=3, reach_px=8), stage, strict=True):
        assert np.isfinite(ends.points).all()
        np.testing.assert_array_equal(ends.points, same.points)


def test_a_skull_without_a_gap_in_its_slices_is_refused(skull, openings):
    ring = skull().with_voxels(skull().voxels | openings()[0].sheet.voxels)
    closed = cn.Opening(openings()[0].sheet, openings()[0].head_centre)
    solid = ring.with_voxels(np.ones_like(ring.voxels))
    with pytest.raises(InputRefused, match="both ends"):
        classroom.bridged_plane(solid, closed, skip_px=3, reach_px=8)


def test_scratch_folders_are_new_and_hold_copies(tmp_path):
    (tmp_path / "a.txt").write_text("one")
    first, second = classroom.scratch_folder(), classroom.scratch_folder(copy_of=tmp_path)
    assert first != second and not first.exists()
    assert [path.read_text() for path in second.iterdir()] == ["one"]


def test_the_distance_to_a_fine_circle_is_the_difference_of_radii():
    angle = np.linspace(0, 2 * np.pi, 721)
    circle = 50 * np.column_stack([np.cos(angle), np.sin(angle)])
    points = np.random.default_rng(0).normal(size=(40, 2)) * 40
    off = np.abs(np.linalg.norm(points, axis=1) - 50)
    np.testing.assert_allclose(classroom.distance_to_curve(points, circle), off, atol=1e-3)


def test_a_skeleton_is_thin_and_lies_in_the_mask(phantom):
    bone = phantom().bone[20]
    points = classroom.skeleton(bone)
    thin = np.zeros_like(bone)
    thin[tuple(points.T)] = True
    assert not (thin & ~bone).any()
    blocks = thin[:-1, :-1] & thin[1:, :-1] & thin[:-1, 1:] & thin[1:, 1:]
    assert not blocks.any()
