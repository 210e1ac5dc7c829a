"""The head of the fault set as data sets."""

import numpy as np
from pydicom.dataset import Dataset

from data_synth.fault_series import head, store_hu, turned_axial


def test_every_place_has_its_own_value() -> None:
    hu = head()
    for axis in range(3):
        assert not np.array_equal(hu, np.flip(hu, axis))


def test_stored_numbers_give_the_hu_back() -> None:
    ds = Dataset()
    store_hu(ds, head()[7], slope=0.5, intercept=-1024, bits=14, high=15)
    stored = np.frombuffer(ds.PixelData, "<u2") >> (ds.HighBit + 1 - ds.BitsStored)
    np.testing.assert_array_equal(stored * 0.5 - 1024, head()[7].ravel())


def test_turned_directions_stay_at_right_angles() -> None:
    for axis in range(3):
        across, down = np.array(turned_axial(25, axis)).reshape(2, 3)
        np.testing.assert_allclose([across @ across, down @ down, across @ down], [1, 1, 0], atol=1e-12)
