"""Each run is done exactly once, whatever is lost on the way."""

from concurrent.futures import Future, ThreadPoolExecutor

import pytest
from executors import Inline, KilledWorker
from studies import plan, rows_for, version

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.errors import CranioError
from cranio_nb.study import run
from cranio_nb.study.run import Tally, rows_of, run_study
from cranio_nb.study.store import Store


@pytest.fixture(autouse=True)
def no_work(monkeypatch):
    monkeypatch.setattr(run, "version_of", version)
    monkeypatch.setattr(run, "do_batch", rows_for)


def n_rows(folder):
    """Rows on disk, twice where they are there twice."""
    return len(Store(folder)._table()["key"])


def test_what_is_done_is_not_done_again(tmp_path):
    first, second = Inline(), Inline()
    assert run_study(plan(), tmp_path, first).done == 6 and len(first.given) == 3
    again = run_study(plan(), tmp_path, second)
    assert (again.before, again.done, second.given) == (6, 0, [])
    assert rows_of(plan(), tmp_path)["dice"].tolist() == [0.5] * 6


def test_a_wider_plan_adds_what_it_lacks(tmp_path):
    run_study(plan(2, (0.0,)), tmp_path, Inline())
    tally = run_study(plan(3, (0.0, 3.0)), tmp_path, Inline())
    assert (tally.before, tally.done) == (2, 4) and n_rows(tmp_path) == 6


@pytest.mark.parametrize("after", [0, 1, 2])
def test_a_study_that_ends_at_any_batch_goes_on_from_there(after, tmp_path):
    def stop(tally):
        if tally.done == 2 * after:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_study(plan(), tmp_path, Inline(), progress=stop)
    assert n_rows(tmp_path) == 2 * after
    assert run_study(plan(), tmp_path, Inline()).done == 6 - 2 * after
    assert n_rows(tmp_path) == 6


def test_two_threads_do_each_run_once(tmp_path):
    with ThreadPoolExecutor(2) as pool:
        assert run_study(plan(20), tmp_path, pool).done == n_rows(tmp_path) == 40


def test_one_run_that_kills_its_workers_is_a_row_and_the_others_are_done(tmp_path, monkeypatch):
    bad = list(plan().keys(version))[3]

    def deadly(batch, *_):
        if bad in batch.keys:
            raise KilledWorker
        return rows_for(batch)

    monkeypatch.setattr(run, "do_batch", deadly)
    tally = run_study(plan(), tmp_path, Inline())
    found = rows_of(plan(), tmp_path)
    assert (tally.done, tally.failed) == (6, 1)
    assert found["status"].tolist() == ["done"] * 3 + ["broken"] + ["done"] * 2 and found["code"][3] == "WorkerEnded"


def test_workers_that_cannot_work_end_the_study_and_are_no_rows(tmp_path, monkeypatch):
    calls = []

    def missing(batch, *_):
        calls.append(batch)
        if len(calls) > 1:
            raise ModuleNotFoundError("cranio_nb")
        return rows_for(batch)

    monkeypatch.setattr(run, "do_batch", missing)
    with pytest.raises(CranioError, match=r"ModuleNotFoundError.*goes on"):
        run_study(plan(), tmp_path, Inline())
    assert n_rows(tmp_path) == 2


def test_work_that_is_taken_back_ends_the_study(tmp_path):
    class Gone(Inline):
        def submit(self, fn, /, *args, **kwargs):
            future = Future()
            future.cancel()
            future.set_running_or_notify_cancel()
            return future

    with pytest.raises(CranioError, match="lost"):
        run_study(plan(), tmp_path, Gone())


def test_an_executor_that_takes_nothing_ends_the_study(tmp_path):
    pool = ThreadPoolExecutor(1)
    pool.shutdown()
    with pytest.raises(CranioError, match="RuntimeError"):
        run_study(plan(), tmp_path, pool)


def test_parts_make_the_whole(tmp_path):
    done = [run_study(plan(), tmp_path, Inline(), part=(i, 2)).done for i in (1, 2)]
    assert done == [4, 2] and run_study(plan(), tmp_path, Inline()).before == 6


def test_time_left_follows_the_pace():
    assert Tally(100, 20, 20, 0, 30.0).seconds_left == 90.0
    assert Tally(10, 10).seconds_left != Tally(10, 10).seconds_left  # nan: nothing was done yet
