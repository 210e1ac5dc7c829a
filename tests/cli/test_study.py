"""`cranio-nb study`: a plan, its runs, its report, and what is refused."""

import json
from contextlib import contextmanager

import pytest
from cli_runs import assert_refused, cranio
from executors import Inline
from studies import rows_for, version

from cranio_nb.cli.study import _duration

pytest.importorskip("distributed", reason="the extra `study` is not installed")

from cranio_nb.study import cluster, report, run
from cranio_nb.study.cluster import Workers

PLAN = {
    "cases": [{"kind": "phantom", "size": "tiny", "defects": ["burr_hole"], "seeds": [0, 1, 2]}],
    "methods": {"slicewise": {"skip_mm": [0, 3]}},
}


@pytest.fixture
def plan(tmp_path, monkeypatch):
    """A plan on disk; work is done at once, and nothing is designed."""

    @contextmanager
    def workers(scheduler=None, **asked):
        yield Workers(Inline(), f"page of {scheduler or 'here'}")

    monkeypatch.setattr(cluster, "dask_workers", workers)
    monkeypatch.setattr(run, "do_batch", rows_for)
    for module in (run, report):
        monkeypatch.setattr(module, "version_of", version)
    (tmp_path / "plan.json").write_text(json.dumps(PLAN))
    return tmp_path / "plan.json"


def test_runs_and_goes_on(plan, tmp_path):
    first = cranio("study", "run", plan, "--out", tmp_path / "study", "--part", "1/3")
    assert "3 of 3 runs done, 3 of them now, 0 failed" in first.stdout and "page of here" in first.stderr
    again = cranio("study", "run", plan, "--out", tmp_path / "study", "--scheduler", "tcp://127.0.0.1:1")
    assert "9 of 9 runs done, 6 of them now" in again.stdout and "9 of 9 runs" in again.stderr
    made = cranio("study", "report", tmp_path / "study")
    assert made.exit_code == 0, made.output
    assert "best-slicewise.json" in made.stdout and (tmp_path / "study" / "report" / "study.html").exists()
    assert cranio("study", "report", tmp_path / "study").exit_code == 0  # its own files may be replaced


def test_the_new_plan_is_one(tmp_path):
    path = tmp_path / "mine.json"
    assert cranio("study", "new", path, "--method", "thin-plate").exit_code == 0
    assert set(json.loads(path.read_text())["methods"]) == {"thin-plate"}
    again = cranio("study", "new", path)
    assert again.exit_code == 2 and "is there already" in again.stderr


@pytest.mark.parametrize("part", ["0/2", "3/2", "1", "a/b"])
def test_parts_that_are_none_are_refused(part, plan, tmp_path):
    found = cranio("study", "run", plan, "--out", tmp_path / "x", "--part", part)
    assert found.exit_code == 2 and "I/N" in found.stderr


def test_a_plan_that_means_nothing_is_a_fault_of_its_argument(plan, tmp_path):
    plan.write_text("{}")
    found = cranio("study", "run", plan, "--out", tmp_path / "x")
    assert found.exit_code == 2 and "there are no cases" in found.stderr and not (tmp_path / "x").exists()


def test_workers_of_this_machine_are_not_asked_of_a_scheduler(plan, tmp_path):
    found = cranio("study", "run", plan, "--out", tmp_path / "x", "--scheduler", "tcp://x", "--workers", 2)
    assert found.exit_code == 2 and "--scheduler" in found.stderr


def test_a_folder_without_rows_is_refused(tmp_path):
    assert_refused(cranio("study", "report", tmp_path), 3, "no rows")


def test_without_the_extra_it_says_what_to_install(plan, tmp_path, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "distributed", None)
    monkeypatch.delitem(__import__("sys").modules, "cranio_nb.study.cluster")
    assert_refused(cranio("study", "run", plan, "--out", tmp_path / "x"), 3, "[study]")


def test_times_are_two_whole_numbers():
    assert [_duration(s) for s in (59.9, 3700, 86400 * 3 + 7200)] == ["0 min 59 s", "1 h 1 min", "3 d 2 h"]


class TestNothingIsLost:
    def test_a_file_of_that_name_that_is_no_study_stays(self, plan, tmp_path):
        (tmp_path / "study.json").write_text("[]")
        found = cranio("study", "run", plan, "--out", tmp_path)
        assert found.exit_code == 5 and "study.json" in found.stderr and (tmp_path / "study.json").read_text() == "[]"

    def test_rows_of_others_stay(self, plan, tmp_path):
        (tmp_path / "x" / "rows").mkdir(parents=True)
        (tmp_path / "x" / "rows" / "mine.txt").touch()
        assert cranio("study", "run", plan, "--out", tmp_path / "x").exit_code == 5

    def test_the_plan_stays_though_its_name_is_that_of_the_copy(self, plan, tmp_path):
        plan.rename(tmp_path / "study.json")
        found = cranio("study", "run", tmp_path / "study.json", "--out", tmp_path)
        assert found.exit_code == 2 and json.loads((tmp_path / "study.json").read_text()) == PLAN

    def test_no_study_lies_in_a_scan(self, plan, tmp_path):
        (tmp_path / "ct").mkdir()
        plan.write_text(json.dumps(PLAN | {"cases": [{"kind": "scan", "paths": ["ct"]}]}))
        found = cranio("study", "run", plan, "--out", tmp_path / "ct" / "x")
        assert found.exit_code == 2 and "lies in, the scan ct" in found.stderr and not any((tmp_path / "ct").iterdir())
