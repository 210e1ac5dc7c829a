"""The simulation behind docs/beyond_one_machine.md, where its outcome is known in closed form."""

import importlib.util
import sys
from pathlib import Path

import pytest

DOCS = Path(__file__).parents[1] / "docs"


@pytest.fixture(scope="module")
def simulation():
    spec = importlib.util.spec_from_file_location("simulate_study", DOCS / "simulate_study.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look for it there
    spec.loader.exec_module(module)
    yield module
    del sys.modules[spec.name]


def study(simulation, **given):
    """Twelve batches of 21 s, nothing in their way."""
    calm = {"scans": 12, "settings": 10, "prepare_s": 1.0, "run_s": 2.0, "spread": 0.0, "write_s": 0.0, "life_h": 1e9}
    return simulation.Study(**calm | {"storage_mb_s": 1e12, "workers": 4} | given)


def test_free_workers_share_the_work(simulation):
    found = simulation.simulate(study(simulation))
    assert found.hours * 3600 == pytest.approx(12 / 4 * 21.0) and found.deaths == found.lost_hours == 0


def test_slow_storage_sets_the_pace(simulation):
    found = simulation.simulate(study(simulation, storage_mb_s=0.4))  # 100 s for each scan
    assert found.hours * 3600 == pytest.approx(12 * 100.0 + 21.0)
    assert found.storage_busy == pytest.approx(1200 / 1221)


def test_a_slow_client_sets_the_pace(simulation):
    found = simulation.simulate(study(simulation, write_s=50.0))
    assert found.hours * 3600 == pytest.approx(21.0 + 12 * 50.0)


def test_what_dies_is_done_again(simulation):
    found = simulation.simulate(study(simulation, life_h=0.02, replace_s=10.0))
    assert found.deaths > 0 and 0 < found.lost_hours * 3600 < found.deaths * 21.0
    assert found.hours * 3600 > 63.0


def test_the_page_has_the_tables_of_these_inputs(simulation):
    page = (DOCS / "beyond_one_machine.md").read_text()
    assert page.count("| 1024 workers |") == 1
    for name in ("scans", "settings", "per_batch", "scan_mb", "storage_mb_s", "prepare_s", "run_s", "write_s"):
        assert f"{name} {getattr(simulation.Study(), name):g}" in page
