"""The truth measured against itself, and against a truth moved by a known way."""

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.evaluation.against_truth import check_truth, measure_against, true_prosthesis
from cranio_nb.mesh import Mesh
from cranio_nb.prosthesis import Prosthesis


@pytest.fixture(scope="module")
def true(phantom, skull, openings):
    truth = skull().with_voxels(phantom().implant)
    return true_prosthesis(truth, skull(), openings()[0].head_centre)


def test_the_truth_against_itself_is_perfect(true, skull, openings):
    found = check_truth(true, true.patch, skull(), openings()[0].head_centre)
    assert found.score.dice == 1 and found.score.hd95 == 0
    for side in ("outer", "inner"):
        np.testing.assert_allclose(found.distances[side], 0, atol=1e-9)
        assert found.table3[side].max == pytest.approx(0, abs=1e-9)


def test_a_truth_moved_outwards_is_at_most_as_far_away_in_mm_and_in_voxels(true, skull):
    """3 mm along the columns, which are 1.5 mm apart or whatever the grid says."""
    shift = 3.0 * skull().axes[2]
    moved = Prosthesis(Mesh(true.mesh.vertices + shift, true.mesh.faces), true.sides, true.patch, "moved")
    found = measure_against(moved, true, skull())
    for side in ("outer", "inner"):
        assert 0 < found.distances[side].max() <= 3.0 + 1e-9
        assert found.table3[side].max <= 3.0 / skull().spacing[2] + 1e-9


def test_a_mesh_without_voxels_is_refused(true, skull):
    with pytest.raises(InputRefused) as refused:
        measure_against(Prosthesis(true.mesh, true.sides, None, "none"), true, skull())
    assert refused.value.code == "NoPatch"
