"""What a study withstands, and what it costs: kills of worker, scheduler and client; memory; one worker against two.

    python benchmarks/studies.py kill [worker|scheduler|client ...]
    python benchmarks/studies.py memory [--runs 500]
    python benchmarks/studies.py workers [--runs 200] [--rounds 3]

kill: a scheduler and two workers are started as processes of their own, and a study that joins them by address. In the
middle of it one process gets SIGKILL. Where the study cannot go on it is started again, and then every run must be
there once, with the measures of a study that nobody disturbed. memory: what one worker holds after each batch, by
quarters of the study. workers: time of the same study with one worker and with two, in turn; a quiet machine is wanted.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq

from cranio_nb.study.cluster import dask_workers
from cranio_nb.study.plan_file import plan_of
from cranio_nb.study.run import rows_of, run_study

SAME = ("key", "case", "contender", "options", "threshold_hu", "status", "code", "dice", "hd95", "assd", "volume")
"""Columns that do not depend on when and where a run was done."""
_PATIENCE_S = 600.0


def plan_words(n_runs: int) -> dict[str, Any]:
    """A plan of about so many short designs: 10 settings of one method on tiny phantoms."""
    ranges = {"n_snaxels": [21, 31, 41], "skip_mm": [1.0, 1.5, 2.0]}
    cases = {"kind": "phantom", "size": "tiny", "defects": ["burr_hole"], "seeds": list(range(max(1, n_runs // 10)))}
    return {"cases": [cases], "methods": {"slicewise:paper": ranges}}


# --- kills -----------------------------------------------------------------------------------------------------------


class Cluster:
    """A scheduler and two workers, each a process of its own with its own group."""

    def __init__(self, folder: Path) -> None:
        self.file, self.processes = folder / f"scheduler-{time.monotonic_ns()}.json", {}
        self._start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        while not self.file.exists() or not self.file.read_text():
            time.sleep(0.1)
        self.address = json.loads(self.file.read_text())["address"]
        for name in ("worker", "worker 2"):
            self._start(name, "--nthreads", "1", "--no-dashboard", "--no-nanny", "--local-directory", str(folder))

    def _start(self, name: str, *options: str) -> None:
        kind = name.split()[0]
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", "--scheduler-file", str(self.file), *options]
        self.processes[name] = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)

    def stop(self) -> None:
        """End what is still there."""
        for process in self.processes.values():
            process.kill()
            process.wait()


@contextmanager
def cluster(folder: Path) -> Iterator[Cluster]:
    made = Cluster(folder)
    try:
        yield made
    finally:
        made.stop()


def client(plan: Path, out: Path, address: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-m", "cranio_nb", "study", "run", str(plan), "--out", str(out), "--scheduler", address]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)


def n_rows(out: Path) -> int:
    """Rows on disk, counted twice where they are there twice."""
    return sum(pq.read_metadata(path).num_rows for path in (out / "rows").glob("[!.]*.parquet"))


def kill_in_the_middle(target: str, plan: Path, out: Path, folder: Path, total: int) -> list[str]:
    """Kill one process when a third is done, go on until all is done, and say what happened."""
    said = []
    with ExitStack() as stack:
        there = stack.enter_context(cluster(folder))
        running = client(plan, out, there.address)
        while n_rows(out) < total // 3:
            if running.poll() is not None:
                raise SystemExit(f"The study ended before it could be disturbed: {running.communicate()[0]}")
            time.sleep(0.05)
        victim = running if target == "client" else there.processes[target]
        os.kill(victim.pid, signal.SIGKILL)
        said.append(f"{target} killed at {n_rows(out)} of {total} rows")
        words = running.communicate(timeout=_PATIENCE_S)[0].strip().splitlines()
        said.append(f"the study ended with {running.returncode}, {n_rows(out)} rows: {words[-1] if words else '-'}")
        if target == "scheduler":
            there.stop()
            there = stack.enter_context(cluster(folder))
        if running.returncode:
            words = client(plan, out, there.address).communicate(timeout=_PATIENCE_S)[0].strip().splitlines()
            said.append(f"started again: {words[-2]}")
    return said


def compare(words: dict[str, Any], out: Path, reference: Path) -> str:
    """Every run once, with the same measures as in a study that nobody disturbed."""
    plan = plan_of(words)
    own, other = rows_of(plan, out), rows_of(plan, reference)
    if n_rows(out) != plan.n_runs or len(own["key"]) != plan.n_runs:
        raise SystemExit(f"{n_rows(out)} rows of {len(own['key'])} runs are there, {plan.n_runs} are wanted.")
    for name in SAME:
        np.testing.assert_array_equal(own[name], other[name], err_msg=name)
    return f"{plan.n_runs} runs, each once, with the same measures as an undisturbed study"


def kills(targets: Sequence[str], n_runs: int) -> None:
    with tempfile.TemporaryDirectory() as name:
        folder, words = Path(name), plan_words(n_runs)
        (folder / "plan.json").write_text(json.dumps(words))
        with dask_workers(n_workers=2) as workers:
            run_study(plan_of(words), folder / "undisturbed", workers.executor)
        for target in targets:
            out = folder / target
            for line in kill_in_the_middle(target, folder / "plan.json", out, folder, plan_of(words).n_runs):
                print(f"   {line}", flush=True)
            print(f"   {compare(words, out, folder / 'undisturbed')}\n", flush=True)


# --- memory and workers ----------------------------------------------------------------------------------------------


def resident_mb() -> float:
    """What this process holds now, MB."""
    import psutil

    return psutil.Process().memory_info().rss / 1e6


def memory(n_runs: int) -> None:
    """One worker, looked at after each batch."""
    held: list[float] = []
    with tempfile.TemporaryDirectory() as name, dask_workers(n_workers=1) as workers:
        plan = plan_of(plan_words(n_runs))
        run_study(plan, name, workers.executor, progress=lambda _: held.append(_resident(workers)))
    quarters = [part.mean() for part in np.array_split(np.array(held[1:]), 4)]
    print(f"{plan.n_runs} runs, MB: at the start {held[0]:.0f}, most {max(held):.0f}, at the end {held[-1]:.0f}")
    print(f"mean of each quarter: {', '.join(f'{mean:.1f}' for mean in quarters)}")


def _resident(workers: Any) -> float:
    return float(workers.executor.submit(resident_mb).result())


def workers(n_runs: int, rounds: int) -> None:
    """Seconds of the same study with one worker and with two, in turn."""
    plan, found = plan_of(plan_words(n_runs)), {1: [], 2: []}
    for _ in range(rounds):
        for n in found:
            with tempfile.TemporaryDirectory() as name, dask_workers(n_workers=n) as there:
                began = time.perf_counter()
                run_study(plan, name, there.executor)
                found[n].append(time.perf_counter() - began)
    one, two = (float(np.median(seconds)) for seconds in found.values())
    load = os.getloadavg()[0]
    print(f"{plan.n_runs} runs, medians of {rounds}: one worker {one:.1f} s, two {two:.1f} s, ratio {one / two:.2f}")
    print(f"each: {found}; load of the machine {load:.1f} on {os.cpu_count()} processors")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=("kill", "memory", "workers"))
    parser.add_argument("targets", nargs="*", default=[], help="of kill: worker, scheduler, client")
    parser.add_argument("--runs", type=int)
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    if asked.what == "kill":
        kills(asked.targets or ["worker", "scheduler", "client"], asked.runs or 200)
    elif asked.what == "memory":
        memory(asked.runs or 500)
    else:
        workers(asked.runs or 200, asked.rounds)


if __name__ == "__main__":
    main()
