"""The table of a comparison as CSV, as JSON and as shown; its folder is whole or not there."""

import csv
import io
import json

import pytest
from stand_ins import STAND_INS

from cranio_nb.errors import CannotWrite
from cranio_nb.output import comparison_folder, comparison_page
from cranio_nb.output.files import json_text
from cranio_nb.output.staging import staged
from cranio_nb.pipeline import compare


def test_csv_and_json_hold_the_same_rows(found):
    table = list(csv.DictReader(io.StringIO(comparison_folder.comparison_csv(found))))
    record = json.loads(json_text(comparison_folder.comparison_record(found)))
    assert [row["name"] for row in table] == [m["name"] for m in record["methods"]] == list(STAND_INS)
    for row, other in zip(table, record["methods"], strict=True):
        assert row["status"] == other["status"] and row["message"] == other["message"]
        for key in compare.MEASURES:
            assert (row[key] == "") == (other[key] is None)
            assert row[key] == "" or float(row[key]) == other[key]
    assert record["reference"] == "truth" and record["colour_scale_mm"] == [0, found.top]


def test_all_or_nothing(found, tmp_path, monkeypatch):
    def full_disk(*_):
        raise OSError(28, "No space left on device")

    with staged(tmp_path / "good") as part:
        comparison_folder.write_comparison(found, part)
    assert {p.name for p in (tmp_path / "good").iterdir()} == set(comparison_folder.FILES)
    monkeypatch.setattr(comparison_page, "comparison_page", full_disk)
    with pytest.raises(CannotWrite), staged(tmp_path / "new" / "out") as part:
        comparison_folder.write_comparison(found, part)
    assert [p.name for p in tmp_path.iterdir()] == ["good"]


def test_best_is_what_is_printed_best(found):
    accuracy, implant = comparison_folder.tables(found)
    assert accuracy["best"]["dice"] == 1 and accuracy["best"]["hd95"] == 0
    assert accuracy["best"]["volume_ratio"] is None and implant["best"]["overlap"] is None
