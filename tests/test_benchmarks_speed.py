"""`benchmarks/speed.py` and its page: powers in closed form, ratios by round, tables, and the commands it runs."""

import importlib.util
import json
import sys
from pathlib import Path

import numpy as np
import pytest
from benchmark_scripts import script

speed = script("speed")
speed_cases = script("speed_cases")
speed_growth = script("speed_growth")
speed_machine = script("speed_machine")
speed_process = script("speed_process")
speed_table = script("speed_table")
speed_tasks = script("speed_tasks")

DOCS = Path(__file__).parents[1] / "docs"


def run(wall_s, **inside):
    return {"wall_s": wall_s, "cpu_s": wall_s, "peak_mb": 100.0, "inside": inside}


class TestGrowth:
    @pytest.mark.parametrize("power", [0.5, 1.0, 3.0])
    def test_a_power_is_found_whatever_its_factor(self, power, speed_growth):
        n = np.array([34.0, 70, 140, 280, 560])
        assert speed_growth.exponent(n, 7 * n**power) == pytest.approx(power)
        assert speed_growth.at_the_end(n, 7 * n**power) == pytest.approx(power)

    def test_a_fixed_cost_lowers_the_power_less_at_the_end(self, speed_growth):
        n = np.array([1.0, 10, 100, 1000])
        t = 20 + n
        assert speed_growth.exponent(n, t) < speed_growth.at_the_end(n, t) < 1

    def test_a_stored_point_tells_no_path(self, speed_growth):
        point = speed_growth.Point("slices", "slicewise", 34, "/some/where", {})
        assert "where" not in json.dumps(speed_growth.record(point, [1.0], [2.0]))


class TestProcess:
    def test_a_process_is_timed_to_its_end_and_heard(self, speed_process):
        spent = speed_process.run_whole([sys.executable, "-c", "print('{}')"])
        assert spent.said == "{}\n" and 0 < spent.cpu_s and spent.wall_s > 0 and spent.peak_mb > 1

    def test_a_process_that_fails_stops_the_benchmark_with_its_words(self, speed_process):
        with pytest.raises(SystemExit, match="no such thing"):
            speed_process.run_whole([sys.executable, "-c", "raise SystemExit('no such thing')"])

    def test_ratios_are_taken_round_by_round(self, speed_process):
        # a slow round slows both: the ratio stays
        assert speed_process.ratios([2.0, 20.0, 2.0], [1.0, 10.0, 1.0]) == (2.0, 2.0, 2.0)


class TestTables:
    def test_ratio_and_range(self, speed_table):
        rows = {"reader": [run(1.0), run(3.0), run(2.0)], "SimpleITK reader": [run(1.0), run(2.0), run(2.0)]}
        text = "\n".join(speed_table.lines({"rows": rows, "series": {"shape": (10, 100, 100)}}))
        assert "| reader alone / SimpleITK reader | 1.00 | 1.00 to 1.50 | 1 |" in text
        assert "100 x 100 x 10 voxels, 0 MB; wanted is a peak of 251 MB" in text  # 3 x 0.2 + 250

    def test_balloons_and_stages_are_read_from_inside(self, speed_table):
        rows = {
            "balloons": [run(1.0, ours=0.01, active_contour=0.5, from_dense_px=1e-12)],
            "stages slicewise": [run(1.0, read=0.25, report=1.5)],
        }
        text = "\n".join(speed_table.lines({"rows": rows, "series": {"shape": (1, 1, 1)}}))
        assert "| `active_contour` / our balloons | 50 |" in text and "within 1e-12 px" in text
        assert "| read | 0.25 |" in text and "| report | 1.50 |" in text

    def test_growth_names_both_ends_and_the_power(self, speed_table):
        growth = [
            {"what": "slices", "method": "slicewise", "n": n, "wall_s": [n], "peak_mb": [100]} for n in (20, 10, 40)
        ]
        found = {"rows": {}, "series": {"shape": (1, 1, 1)}, "growth": growth}
        text = "\n".join(speed_table.lines(found))
        assert "| slicewise, 10 to 40 slices | 10.0 to 40.0 | 100 to 100 | 1.00 | 1.00 | 0.00 |" in text
        assert "earlier" not in text
        assert "of 2026-01-31, an earlier run" in "\n".join(speed_table.lines(found | {"growth_date": "2026-01-31"}))


class TestCases:
    def test_another_grid_holds_the_same_head_between_the_same_ends(self, speed_cases):
        ramp = np.arange(5, dtype=np.int16)[:, None, None] * np.full((1, 2, 3), 100, np.int16)
        head = speed_cases.Head(ramp, np.diag([3.0, 1, 1, 1]))
        finer = head.resampled(0, 9)
        assert finer.hu[:, 0, 0].tolist() == list(range(0, 401, 50)) and finer.affine[0, 0] == 1.5
        np.testing.assert_array_equal(finer.resampled(0, 5).hu, ramp)


class TestBalloons:
    def test_ours_are_those_of_full_matrices(self, speed_tasks):
        from cranio_nb.stages.deformable_model import inflate

        start, slopes = speed_tasks._curves()
        made = inflate(start[:4], slopes[:4], tol=0.0, max_iter=30)
        np.testing.assert_allclose(made.curve, speed_tasks.dense(start[:4], slopes[:4], 30), atol=1e-6)
        assert np.abs(made.curve - start[:4]).max() > 0.1


def test_every_row_is_a_command_and_every_task_is_there(speed, speed_tasks, tmp_path):
    rows = speed.rows_of(tmp_path / "ct", tmp_path / "slope", tmp_path / "patch", tmp_path / "mask", tmp_path)
    asked = {command[2] for command in rows.values() if command[1].endswith("speed_tasks.py")}
    assert asked <= set(speed_tasks.TASKS) and "skull thin-plate" in rows


def test_rows_run_in_turn_and_the_first_round_does_not_count(speed, monkeypatch, speed_process):
    order = []

    def note(command):
        order.append(command[0])
        return speed_process.Spent(1.0, 1.0, 1.0, '{"a": 2.0}')

    monkeypatch.setattr(speed, "run_whole", note)
    found = speed.in_turn({"one": ["1"], "two": ["2"]}, 3)
    assert [len(runs) for runs in found.values()] == [3, 3] and found["one"][0]["inside"] == {"a": 2.0}
    assert [sorted(order[i : i + 2]) for i in range(0, 8, 2)] == [["1", "2"]] * 4 and order[:2] != order[-2:]


def test_the_machine_is_described_without_its_name(speed_machine):
    import platform

    assert platform.node() not in json.dumps(speed_machine.machine()) or not platform.node()


def test_the_page_is_the_one_of_the_stored_figures():
    spec = importlib.util.spec_from_file_location("make_performance", DOCS / "make_performance.py")
    maker = importlib.util.module_from_spec(spec)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(sys, "path", list(sys.path))
        spec.loader.exec_module(maker)
        found = json.loads(maker.STORE.read_text())
        assert maker.PAGE.read_text(encoding="utf-8") == maker.page(found), "run python docs/make_performance.py"
        assert maker.picture(found).axes
