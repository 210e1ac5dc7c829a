"""A batch becomes rows, whatever its case or its methods do."""

import json

import pytest
from studies import unreadable

from cranio_nb.pipeline.trial import Contender, Trial, attempt
from cranio_nb.study.cases import phantom_cases
from cranio_nb.study.work import Batch, do_batch

(CASE,) = phantom_cases(["burr_hole"], [0], size="tiny")


def batch(*contenders, case=CASE, threshold=None):
    n = range(len(contenders))
    return Batch(case, threshold, contenders, tuple(f"key{i}" for i in n), tuple("1" for _ in n))


def test_each_setting_is_a_row_with_its_measures():
    rows = do_batch(
        batch(Contender("hull"), Contender("hull", "default", {"axial": True}), threshold=350.0), b"", attempt
    )
    assert [row["key"] for row in rows] == ["key0", "key1"]
    assert [json.loads(row["options"]) for row in rows] == [{}, {"axial": True}]
    for row in rows:
        assert row["status"] == "done" and 0.6 < row["dice"] <= 1 and row["threshold_hu"] == 350.0
        assert row["case"] == CASE.name and row["defect"] == "burr_hole" and 5 < row["length_mm"] < 20
    assert rows[0]["dice"] != rows[1]["dice"]


@pytest.mark.parametrize(
    ("case", "status", "code"),
    [(phantom_cases(["partial"], [0], size="tiny")[0], "no patch", "NoOpening"), (unreadable(), "refused", "NotFound")],
    ids=["no hole", "no file"],
)
def test_a_case_that_cannot_be_used_is_a_row_for_each_run(case, status, code):
    rows = do_batch(batch(Contender("hull"), Contender("slicewise"), case=case), b"", attempt)
    assert [(row["key"], row["status"], row["code"]) for row in rows] == [
        ("key0", status, code),
        ("key1", status, code),
    ]
    assert all(row["message"] for row in rows)


def test_a_fault_of_one_run_leaves_the_others():
    def faulty(bone, found, contender):
        if contender.method == "slicewise":
            raise MemoryError("a path")
        return Trial(contender, "refused", None, "TooSmall", "It is too small.", 0.0, 0.0, 0.0)

    rows = do_batch(batch(Contender("slicewise"), Contender("hull")), b"", faulty)
    assert [row["status"] for row in rows] == ["broken", "refused"]
    assert rows[0]["code"] == "MemoryError" and "a path" not in rows[0]["message"]


def test_runs_can_be_parted():
    parts = batch(Contender("hull"), Contender("slicewise")).singly()
    assert [(part.keys, part.contenders[0].method) for part in parts] == [(("key0",), "hull"), (("key1",), "slicewise")]
