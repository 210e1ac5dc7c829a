"""The command `inspect`: how a scan was read, and its openings."""

import json

from cli_runs import cranio


def test_inspect_tells_reading_and_openings(home):
    table = cranio("inspect", home / "ct")
    assert table.exit_code == 0 and "SeriesChosen" in table.stdout and "left" in table.stdout
    record = json.loads(cranio("inspect", home / "ct", "--json").stdout)
    (opening,) = record["openings"]
    assert record["load"]["kind"] == "ct" and record["problem"] is None
    truth = json.loads((home / "truth.json").read_text())
    first, end = truth["planes"]
    assert abs(opening["planes"][0] - first) <= 1 and abs(opening["planes"][1] - (end - 1)) <= 1
    assert 45 < opening["width"] <= opening["length"] < 70


def test_a_closed_skull_is_described_before_it_is_refused(closed_skull):
    result = cranio("inspect", closed_skull, "--json")
    record = json.loads(result.stdout)
    assert result.exit_code == 4 and record["problem"] == "NoOpening" and record["openings"] == []
    assert record["load"]["kind"] == "mask"
