"""Mirrored prostheses: exact on symmetric heads, refused where there is nothing to copy."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.errors import InputRefused
from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.methods import reflection
from cranio_nb.methods.design import design
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.volume import Volume
from data_synth import phantom_case, scan
from data_synth.head import SHAPE_TERMS, THICKNESS_TERMS


def dice(a, b):
    return 2 * (a & b).sum() / (a.sum() + b.sum())


def even(coefficients, terms):
    return np.where(np.array(terms)[:, 0] % 2, 0.0, coefficients)


@pytest.fixture(scope="module")
def symmetric():
    """A head like its mirror image with one large hole: bone and the missing bone."""
    case = phantom_case("tiny", "large", 0)
    head = replace(
        case.head, shape=even(case.head.shape, SHAPE_TERMS), thickness=even(case.head.thickness, THICKNESS_TERMS)
    )
    _, bone, implant = scan(head, case.affine, case.bone.shape)
    return Volume(bone, case.affine), implant


def test_a_symmetric_head_gets_its_own_bone_back(symmetric):
    bone, implant = symmetric
    assert dice(design(bone, method="reflection", preset="paper").patch.voxels, implant) > 0.93


def test_there_is_nothing_to_fit_on_a_symmetric_head(symmetric):
    """The difference to the rim is noise: it moves the surfaces by far less than a voxel."""
    bone, _ = symmetric
    (fitted,), (plain,) = (design(bone, fit_rim=on, method="reflection").working for on in (True, False))
    for a, b in ((fitted.outer, plain.outer), (fitted.inner, plain.inner)):
        assert np.nanmean(np.abs(a - b)) < 0.4


def test_the_fitted_image_meets_the_rim(skull, openings):
    """A head that is not symmetric: along the hole's edge the step to the nearest bone shrinks."""
    steps = []
    for on in (False, True):
        (made,) = design(skull("burr_hole"), openings("burr_hole"), fit_rim=on, method="reflection").working
        hole, bone = made.radius_map.hole, made.radius_map.outer
        known = np.isfinite(bone) & ~ndimage.binary_dilation(hole, iterations=2)
        v, u = ndimage.distance_transform_edt(~known, return_distances=False, return_indices=True)
        edge = hole & ~ndimage.binary_erosion(hole)
        steps.append(np.abs(made.outer - bone[v, u])[edge].mean())
    assert steps[1] < steps[0]


def test_the_difference_of_a_linear_step_goes_on_across_the_hole(skull, openings):
    (made,) = design(skull("burr_hole"), openings("burr_hole"), method="reflection").working
    v, u = np.indices(made.radius_map.outer.shape)
    step = 1.0 + 0.01 * v - 0.02 * u
    known = np.where(made.radius_map.hole, np.nan, step)
    found = reflection._difference(made.radius_map, known, 2.0)
    np.testing.assert_allclose(found[made.radius_map.hole], step[made.radius_map.hole], atol=0.1)


@pytest.mark.parametrize("defect", ["vertex", "bilateral"])
def test_what_has_no_mirror_image_is_refused_with_a_remedy(defect, skull, openings):
    with pytest.raises(InputRefused) as refused:
        design(skull(defect), openings(defect), method="reflection")
    assert refused.value.code == "MirrorMissing"
    assert "partial" in refused.value.remedy and "%" in refused.value.message


@pytest.mark.parametrize("defect", ["vertex", "bilateral"])
def test_the_possible_part_has_bone_on_the_other_side(defect, skull, openings):
    bone = skull(defect)
    made = design(bone, openings(defect), partial=True, method="reflection")
    assert made.patch.voxels.any() and not (made.patch.voxels & bone.voxels).any()
    assert check_mesh(made.mesh).sound
    plane = made.working[0].plane
    image = bone.to_voxel(plane.mirror(bone.to_world(np.argwhere(made.patch.voxels))))
    index = np.clip(np.rint(image).astype(int), 0, np.array(bone.shape) - 1)
    near = ndimage.binary_dilation(bone.voxels, np.ones((3, 3, 3)))
    assert near[tuple(index.T)].mean() > 0.9
    for entry in made.record["openings"]:
        assert 0.03 < entry["without_mirror_image"] < 1


def test_a_possible_opening_is_closed_as_if_it_were_alone(phantom, skull, openings):
    """The whole hole is possible, so asking for the possible part changes nothing."""
    whole = design(skull("burr_hole"), openings("burr_hole"), method="reflection")
    part = design(skull("burr_hole"), openings("burr_hole"), partial=True, method="reflection")
    np.testing.assert_array_equal(whole.patch.voxels, part.patch.voxels)


def test_the_plane_is_in_the_record(skull, openings):
    made = design(skull("burr_hole"), openings("burr_hole"), method="reflection")
    record = json.loads(json.dumps(made.record, allow_nan=False))["symmetry"]
    assert record == made.working[0].plane.record()
    assert {"angle_deg", "offset_mm", "residual_mm", "converged"} <= set(record)


def test_two_small_holes_that_are_not_partners_are_both_closed():
    case = phantom_case("tiny", "bilateral", 0, diameter=24.0)
    bone = Volume(case.bone, case.affine)
    made = design(bone, find_openings(bone), method="reflection")
    assert len(made.working) == 2 and all(part.lost < 0.03 for part in made.working)
