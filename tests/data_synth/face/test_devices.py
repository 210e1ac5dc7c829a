"""What surrounds a head: where it lies, what it is made of, and that it never replaces bone or tissue."""

from functools import cache

import numpy as np
import pytest

from data_synth import AROUND, Pose, face_case

OPTIONS = {"size": "tiny", "seed": 2, "noise": 0.0, "blur_mm": 0.0}


@cache
def beside(*names, reach="vault"):
    """A head with a hole, and what is named around it."""
    return face_case(**OPTIONS, holes="round", around=names, reach=reach)


@pytest.fixture(scope="module")
def plain():
    return beside()


def heights(case):
    """Height of every voxel above the outer skull, mm along the ray, and its offset in the head's frame."""
    p = np.moveaxis(np.indices(case.bone.shape), 0, -1) @ case.affine[:3, :3].T + case.affine[:3, 3] - case.head.centre
    p = p @ case.head.rotation + 1e-9
    return -case.head.surfaces(p)[0], p


@pytest.mark.parametrize("name", AROUND)
def test_a_device_changes_the_picture_but_not_the_truth(plain, name):
    reach = "neck" if name == "tube" else "vault"
    plain = beside(reach=reach) if name == "tube" else plain
    case = beside(name, reach=reach)
    np.testing.assert_array_equal(case.bone, plain.bone)
    np.testing.assert_array_equal(case.implant, plain.implant)
    assert (case.hu != plain.hu).sum() > 5
    assert case.parameters["around"] == [name]


@pytest.mark.parametrize("name", ["holder", "couch", "mask"])
def test_shells_stay_in_the_air(plain, name):
    case = beside(name, reach="vault")
    changed = case.hu != plain.hu
    assert plain.hu[changed].max() <= 60
    if name != "mask":
        assert heights(case)[0][changed].min() > plain.head.scalp - 3.0


@pytest.mark.parametrize("pose", [Pose(), Pose(roll_deg=90), Pose(nod_deg=180)])
def test_the_holder_lies_under_the_head_however_it_lies(pose):
    bare, held = (face_case(**OPTIONS, pose=pose, around=names) for names in ((), ("holder",)))
    changed = np.argwhere((held.hu != bare.hu) & (held.hu > 300))
    world = changed @ held.affine[:3, :3].T + held.affine[:3, 3] - held.head.centre
    assert world[:, 1].min() > 5.0


def test_the_ring_is_closed_and_bright(plain):
    case = beside("ring", reach="vault")
    _, p = heights(case)
    bright = p[(case.hu > 2500) & (plain.hu < 100)]
    around = np.hypot(bright[:, 0], bright[:, 1] - 3.0)
    ring = bright[np.abs(around - 106) < 3]
    turns = np.sort(np.arctan2(ring[:, 1] - 3.0, ring[:, 0]))
    assert len(ring) > 200
    assert np.diff([*turns, turns[0] + 2 * np.pi]).max() < 0.1


def test_streaks_only_when_asked_for(plain):
    dull, bright = (face_case(**OPTIONS, holes="round", around=["clip"], streaks=on) for on in (False, True))
    assert (dull.hu != plain.hu).sum() < 60
    assert (bright.hu != plain.hu).sum() > 3000


def test_unknown_things_are_refused():
    with pytest.raises(ValueError, match="nothing named 'hat'"):
        face_case("tiny", around=["hat"])
