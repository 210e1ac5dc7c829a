"""The whole head's depths: truth of bone by hand, spaces that are empty, symmetry, windows that lose nothing."""

import numpy as np
import pytest

from data_synth.face.anatomy import Anatomy, Group, Plane, depths, parts
from data_synth.face.base_map import base_map
from data_synth.face.braincase import braincase
from data_synth.face.render import plane_at


def anatomy(seed=0, asymmetry=1.0):
    rng = np.random.default_rng(seed)
    return Anatomy(braincase(rng, np.zeros(3), np.eye(3), asymmetry=asymmetry), base_map(rng), np.ones(3))


@pytest.fixture(scope="module")
def head():
    return anatomy()


HALF = 114  # every fourth pixel lies alike on both sides


def grid(z, spacing=1.0, half=HALF):
    affine = np.diag([1.0, 1, 1, 1])
    affine[:3, :3] = np.fliplr(np.diag([spacing, spacing, 1.0]))
    affine[:3, 3] = [-half, -half, z]
    return affine, (int(2 * half / spacing) + 1,) * 2


def level(head, z, **k):
    affine, shape = grid(z, **k)
    plane = plane_at(head, affine, 0, shape)
    return plane, depths(head, plane)


def at(field, x, y):
    return field[round(y + HALF), round(x + HALF)]


def test_places_that_are_bone_and_places_that_are_not(head):
    bony = {(50, -13): -35, (51, 11): -55, (0, -84): -114, (0, 4): -72, (64, -28): -33}
    for (x, y), z in bony.items():  # jaw joint, mastoid, chin, tooth of the axis, cheekbone's arch
        assert at(level(head, z)[1].bone, x, y) > 0, (x, y, z)
    free = {(32, -72): -19, (6, -62): -45, (25, -60): -48, (0, 15): -52, (48, 1): -29, (0, 10): 30}
    for (x, y), z in free.items():  # orbit, nose, cheek's sinus, great opening, ear canal, brain
        assert at(level(head, z)[1].bone, x, y) < 0, (x, y, z)


def test_the_vault_is_the_closed_form_shell(head):
    for z in (25.0, 60.0):
        plane, found = level(head, z)
        p = np.moveaxis(plane.p, 0, -1) + 1e-9
        depth, thickness = head.case.surfaces(p)
        np.testing.assert_array_equal(found.bone > 0, (depth > 0) & (depth < thickness))
        np.testing.assert_array_equal(found.cavity > 0, depth > thickness)
        near = (depth > -15) & (depth < 20)
        np.testing.assert_allclose(found.outer[near], (depth / head.case.slope(p))[near], atol=0.1)


def test_bone_and_cavity_never_meet(head):
    for z in range(-60, 20, 8):
        found = level(head, z)[1]
        assert not ((found.bone > 0) & (found.cavity > 0)).any()
        assert found.body[(found.bone > 0) | (found.tooth > 0)].min(initial=9.0) >= 2.0


@pytest.mark.parametrize("z", [-90.0, -45.0, -20.0, 2.0, 50.0])
def test_a_symmetric_head_is_its_own_mirror_image(z):
    found = level(anatomy(1, asymmetry=0.0), z)[1]
    for field in (found.bone, found.tooth, found.cavity):
        np.testing.assert_array_equal(field > 1e-6, field[:, ::-1] > 1e-6)
    skin = np.abs(found.body) > 0.5  # where three solids meet at the midline, its fillets depend on their order
    np.testing.assert_array_equal((found.body > 0)[skin], (found.body[:, ::-1] > 0)[skin])


def test_windows_lose_nothing(head):
    plane = level(head, -40.0)[0]
    for group in (head.skull, head.loose, head.body, head.contents):
        seen = {index: part for index, part, _ in parts(head, plane, group, reach=0.0)}
        for index, solid in enumerate(group.solids):
            inside = np.argwhere(solid.depth(plane.p) > 0)
            if len(inside):
                rows, cols = seen[index]
                assert (inside.min(0) >= [rows.start, cols.start]).all()
                assert (inside.max(0) < [rows.stop, cols.stop]).all()


def test_a_window_ends_at_the_image():
    plane = Plane(np.zeros((3, 20, 30)), np.column_stack([np.eye(3), [0, 5, 5]]), np.array([1.0, 1.0]))
    group = Group(())
    assert group.centres.shape == (0, 3)
    found = dict(plane.windows(np.array([[0.0, 0, 0], [0, 0, 50.0], [9.0, 0, 0]]), np.array([8.0, 8.0, 8.0])))
    assert found == {0: (slice(0, 14), slice(0, 14))}  # the others lie beside the image and above the plane
