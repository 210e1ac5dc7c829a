"""What a command takes as a whole process, and what several runs of it say together."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from statistics import median
from tempfile import TemporaryFile
from typing import Any

_TO_MB = 1024 / 1e6  # Linux counts resident memory in units of 1024 bytes


@dataclass(frozen=True)
class Spent:
    """What one process took.

    Parameters
    ----------
    wall_s, cpu_s : float
        From start to end by the clock; at work on any core, its own children with it.
    peak_mb : float
        Largest resident memory, MB of 1e6 bytes, of the process or of one of its children.
    said : str
        What it printed; where it failed, its complaint.
    code : int
        It ended with.
    """

    wall_s: float
    cpu_s: float
    peak_mb: float
    said: str = ""
    code: int = 0


def run_whole(command: Sequence[str]) -> Spent:
    """Run a command to its end; it stops the benchmark where it fails.

    A small process starts it: the peak that the system counts begins with what the one that starts it holds.
    """
    starter = subprocess.run([sys.executable, __file__, *command], capture_output=True, text=True, check=True)
    spent = Spent(**json.loads(starter.stdout))
    if spent.code:
        raise SystemExit(f"{' '.join(command)} ended with {spent.code}:\n{spent.said[-2000:]}")
    return spent


def watch(command: Sequence[str]) -> Spent:
    """Start a command, wait for its end and ask the system what it took."""
    with TemporaryFile("w+") as said, TemporaryFile("w+") as complaint:
        began = time.perf_counter()
        process = subprocess.Popen(command, stdout=said, stderr=complaint)
        _, status, used = os.wait4(process.pid, 0)
        wall_s = time.perf_counter() - began
        process.returncode = os.waitstatus_to_exitcode(status)
        heard = complaint if process.returncode else said
        heard.seek(0)
        cpu_s, peak_mb = used.ru_utime + used.ru_stime, used.ru_maxrss * _TO_MB
        return Spent(wall_s, cpu_s, peak_mb, heard.read(), process.returncode)


def spread(values: Sequence[float]) -> tuple[float, float, float]:
    """Median, least and largest of some runs.

    >>> spread([3.0, 1.0, 2.0])
    (2.0, 1.0, 3.0)
    """
    return median(values), min(values), max(values)


def ratios(these: Sequence[float], those: Sequence[float]) -> tuple[float, float, float]:
    """How many times as much, round by round, so that what slows the machine for a while slows both.

    >>> ratios([2.0, 4.0, 9.0], [1.0, 1.0, 3.0])
    (3.0, 2.0, 4.0)
    """
    return spread([a / b for a, b in zip(these, those, strict=True)])


def column(runs: Sequence[Mapping[str, Any]], name: str) -> list[float]:
    """One figure of all runs of a row; a name with a dot looks into what the process itself measured."""
    outer, _, inner = name.partition(".")
    return [float(run[outer][inner] if inner else run[outer]) for run in runs]


if __name__ == "__main__":
    print(json.dumps(asdict(watch(sys.argv[1:]))))
