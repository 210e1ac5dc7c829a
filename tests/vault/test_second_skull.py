"""A second skull in the image is named; what is none is not."""

from dataclasses import replace

import numpy as np
import pytest

from cranio_nb.stages.segmentation import parts_of
from cranio_nb.vault.second_skull import second_skull_remarks
from cranio_nb.volume import Volume

SIDES = {0: "base", 1: "front", 2: "right"}  # of the first in the array, seen from the second


def remarks(scan):
    parts = parts_of(scan)
    return second_skull_remarks(parts.bone, parts.others)


def side_by_side(phantom, axis, voxels):
    one, other = phantom("unilateral"), phantom("burr_hole", 1)
    return Volume(np.concatenate([getattr(one, voxels), getattr(other, voxels)], axis=axis), one.affine)


@pytest.mark.parametrize(("axis", "voxels"), [(0, "hu"), (1, "bone"), (2, "hu"), (2, "bone")])
def test_of_two_skulls_the_one_that_is_not_looked_at_is_named_with_its_place(axis, voxels, phantom):
    scan = side_by_side(phantom, axis, voxels)
    (found,) = remarks(scan)
    assert (found.code, found.severity) == ("SecondSkull", "warning")
    # the skulls are as far apart as the images are wide, but for the heads' own places in them
    wide = (scan.shape[axis] // 2) * scan.spacing[axis]
    assert abs(found.values["distance_mm"] - wide) < 15
    examined = parts_of(scan).bone.voxels
    halves = [half.any() for half in np.split(examined, 2, axis=axis)]
    assert sum(halves) == 1
    assert (found.values["place"] == SIDES[axis]) == halves[1]  # the other is in the other half
    left_out = np.argwhere(
        np.split(scan.voxels >= 400 if voxels == "hu" else scan.voxels, 2, axis=axis)[int(halves[0])]
    )
    first, last = np.quantile(left_out[:, 0], [0, 1]) + (halves[0] * scan.shape[0] / 2 if axis == 0 else 0)
    assert abs(found.values["planes"][0] - first) <= 1 and abs(found.values["planes"][1] - last) <= 1
    assert f"planes {found.values['planes'][0]} to {found.values['planes'][1]}" in found.message


@pytest.mark.parametrize("defect", ["unilateral", "multiple", "large"])
def test_one_skull_is_one(defect, phantom):
    case = phantom(defect)
    assert remarks(Volume(case.hu, case.affine)) == remarks(Volume(case.bone, case.affine)) == ()


def beside(phantom, part):
    """A skull, and at its left a part as a mask of the same shape."""
    case = phantom("burr_hole")
    return Volume(np.concatenate([case.bone, part], axis=2), case.affine)


def test_what_encloses_no_cavity_is_no_skull(phantom):
    case = phantom("burr_hole")
    z, y, x = np.indices(case.bone.shape)
    plate = (y > 20) & (y < 100) & (x > 30) & (x < 40)
    ring = (np.abs(np.hypot(y - 64, x - 64) - 50) < 4) & (z > 10) & (z < 18)
    trough = (np.abs(np.hypot(y - 64, x - 64) - 50) < 4) & (y > 64) & (z > 4) & (z < 36)
    post = (np.hypot(y - 64, x - 64) < 20) & (z > 4) & (z < 40)
    for part in (plate, ring, trough, post):
        scan = beside(phantom, part)
        assert parts_of(scan).others or part is ring  # large enough to be looked at
        assert remarks(scan) == ()


def test_the_cap_of_a_sawn_skull_is_a_part_of_the_same(phantom):
    case = phantom("burr_hole")
    sawn = case.bone.copy()
    sawn[24:26] = False
    parts = parts_of(Volume(sawn, case.affine))
    assert len(parts.others) == 1 and second_skull_remarks(parts.bone, parts.others) == ()
    assert second_skull_remarks(parts.others[0], (replace(parts.bone),)) == ()
