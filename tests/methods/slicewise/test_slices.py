"""Records of slices: JSON and back, pairs of outer and inner."""

import json
from dataclasses import FrozenInstanceError

import numpy as np
import pytest

from cranio_nb.methods.slicewise.slices import Inflation, SlicedDesign, SliceResult
from cranio_nb.opening import Opening
from cranio_nb.vault.slicing import axial_frames
from cranio_nb.volume import Volume

INFLATION = Inflation((4.0, 12.5), (156.0, 143.0), (61.5, 55.25), (48, 31), (True, False))


def test_a_record_survives_json():
    one = SliceResult(7, "balloon", inflation=INFLATION)
    assert json.loads(json.dumps(one.record())) == one.record()


def test_a_record_holds_each_pair_outer_first():
    told = SliceResult(7, "balloon", inflation=INFLATION).record()
    outer, inner = ({key: told[key][i] for key in INFLATION.record()} for i in (0, 1))
    assert outer == {"theta0": 4.0, "theta1": 156.0, "length": 61.5, "n_iter": 48, "converged": True}
    assert inner == {"theta0": 12.5, "theta1": 143.0, "length": 55.25, "n_iter": 31, "converged": False}


@pytest.mark.parametrize("status", ["hull", "carried", "skipped"])
def test_a_slice_without_balloons_records_why(status):
    assert SliceResult(3, status, "for a reason").record() == {"plane": 3, "status": status, "reason": "for a reason"}


def test_slices_share_no_arrays_and_stay_as_they_are():
    one, other = SliceResult(0, "skipped"), SliceResult(1, "skipped")
    assert one.turns_rad is not other.turns_rad and not one.curves.size and not one.start.size
    with pytest.raises(FrozenInstanceError):
        one.status = "balloon"


def test_a_place_in_an_axial_slice_is_its_voxel_in_the_world():
    """point = origin + row r + col c, for planes of an oblique scan."""
    affine = np.array([[0.1, -0.2, 0.9, 31.0], [0.3, 0.8, 0.1, -70.0], [1.9, -0.2, 0.1, 5.0], [0, 0, 0, 1.0]])
    bone = Volume(np.zeros((6, 9, 8), bool), affine)
    results = tuple(SliceResult(i, "skipped") for i in range(3))
    made = SlicedDesign(Opening(bone, np.zeros(3)), axial_frames(bone, range(2, 5)), 0.9, results)
    for i in range(len(made.slices)):
        origin, row, col = made.frames[i]
        np.testing.assert_allclose(origin + 3.5 * row + 6.25 * col, bone.to_world([2 + i, 3.5, 6.25]), atol=1e-12)


def test_a_record_says_whether_its_curves_cross():
    x = np.linspace(0, 10, 11)
    level, slope = np.column_stack([np.zeros(11), x]), np.column_stack([x - 4.5, x])
    apart = SliceResult(0, "carried", curves=np.stack([level, level + np.array([3.0, 0.0])]))
    across = SliceResult(0, "carried", curves=np.stack([level, slope]))
    assert apart.record()["crossed"] is False and across.record()["crossed"] is True
    np.testing.assert_allclose(across.crossings, [[0.0, 4.5]])
    assert "crossed" not in SliceResult(0, "skipped").record()
