"""The quick numerics under three BLAS kernels, each with one and with two threads: six processes, two at a time.

python benchmarks/kernels.py

A result that moves with the kernel hinges on a rounding. Each process asks the BLAS libraries it has loaded which
kernel and how many threads they use, before and after its tests. A combination that cannot be had, runs on another
kernel, or passes fewer tests than the others ends with exit code 1.
"""

import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from itertools import product
from pathlib import Path

import pytest
from threadpoolctl import threadpool_info

ROOT = Path(__file__).resolve().parent.parent
KERNELS = ("SkylakeX", "Haswell", "Sandybridge", "Nehalem")  # of OpenBLAS on x86-64, from AVX-512 down to SSE 4.2
N_KERNELS, THREADS = 3, (1, 2)
QUICK = [
    "tests/test_curves.py",
    "tests/stages/test_deformable_model.py",
    *(f"tests/geometry/test_{name}.py" for name in ("band", "symmetric_system")),
    *(f"tests/vault/test_symmetry.py::test_it_moves_with_the_header[{hole}]" for hole in ("unilateral", "bilateral")),
    *(f"tests/vault/test_{name}.py" for name in ("midline", "nod", "rims", "slicing")),
    *(
        f"tests/methods/dnurbs/test_{name}.py"
        for name in ("sheet", "sheet_derivatives", "sheet_forces", "sheet_motion")
    ),
    "tests/methods/test_reflection.py::test_the_fitted_image_meets_the_rim",
    "tests/methods/test_design.py::test_a_turned_and_moved_header_turns_and_moves_the_mesh",
]
"""What solves, fits and iterates; no real scans, so that nothing is skipped anywhere."""
_PROBE = """
import numpy as np, scipy.linalg
from threadpoolctl import threadpool_info
for kind in (np.float32, np.float64):
    for n in (2, 3, 7, 64, 300):
        a = np.eye(n, dtype=kind) + np.arange(n * n, dtype=kind).reshape(n, n) / n**3
        for linalg in (np.linalg, scipy.linalg):
            a @ a, a @ a[0], a[0] @ a[0], linalg.solve(a, a[0]), linalg.svd(a), linalg.eigh(a + a.T)
print(threadpool_info()[0].get("architecture"))
"""


def main() -> int:
    if sys.argv[1:]:
        return run_tests(sys.argv[1], int(sys.argv[2]))
    kernels = available_kernels()
    print(f"BLAS kernels: {', '.join(kernels)}", flush=True)
    with ThreadPoolExecutor(2) as pool:
        passed = list(pool.map(lambda asked: run_alone(*asked), product(kernels, THREADS)))
    return verdict(kernels, passed)


def available_kernels() -> list[str]:
    """The first of `KERNELS` that this processor has.

    Another one is not taken, OpenBLAS takes its own instead, or it is taken and stops at its first instruction that the
    processor lacks: so each is put to work.
    """
    found = []
    for kernel in KERNELS:
        told = subprocess.run(
            [sys.executable, "-c", _PROBE], env=environment(kernel, 1), capture_output=True, text=True
        )
        if told.returncode == 0 and told.stdout.strip() == kernel and len(found) < N_KERNELS:
            found.append(kernel)
    return found


def verdict(kernels: list[str], passed: list[int]) -> int:
    """0 where three kernels ran the same tests and passed them; a `passed` of 0 stands for a failure."""
    if len(kernels) < N_KERNELS:
        print(f"{N_KERNELS} kernels are wanted: this needs x86-64, OpenBLAS, and a processor with AVX")
        return 1
    if min(passed) == 0 or len(set(passed)) > 1:
        print(f"not all combinations passed the same tests: {passed}")
        return 1
    return 0


def environment(kernel: str, threads: int) -> dict[str, str]:
    asked = {"OPENBLAS_CORETYPE": kernel, "OPENBLAS_NUM_THREADS": str(threads)}
    # plugins of pytest for notebooks and the like take longer to load than half of the tests to run
    return os.environ | asked | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}


def run_alone(kernel: str, threads: int) -> int:
    """How many tests passed in a process of their own; 0 where one failed or was skipped."""
    command = [sys.executable, __file__, kernel, str(threads)]
    done = subprocess.run(command, env=environment(kernel, threads), cwd=ROOT, capture_output=True, text=True)
    told = re.search(r"(\d+) passed in .*", done.stdout)
    ended = told is not None and done.returncode == 0
    print(f"{kernel}, {threads} threads: {told[0] if ended else done.stdout + done.stderr}", flush=True)
    return int(told[1]) if ended else 0


def run_tests(kernel: str, threads: int) -> int:
    """Run the quick tests in this process, on the kernel that was asked for and on no other."""
    import scipy.linalg  # noqa: F401  numpy and scipy each bring a BLAS of their own

    check_blas(kernel, threads)
    skipped: list[str] = []

    class Watch:
        def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
            if report.skipped:
                skipped.append(report.nodeid)

    code = pytest.main(["-q", "-p", "no:cacheprovider", *QUICK], plugins=[Watch()])
    check_blas(kernel, threads)
    return int(code) or int(bool(skipped))


def check_blas(kernel: str, threads: int) -> None:
    used = [(lib.get("architecture"), lib["num_threads"]) for lib in threadpool_info() if lib["user_api"] == "blas"]
    if len(used) < 2 or set(used) != {(kernel, threads)}:
        raise SystemExit(f"{kernel} with {threads} threads was asked for; numpy and scipy use {used}")


if __name__ == "__main__":
    raise SystemExit(main())
