"""Tilted and uneven scans: after reading, every landmark stands where it stood in the patient."""

import numpy as np

from cranio_nb.readers.regrid import even_heights, find_missing_gaps, resample_planes, slide_slices


def test_whole_pixel_slides_are_exact() -> None:
    voxels = np.arange(1, 25).reshape(2, 3, 4).astype(np.int16)
    upright, origin = slide_slices(voxels, np.array([[0.0, 0.0], [2.0, -1.0]]), fill=-9)
    np.testing.assert_array_equal(origin, [0, -1])
    assert upright.shape == (2, 5, 5)
    np.testing.assert_array_equal(upright[0, :3, 1:], voxels[0])
    np.testing.assert_array_equal(upright[1, 2:, :4], voxels[1])
    assert (upright == -9).sum() == 2 * (25 - 12)


def test_planes_are_interpolated_linearly() -> None:
    heights = np.array([0.0, 1.0, 4.0])
    voxels = (100 * heights[:, None, None] * np.ones((3, 2, 2))).astype(np.int16)
    wanted = even_heights(heights, 1.0)
    np.testing.assert_allclose(wanted, np.arange(5.0))
    np.testing.assert_array_equal(resample_planes(voxels, heights, wanted)[:, 0, 0], 100 * wanted)


def test_gaps_tell_missing_slices_from_two_slice_distances() -> None:
    run = list(range(1, 14))
    assert find_missing_gaps(np.delete(np.arange(14.0), 6), [None] * 13) == [5]
    assert find_missing_gaps(np.cumsum([2.5] * 7 + [5.0] * 6), run) == []
    assert find_missing_gaps(np.cumsum([2.5] * 7 + [5.0] * 6), [*run[:7], *range(9, 21, 2)]) == [6, 7, 8, 9, 10, 11]
