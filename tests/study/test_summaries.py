"""Means, deviations and worst values in closed form, and the classes of size and place."""

import math

import numpy as np
import pytest
from studies import columns

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.study.summaries import counts, places, sizes, summary, where


def test_mean_deviation_and_worst():
    found = summary(columns(3, dice=[0.9, 0.8, 0.7], hd95=[1.0, 4.0, 1.0], volume_ratio=[1.1, 0.7, 1.2]))
    assert found["dice"] == pytest.approx((0.8, math.sqrt(0.02 / 3), 0.7))
    assert found["hd95"] == pytest.approx((2.0, math.sqrt(2.0), 4.0))
    assert found["volume_ratio"] == pytest.approx((1.0, math.sqrt(0.14 / 3), 0.7))
    assert np.isnan(found["assd"]).all()


def test_a_failure_counts_as_no_overlap_and_a_refusal_not_at_all():
    nan = math.nan
    ends = ["done", "no patch", "broken", "refused"]
    rows = columns(4, dice=[0.8, nan, nan, nan], hd95=[2.0, nan, nan, nan], status=ends)
    found = summary(rows)
    assert found["dice"] == pytest.approx((0.8 / 3, math.sqrt(2 / 9) * 0.8, 0.0))
    assert found["hd95"] == (2.0, 0.0, 2.0)
    assert counts(rows) == "1 done, 2 failed, 1 refused"


def test_some_of_the_rows():
    rows = columns(3, dice=[0.1, 0.2, 0.3])
    assert where(rows, rows["dice"] > 0.15)["dice"].tolist() == [0.2, 0.3]


def test_classes_are_what_was_asked_where_nothing_was_found():
    rows = columns(4, length_mm=[20.0, 119.0, np.nan, np.nan], asked_mm=[80.0, np.nan, 40.0, np.nan])
    assert sizes(rows).tolist() == ["20 to 40 mm", "above 100 mm", "40 to 60 mm", "not known"]
    rows = columns(3, defect=["vertex", "", ""], place=["top", "left", ""])
    assert places(rows).tolist() == ["vertex", "left", "not known"]
