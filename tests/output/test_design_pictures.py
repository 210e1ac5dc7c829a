"""The pictures of a report: which are there, and that their words say what was done."""

import dataclasses

import numpy as np
import pytest

from cranio_nb.output import design_pictures
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import run_design
from data_synth import phantom_case
from data_synth.files import write_case


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    folder = tmp_path_factory.mktemp("case")
    write_case(folder, phantom_case("tiny", "unilateral", 0))
    return run_design(prepare(folder / "ct", truth=folder / "truth.nii.gz"), preset="paper")


def test_the_first_view_faces_the_opening(result):
    captions = [shot.caption for shot in design_pictures.view_shots(result)]
    assert captions[0] == "Facing the opening" and len(captions) == 3 and "From the left" in captions


def test_slices_say_how_they_were_filled(result):
    shots = design_pictures.slice_shots(result)
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
    assert design_pictures.distance_shots(bare) == design_pictures.slice_shots(bare) == []
