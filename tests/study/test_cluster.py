"""The same study on Dask: its own small cluster, joined by address, with a method from a notebook."""

import pytest

pytest.importorskip("distributed", reason="the extra `study` is not installed")

from cranio_nb.errors import InputRefused
from cranio_nb.methods import catalogue
from cranio_nb.methods.piece import Piece
from cranio_nb.study import cluster, run
from cranio_nb.study.cases import phantom_cases
from cranio_nb.study.cluster import dask_workers
from cranio_nb.study.plan import Plan, vary
from cranio_nb.study.run import rows_of, run_study


def sheet(bone, openings, *, n=1):
    for opening in openings:
        yield Piece(opening.sheet.voxels)


@pytest.mark.filterwarnings("default")  # of the libraries below Dask
def test_an_own_method_is_run_on_dask(tmp_path, monkeypatch):
    monkeypatch.setattr(catalogue, "_added", {})
    monkeypatch.setattr(run, "version_of", lambda method: "1")
    catalogue.add_method("sheet", sheet)
    plan = Plan(tuple(phantom_cases(["burr_hole"], [0], size="tiny")), tuple(vary("sheet", {"n": [1, 2]})))
    with dask_workers(n_workers=1, processes=False) as workers:
        assert workers.dashboard.endswith("/status")
        assert run_study(plan, tmp_path, workers.executor).done == 2
    assert rows_of(plan, tmp_path)["status"].tolist() == ["done", "done"]


@pytest.mark.filterwarnings("default")
def test_an_address_where_nothing_answers_is_refused(monkeypatch):
    monkeypatch.setattr(cluster, "_WAIT_S", 0.2)
    with pytest.raises(InputRefused, match="No Dask scheduler answers"), dask_workers("tcp://127.0.0.1:1"):
        pass
    with pytest.raises(InputRefused, match="No Dask scheduler answers"), dask_workers("nonsense://x"):
        pass
