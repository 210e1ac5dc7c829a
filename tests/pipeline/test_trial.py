"""One method on one skull: what comes of it, in this process and in one of its own."""

import numpy as np
import pytest

import cranio_nb as cn
from cranio_nb.errors import InputRefused
from cranio_nb.methods import catalogue
from cranio_nb.methods.piece import Piece
from cranio_nb.pipeline import trial
from cranio_nb.pipeline.trial import Contender, attempt, attempt_apart, contenders

TOP_HAT = "plane above the bone"


def sheets(bone, openings, *, shift=0):
    """Fills each opening by its coarse sheet; uses a name of its module."""
    for opening in openings:
        yield Piece(np.roll(opening.sheet.voxels, shift, axis=0), (), {"note": TOP_HAT})


@pytest.fixture
def mine():
    cn.add_method("mine", sheets, presets={"higher": {"shift": 1}})
    yield "mine"
    catalogue.remove_method("mine")


class TestContenders:
    def test_by_name_once_each(self):
        assert contenders(["slicewise:paper", "slicewise", "slicewise"]) == (
            Contender("slicewise", "paper"),
            Contender("slicewise"),
        )
        assert [c.name for c in contenders(["slicewise:paper"])] == ["slicewise:paper"]

    def test_all_by_default_with_each_of_their_presets(self, mine):
        names = [c.name for c in contenders()]
        assert set(catalogue.METHODS) <= set(names) and "slicewise:paper" in names
        assert names[-2:] == ["mine", "mine:higher"]

    @pytest.mark.parametrize("name", ["magic", "slicewise:best", ":paper"])
    def test_unknown_names_are_refused(self, name):
        with pytest.raises(InputRefused, match=r"no preset|There is no"):
            contenders([name])


class TestApart:
    def test_is_the_same_design_and_does_not_count_what_this_process_holds(self, skull, openings):
        case = skull("round"), openings("round")
        here = attempt(*case, Contender("hull", "paper"))
        ballast = np.ones(50_000_000)  # 400 MB
        apart = attempt_apart(*case, Contender("hull", "paper"))
        np.testing.assert_array_equal(apart.prosthesis.patch.voxels, here.prosthesis.patch.voxels)
        np.testing.assert_array_equal(apart.prosthesis.mesh.vertices, here.prosthesis.mesh.vertices)
        assert apart.prosthesis.parameters == here.prosthesis.parameters
        assert 20 < apart.memory < trial.peak_memory() - 100 and ballast.nbytes == 4e8

    def test_a_refusal_comes_back_as_a_sentence(self, skull, openings):
        whole = skull("round").with_voxels(np.zeros(skull("round").shape, bool))
        apart = attempt_apart(whole, openings("round"), Contender("slicewise"))
        assert apart.status != "done" and apart.prosthesis is None and apart.message.endswith(".")

    def test_a_method_of_this_process_works_there_too(self, mine, skull, openings):
        case = skull("round"), openings("round")
        apart = attempt_apart(*case, Contender("mine", "higher"))
        assert apart.status == "done", apart.message
        here = cn.design(*case, method="mine", preset="higher")
        np.testing.assert_array_equal(apart.prosthesis.patch.voxels, here.patch.voxels)
        assert apart.prosthesis.parameters == {"shift": 1, "smooth": True}
        assert apart.prosthesis.record["note"] == TOP_HAT


def test_a_patch_that_runs_out_of_the_image_is_a_failure_and_no_refusal(skull, openings):
    def pieces(bone, openings):
        voxels = np.zeros(bone.shape, bool)
        voxels[-1] = True
        yield Piece(voxels)

    cn.add_method("mine", pieces)
    try:
        ended = attempt(skull("round"), openings("round"), Contender("mine"))
        assert (ended.status, ended.code) == ("no patch", "PatchLeavesOpening")
    finally:
        catalogue.remove_method("mine")
