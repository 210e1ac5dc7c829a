"""The choice of BLAS kernels and the verdict over them; the tests they run are tests of their own."""

import importlib
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

ROOT = Path(__file__).parent.parent


@pytest.fixture
def kernels(monkeypatch):
    monkeypatch.syspath_prepend(ROOT / "benchmarks")
    yield importlib.import_module("kernels")
    sys.modules.pop("kernels", None)


@pytest.mark.parametrize(
    ("names", "passed", "code"),
    [
        (["A", "B", "C"], [9] * 6, 0),
        (["A", "B", "C"], [9, 9, 9, 9, 9, 0], 1),  # one failed or skipped
        (["A", "B", "C"], [9, 9, 9, 9, 9, 8], 1),  # one ran fewer tests
        (["A", "B"], [9] * 4, 1),  # a kernel is missing
    ],
)
def test_only_six_equal_runs_are_good(kernels, names, passed, code):
    assert kernels.verdict(names, passed) == code


def test_another_kernel_or_number_of_threads_than_asked_for_ends_the_run(kernels, monkeypatch):
    two = [{"user_api": "blas", "architecture": "Haswell", "num_threads": 2}] * 2
    monkeypatch.setattr(kernels, "threadpool_info", lambda: two)
    kernels.check_blas("Haswell", 2)
    for kernel, threads in (("Nehalem", 2), ("Haswell", 1)):
        with pytest.raises(SystemExit, match="asked for"):
            kernels.check_blas(kernel, threads)


def test_the_environment_asks_openblas(kernels):
    asked = kernels.environment("Nehalem", 1)
    assert (asked["OPENBLAS_CORETYPE"], asked["OPENBLAS_NUM_THREADS"]) == ("Nehalem", "1")
    assert asked.items() >= {k: v for k, v in os.environ.items() if not k.startswith("OPENBLAS_")}.items()


def test_every_quick_test_is_there(kernels):
    for test in kernels.QUICK:
        path, _, name = test.partition("::")
        assert (ROOT / path).is_file() and f"def {name.partition('[')[0]}" in (ROOT / path).read_text()


def test_a_kernel_that_stops_at_its_work_is_not_taken(kernels, monkeypatch):
    """OpenBLAS takes a kernel by name on a processor that lacks its instructions, and then dies of it."""

    def run(command, env, **how):
        kernel = env["OPENBLAS_CORETYPE"]
        return SimpleNamespace(returncode=-4 if kernel == "SkylakeX" else 0, stdout=f"{kernel}\n")

    monkeypatch.setattr(kernels.subprocess, "run", run)
    assert kernels.available_kernels() == ["Haswell", "Sandybridge", "Nehalem"]
