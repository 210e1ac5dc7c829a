"""A plan on disk: what it may say, and that the example of the command is a plan."""

import json

import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.study.plan_file import cases_of, example, plan_of, read_plan

PHANTOMS = {"kind": "phantom", "size": "tiny", "seeds": [0, 1], "defects": ["burr_hole", "round"]}


def test_every_group_of_cases_is_filled_in(tmp_path):
    for name in ("b", "a"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "skull.nii.gz").touch()
    words = {
        "folder": str(tmp_path),
        "cases": [
            PHANTOMS,
            {"kind": "scan", "paths": ["*/skull.nii.gz"], "truth": "truth.nii.gz"},
            {"kind": "cut", "paths": ["a/*.gz"], "defects": ["vertex"], "diameters_mm": [20, 40]},
        ],
    }
    found = cases_of(words)
    assert [case.kind for case in found] == ["phantom"] * 4 + ["scan"] * 2 + ["cut"] * 2
    assert found[4].source == {"path": "a/skull.nii.gz", "truth": "a/truth.nii.gz", "mask": None}
    assert [case.facts["asked_mm"] for case in found[6:]] == [20, 40]


def test_a_file_is_read_from_its_own_folder(tmp_path):
    (tmp_path / "plan.json").write_text(json.dumps({"cases": [PHANTOMS], "methods": {"hull": {"axial": {}}}}))
    plan, words = read_plan(tmp_path / "plan.json")
    assert plan.n_runs == 8 and plan_of(words) == plan and words["folder"] == str(tmp_path)


@pytest.mark.parametrize("method", ["slicewise", "thin-plate", "dnurbs"])
def test_the_example_is_a_plan(method):
    plan = plan_of(example((method,)))
    assert len(plan.cases) == 6 and len(plan.settings) == 21
    assert {s.threshold_hu is None for s in plan.settings} == {True, False}


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"case": []}, "'case' means nothing"),
        ({"cases": []}, "no cases"),
        ({"methods": {}}, "no methods"),
        ({"methods": {"magic": {}}}, "no method named 'magic'"),
        ({"methods": {"hull": [1]}}, "are no object"),
        ({"random": True}, "no whole number"),
        ({"cases": [{"kind": "wish"}]}, "no known kind"),
        ({"cases": [PHANTOMS | {"path": "x"}]}, "'path' means nothing"),
        ({"cases": [PHANTOMS | {"seeds": [0.5]}]}, "no list of whole numbers"),
        ({"cases": [PHANTOMS | {"defects": ["star"]}]}, "no defect 'star'"),
        ({"cases": [PHANTOMS | {"size": "huge"}]}, "size or head"),
        ({"cases": [{"kind": "scan", "paths": ["nowhere/*"]}]}, "nothing lies at"),
        ({"cases": [{"kind": "scan", "paths": ["*"], "mask": 1}]}, "no truth value"),
    ],
)
def test_what_means_nothing_is_refused(change, words, tmp_path):
    plan = {"cases": [PHANTOMS], "methods": {"hull": {}}, "folder": str(tmp_path)}
    with pytest.raises(InputRefused, match=words):
        plan_of(plan | change)


@pytest.mark.parametrize("text", ["", "[1]", "{", "[" * 5000])
def test_a_file_that_is_no_plan_is_refused(text, tmp_path):
    (tmp_path / "plan.json").write_text(text)
    with pytest.raises(InputRefused, match=r"plan\.json holds no JSON object"):
        read_plan(tmp_path / "plan.json")
    with pytest.raises(InputRefused, match="cannot be read"):
        read_plan(tmp_path / "gone.json")
