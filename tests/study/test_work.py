"""A batch becomes rows, whatever its case or its methods do."""

import json

import pytest
from studies import unreadable

from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline.trial import Contender, Trial, attempt
from cranio_nb.study.cases import phantom_cases, scan_cases
from cranio_nb.study.work import Batch, do_batch
from cranio_nb.volume import Volume
from data_synth import Pose, face_case

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


def test_a_row_says_what_its_scan_warns_of(tmp_path):
    """Slices of 4.6 mm, and a third hole that they blur."""
    pose = Pose(26.872020257320415, 29.410560118651205, 129.79138231653252)
    made = face_case("tiny", 52028, holes=3, pose=pose, slice_mm=4.621466080659742, reach="neck", around=("couch",))
    write_nifti(Volume(made.hu, made.affine), tmp_path / "ct.nii.gz")
    (row,) = do_batch(batch(Contender("hull"), case=scan_cases(["ct.nii.gz"], folder=tmp_path)[0]), b"", attempt)
    said = [one.split(": ")[0] for one in json.loads(row["warnings"])]
    assert row["n_openings"] == 2 and said.count("DoubtfulOpening") == 1 and "ThickSlices" in said
    (plain,) = do_batch(batch(Contender("hull")), b"", attempt)
    assert "DoubtfulOpening" not in plain["warnings"]


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
