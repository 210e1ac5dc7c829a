"""The panel of gap ends says what the stage finds."""

import numpy as np

from cranio_nb.stages import feature_extraction
from cranio_nb.teaching import widgets


def middle_plane(opening):
    return int(np.median(np.flatnonzero(opening.voxels.any((1, 2)))))


def test_the_features_line_counts_the_points_of_the_stage(static, skull, opening):
    bone, plane, px = skull(), middle_plane(opening), float(skull().spacing[1])
    panel = widgets.features(bone, plane, opening=opening).set(skip_mm=5.0, reach_mm=12.0)
    seen = feature_extraction.extract_features(bone.voxels[plane])
    ends = feature_extraction.find_gap_ends(seen, opening.voxels[plane], skip_px=5 / px, reach_px=12 / px)
    width = np.hypot(*np.diff(ends[0].points, axis=0)[0]) * px
    assert f"{width:.1f} mm apart" in panel.view.line


def test_a_slice_without_a_gap_says_so(static, skull, opening):
    line = widgets.features(skull(), 2, opening=opening).view.line
    assert line.startswith("Slice 2: ") and "carry" not in line
