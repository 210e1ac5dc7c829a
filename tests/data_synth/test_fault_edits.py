"""Edits of a series change what they name, and no more."""

import numpy as np

from data_synth.fault_edits import chain, drop, edit_pixels, make_enhanced, rescale_each, set_elements, stored_pixels
from data_synth.fault_series import Recipe, head, make_series


def test_elements_are_set_and_deleted() -> None:
    slices = make_series(head(), Recipe())
    chain(set_elements(3, Rows=7), set_elements(slice(4, 6), PixelSpacing=None), drop(0, 1))(slices)
    assert [ds.InstanceNumber for ds in slices[:3]] == [3, 4, 5]
    assert slices[1].Rows == 7 and "PixelSpacing" not in slices[2] and "PixelSpacing" in slices[4]


def test_a_rescale_of_each_slice_keeps_the_hu() -> None:
    slices = make_series(head(), Recipe())
    rescale_each(slices)
    assert len({ds.RescaleIntercept for ds in slices}) == len(slices)
    for plane, ds in zip(head(), slices, strict=True):
        np.testing.assert_array_equal(stored_pixels(ds) + float(ds.RescaleIntercept), plane)


def test_frames_hold_what_the_slices_held() -> None:
    slices = make_series(head(), Recipe())
    edit_pixels(lambda pixels, k: pixels + k)(slices)
    planes = [stored_pixels(ds) for ds in slices]
    make_enhanced(lambda n: list(range(n))[::-1])(slices)
    (whole,) = slices
    stored = np.frombuffer(whole.PixelData, "<u2").reshape(-1, *planes[0].shape)
    np.testing.assert_array_equal(stored, planes[::-1])
    assert whole.NumberOfFrames == len(planes)
