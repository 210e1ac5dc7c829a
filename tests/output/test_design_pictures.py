"""The pictures of a report: which are there, and that their words say what was done."""

import dataclasses

import numpy as np

from cranio_nb.output import design_pictures


def test_the_first_view_faces_the_opening(result):
    views = design_pictures.skull_views(result.case)
    found = design_pictures.view_shots(result.case, views, result.prosthesis.mesh)
    captions = [shot.caption for shot in found]
    assert captions[0] == "Facing the opening" and len(captions) == 3 and "From the left" in captions


def test_slices_say_how_they_were_filled(result):
    shots = design_pictures.slice_shots(result.case, result.prosthesis)
    assert len(shots) == design_pictures.N_SLICES
    own = [shot for shot in shots if "outer: θ₀" in shot.caption]
    assert own and all("inner: θ₀" in shot.caption and "blue" in shot.alt for shot in own)
    assert len({shot.width for shot in shots}) == 1


def test_distance_maps_end_with_their_scale(result):
    *maps, scale = design_pictures.distance_shots(result)
    assert [shot.caption.split(" side")[0] for shot in maps] == ["Outer", "Inner"]
    for shot, d in zip(maps, result.truth.distances.values(), strict=True):
        assert f"mean {d.mean():.2f} mm, largest {d.max():.2f} mm" in shot.alt
    assert scale.caption == "Colour scale of both maps"


def test_the_scale_ends_at_a_round_number_above_nearly_all(result):
    top = design_pictures._top_of_scale(result.truth)
    assert top % 0.5 == 0 and all(np.percentile(d, 99) <= top for d in result.truth.distances.values())


def test_without_a_truth_or_slices_there_is_nothing_to_show(result):
    bare = dataclasses.replace(result, truth=None, prosthesis=dataclasses.replace(result.prosthesis, working=()))
    assert design_pictures.distance_shots(bare) == design_pictures.slice_shots(bare.case, bare.prosthesis) == []


def test_the_scan_is_shown_in_three_planes_through_the_patch(result):
    shots = design_pictures.cut_shots(result.case, result.prosthesis)
    assert [shot.caption.split(" cut")[0] for shot in shots] == ["Axial", "Coronal", "Sagittal"]
    assert all("CT" in shot.alt and "scale bar is 50 mm" in shot.alt and "left" in shot.alt for shot in shots)
    place = design_pictures._place_in(result.prosthesis.patch, result.case.openings[0].centre)
    assert result.prosthesis.patch.at(place, outside=False)
    plane = round(float(result.case.bone.to_voxel(place)[0]))
    assert shots[0].caption == f"Axial cut, plane {plane}, seen from the feet"


def test_all_bone_above_the_face_is_in_the_cuts(result):
    low, high = design_pictures._shown_corners(result.case)
    places = result.case.bone.to_world(np.argwhere(result.case.bone.voxels))
    centre = result.case.openings[0].head_centre
    above = places[places[:, 2] > centre[2] - 50]
    assert (above > low).all() and (above < high).all()


def test_a_slice_whose_curves_cross_is_shown_and_named(crossed):
    shots = design_pictures.slice_shots(crossed.case, crossed.prosthesis)
    told = [shot for shot in shots if "do not trust" in shot.caption]
    assert told and all("crosses mark where" in shot.alt for shot in told)
    first, *rest = crossed.prosthesis.working
    assert not rest
    # in another direction only: one more picture than of the first alone
    plain = dataclasses.replace(first, slices=tuple(s for s in first.slices if not len(s.crossings)))
    picked = design_pictures._picked([plain, first], 2)
    assert len(picked) == 3 and picked[-1][0] == 1 and len(first.slices[picked[-1][1]].crossings)
