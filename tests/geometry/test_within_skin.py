import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.stages.segmentation import segment
from cranio_nb.volume import Volume


def head_in_its_skin(spacing_mm=(2.0, 2.0, 2.0), shape=(70, 120, 120)):
    """HU of a ball of 110 mm with a skull, a hole at its back; the skull; and x, y, z in mm from its middle."""
    middle = (np.array(shape)[:, None, None, None] - 1) / 2
    z, y, x = (np.indices(shape) - middle) * np.reshape(spacing_mm, (3, 1, 1, 1))
    r = np.sqrt(x**2 + y**2 + z**2)
    skull = (np.abs(r - 47) < 3) & ~((y > 0) & (np.hypot(x, z) < 15))
    hu = np.where(r < 55, 40, -1000).astype(np.int16)
    hu[skull] = 900
    return hu, skull, (x, y, z)


def segmented(hu, spacing_mm=(2.0, 2.0, 2.0)):
    return segment(Volume(hu, np.diag([*spacing_mm[::-1], 1.0]))).voxels


@pytest.mark.parametrize("gap_mm", [0, 4, 12])
def test_a_couch_and_a_ring_screwed_to_the_skull_go_where_skin_ends(gap_mm):
    hu, skull, (x, y, z) = head_in_its_skin()
    couch = np.abs(y - 57 - gap_mm) < 2
    ring = (np.abs(np.hypot(x, y) - 75) < 5) & (np.abs(z + 20) < 5)
    screws = (np.abs(y) < 3) & (np.abs(z + 20) < 3) & (np.abs(x) > 40) & (np.abs(x) < 75)
    hu[couch | ring | screws] = 1500
    assert ndimage.label(hu > 400)[1] == 1  # no search among pieces can part them
    found = segmented(hu)
    r = np.sqrt(x**2 + y**2 + z**2)
    assert found[skull].all() and not found[r > 62].any()
    assert not found[couch & (np.hypot(x, z) < 15)].any()  # behind the hole


@pytest.mark.parametrize("gap_mm", [-1, 2, 12])
@pytest.mark.parametrize("part", ["half", "low", "strap", "tube"])
def test_a_shell_round_the_head_goes_wholly_wherever_it_lies_on_the_skin(part, gap_mm):
    hu, skull, (x, y, z) = head_in_its_skin()
    parts = {"half": y > 0, "low": z < 0, "strap": np.abs(z - 10) < 12, "tube": gap_mm > 0}
    around = np.hypot(x, y / 1.02) - 55 - gap_mm  # an oval: it meets the ball here and there
    shell = (around > 0) & (around < 4) & parts[part]
    assert shell.any() or part == "tube"  # a tube that touches all round leaves no air to see it by
    hu[shell] = 700
    np.testing.assert_array_equal(segmented(hu), skull)


def test_nothing_is_left_of_a_shell_that_lies_on_the_skin_over_a_long_way():
    hu, skull, (x, y, _) = head_in_its_skin()
    around = np.hypot(x - 5, y - 5) - 55 + np.hypot(5, 5)  # wider than the head, which lies in one side of it
    shell = (around > 0) & (around < 4) & (y - x < 0)
    hu[shell & (hu < 0)] = 700
    np.testing.assert_array_equal(segmented(hu), skull)


def test_nothing_is_taken_off_a_head_that_fills_a_few_slices_or_leaves_the_image():
    hu, skull, _ = head_in_its_skin()
    for view in (np.s_[30:36], np.s_[:, 30:], np.s_[:, :, :70], np.s_[:36, 20:90, 10:]):
        np.testing.assert_array_equal(segmented(hu[view]), skull[view])


def test_nothing_is_taken_off_a_dry_skull():
    hu, skull, (_, y, _) = head_in_its_skin()
    hu[hu == 40] = -1000
    hu[np.abs(y - 57) < 2] = 40  # foam on which it lies
    np.testing.assert_array_equal(segmented(hu), skull)
