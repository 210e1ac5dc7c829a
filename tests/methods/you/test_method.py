"""The flat fill between guiding points."""

import json

import numpy as np
import pytest
from rims import circle

from cranio_nb.errors import InputRefused
from cranio_nb.evaluation import scores
from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.methods.design import assemble, design
from cranio_nb.methods.you import method as you
from cranio_nb.opening import Opening
from cranio_nb.vault import radius_measurement
from cranio_nb.volume import Volume


@pytest.fixture(scope="module")
def dome():
    """A spherical shell, radii 54 and 60 mm, with a round hole at its top whose rim stands 8 mm below the apex."""
    voxels = np.indices((64, 132, 132)) - np.array([0.0, 66, 66])[:, None, None, None]
    radius = np.sqrt((voxels**2).sum(axis=0))
    across = np.hypot(voxels[1], voxels[2])
    shell = (radius <= 60) & (radius >= 54)
    hole = across < np.sqrt(60**2 - 52**2) * radius / 60
    affine = np.array([[0, 0, 1.0, -66], [0, 1.0, 0, -66], [1.0, 0, 0, 0], [0, 0, 0, 1]])
    bone = Volume(shell & ~hole, affine)
    return bone, Opening(Volume(shell & hole & (radius > 56) & (radius < 58), affine), np.zeros(3))


@pytest.fixture(scope="module")
def filling(dome):
    bone, one = dome
    guides = circle(np.sqrt(60**2 - 51.5**2), 12, height=51.5)
    return you.fill_between(bone, one, guides)


def test_detours_are_left_out_of_a_way():
    assert you._without_detours([0, 1, 2, 3, 2, 4, 5]).tolist() == [0, 1, 2, 5, 6]
    assert you._without_detours([0, 1, 2, 3, 4, 5, 1]).tolist() == [1, 2, 3, 4, 5]  # a spur at the start


def test_over_a_cap_the_fill_lies_half_the_caps_height_too_deep(filling):
    """The planar bias: a flat fill over a cap of height h is off by h / 2 in the mean and h at most."""
    fill = filling.outer.mesh
    height = 60 - filling.outer_rim.points[:, 2].mean()
    areas = fill.areas
    depth = 60 - np.linalg.norm(fill.centres, axis=1)
    assert height == pytest.approx(8.5, abs=1.0)
    assert (areas @ depth) / areas.sum() == pytest.approx(height / 2, rel=0.08)
    assert depth.max() == pytest.approx(height, rel=0.08)


def test_the_solid_is_sound_and_its_rims_lie_on_the_bones_edge(filling):
    assert check_mesh(filling.solid).sound
    outer, inner = (np.linalg.norm(r.points, axis=1) for r in (filling.outer_rim, filling.inner_rim))
    assert np.abs(outer - 60).max() < 1.5 and np.abs(inner - 54).max() < 1.5
    assert len(filling.guides) == len(filling.partners) == 12


def test_guides_in_either_sense_give_the_same_rim(dome, filling):
    bone, one = dome
    turned = you.fill_between(bone, one, filling.guides[::-1])
    assert turned.solid.volume == pytest.approx(filling.solid.volume, rel=0.02)


def test_picked_guides_make_a_prosthesis(skull, openings, phantom):
    bone, found = skull("round"), openings("round")
    guides = [you.find_guides(radius_measurement.measure_around(bone, one), 9) for one in found]
    made = assemble(bone, found, you.between_guides(bone, found, guides), method="you", parameters={"smooth": True})
    json.dumps(made.record, allow_nan=False)
    same = design(bone, found, n_guides=9, method="you")
    np.testing.assert_array_equal(made.patch.voxels, same.patch.voxels)
    assert scores.dice(made.patch, Volume(phantom("round").implant, bone.affine)) > 0.5


def test_too_few_guides_are_refused(dome):
    bone, one = dome
    with pytest.raises(InputRefused) as refused:
        you.fill_between(bone, one, np.zeros((2, 3)))
    assert refused.value.code == "TooFewGuides"
