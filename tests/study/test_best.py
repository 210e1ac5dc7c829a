"""The best setting, and how much of its lead is luck."""

import json

import numpy as np
import pytest
from studies import columns

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.cli.options import read_params
from cranio_nb.study.best import best_setting, chosen, target_of
from cranio_nb.study.sensitivity import parameters, usual_options

SETTINGS = ("{}", '{"skip_mm": 3.0}', '{"skip_mm": 5.0}')


def rows(table, key="dice", **given):
    """A measure of each case (rows) with each of the three settings."""
    table = np.array(table, float)
    names = [f"case{i}" for i in range(len(table)) for _ in SETTINGS]
    return columns(table.size, case=names, options=list(SETTINGS) * len(table), **{key: table.ravel()}, **given)


def test_has_the_best_mean_and_says_how_it_spreads():
    best = best_setting(rows([[0.8, 0.9, 0.7], [0.6, 0.8, 0.9], [0.7, 0.3, 0.3]]), "dice")
    assert best.options == {} and best.found == pytest.approx((0.7, np.sqrt(0.02 / 3), 0.6))
    found = rows([[0.8, 0.9, 0.7], [0.6, 0.8, 0.9]])
    best = best_setting(found, "dice", parameters(found, usual_options(found)))
    assert best.options == {"skip_mm": 3.0} and best.usual.mean == pytest.approx(0.7)
    assert (best.better_in, best.n_cases, best.n_settings) == (2, 2, 3)
    assert best.by_case == {"skip_mm": (3.0, 4.0, 5.0)}


def test_the_low_end_is_the_best_of_a_distance():
    assert best_setting(rows([[2.0, 1.0, 3.0]], "rim_gap"), "rim_gap").options == {"skip_mm": 3.0}


def test_held_out_is_chosen_by_the_others():
    # on case 0 alone setting 1 is best, on case 1 alone setting 2: each is judged by the choice of the other
    best = best_setting(rows([[0.5, 0.9, 0.2], [0.5, 0.1, 0.8]]), "dice")
    assert best.held_out == pytest.approx((0.2 + 0.1) / 2)


def test_failures_weigh_and_refusals_leave_a_setting_out():
    nan, ends = np.nan, ["done", "done", "refused", "done", "no patch", "done"]
    table = [[0.5, 0.9, nan], [0.5, nan, 0.99]]
    best = best_setting(rows(table, status=ends), "dice")
    assert best.options == {} and best.n_settings == 2  # 0.9 and a failure are 0.45
    best = best_setting(
        rows([[2.0, 1.0, 3.0], [2.0, nan, 9.0]], "rim_gap", status=["done"] * 4 + ["broken", "done"]), "rim_gap"
    )
    assert best.options == {}  # the failure counts as the worst gap there is: 9 mm


def test_a_case_that_the_study_has_only_begun_does_not_count():
    nan = np.nan
    best = best_setting(rows([[0.8, 0.9, 0.7], [0.6, 0.8, 0.9], [0.99, nan, nan]]), "dice")
    assert best.options == {"skip_mm": 3.0} and (best.n_cases, best.n_settings) == (2, 3)


def test_nothing_known_has_no_best():
    assert best_setting(rows([[np.nan] * 3]), "dice") is None


def test_settings_are_judged_by_the_truth_where_it_is_known():
    assert target_of(rows([[0.1, 0.2, np.nan]])) == "dice" and target_of(rows([[1, 2, 3]], "rim_gap")) == "rim_gap"


def test_rows_of_a_setting():
    found = columns(3, options=["{}", '{"skip_mm": 3.0}', "{}"], threshold_hu=[np.nan, np.nan, 300.0])
    assert chosen(found, {}, None).tolist() == [True, False, False]
    assert chosen(found, {}, 300.0).tolist() == [False, False, True]
    assert chosen(found, {"skip_mm": 3.0}, None).tolist() == [False, True, False]


def test_its_options_are_a_params_file_and_its_command_says_the_rest(tmp_path):
    found = rows([[0.5, 0.9, 0.2]], threshold_hu=[np.nan, 350.0, np.nan])
    best = best_setting(found, "dice")
    (tmp_path / best.file).write_text(json.dumps(best.options))
    assert read_params("slicewise", tmp_path / best.file) == {"skip_mm": 3.0}
    assert "--method slicewise --threshold 350 --params best-slicewise.json" in best.command
    paper = best_setting(rows([[0.5, 0.9, 0.2]], contender="slicewise:paper"), "dice")
    assert paper.file == "best-slicewise-paper.json" and "--preset paper" in paper.command
