"""The table of a comparison as CSV, as JSON and as shown."""

import csv
import io
import json

from stand_ins import STAND_INS

from cranio_nb.output import comparison_tables
from cranio_nb.output.files import json_text
from cranio_nb.pipeline import compare


def test_csv_and_json_hold_the_same_rows(found):
    table = list(csv.DictReader(io.StringIO(comparison_tables.comparison_csv(found))))
    record = json.loads(json_text(comparison_tables.comparison_record(found)))
    assert [row["name"] for row in table] == [m["name"] for m in record["methods"]] == list(STAND_INS)
    for row, other in zip(table, record["methods"], strict=True):
        assert row["status"] == other["status"] and row["message"] == other["message"]
        for key in compare.MEASURES:
            assert (row[key] == "") == (other[key] is None)
            assert row[key] == "" or float(row[key]) == other[key]
    assert record["reference"] == "truth" and record["colour_scale_mm"] == [0, found.top]


def test_best_is_what_is_printed_best(found):
    accuracy, implant = comparison_tables.tables(found)
    assert accuracy["best"]["dice"] == 1 and accuracy["best"]["hd95"] == 0
    assert accuracy["best"]["volume_ratio"] is None and implant["best"]["overlap"] is None
