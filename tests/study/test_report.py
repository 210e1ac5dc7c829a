"""A report is read off the folder, also where the plan, the scans or the methods are gone."""

import json

import pytest
from executors import Inline
from studies import plan, rows_for, version

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.errors import InputRefused
from cranio_nb.study import report, run
from cranio_nb.study.report import files_of, read_study, write_report
from cranio_nb.study.run import run_study
from cranio_nb.study.store import Store

WORDS = {
    "cases": [{"kind": "phantom", "size": "tiny", "defects": ["burr_hole"], "seeds": [0, 1, 2]}],
    "methods": {"slicewise": {"skip_mm": [0, 3]}},
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for module in (run, report):
        monkeypatch.setattr(module, "version_of", version)
    monkeypatch.setattr(run, "do_batch", rows_for)
    run_study(plan(), tmp_path, Inline())
    Store(tmp_path).keep_plan(WORDS)
    return tmp_path


def test_files_are_those_that_were_said(folder, tmp_path):
    found = read_study(folder)
    (tmp_path / "out").mkdir()
    write_report(found, tmp_path / "out")
    assert {path.name for path in (tmp_path / "out").iterdir()} == {*files_of(found)}
    assert files_of(found) == ("study.html", "rows.csv", "best-slicewise.json")
    head, *lines = (tmp_path / "out" / "rows.csv").read_text().splitlines()
    assert head.startswith('"key","case"') and len(lines) == 3
    assert json.loads((tmp_path / "out" / "best-slicewise.json").read_text()) == {}


def test_what_is_missing_is_counted_where_the_plan_is_known(folder):
    assert read_study(folder).missing == 6  # the stand-in's rows name no options: of the newest, one for each case
    assert len(read_study(folder).cases) == 3
    Store(folder).keep_plan(WORDS | {"methods": {"gone": {}}})
    assert read_study(folder).missing is None and len(read_study(folder).cases) == 3
    (folder / "study.json").unlink()
    assert read_study(folder).cases == ()


def test_the_newest_row_of_a_run_counts(folder):
    old = Store(folder).columns()
    Store(folder).add([{"key": "new", "case": old["case"][0], "contender": "slicewise", "options": "{}", "dice": 0.75}])
    assert sorted(read_study(folder).columns["dice"].tolist()) == [0.5, 0.5, 0.75]


def test_a_folder_without_rows_is_refused(tmp_path):
    with pytest.raises(InputRefused, match="no rows"):
        read_study(tmp_path)
