"""Writes the tables of docs/beyond_one_machine.md: a study of 10,000 scans on more and more workers, simulated.

python docs/simulate_study.py [--scans 10000] [--settings 50] [--prepare-s 1.5] [--run-s 2.0] ...

A queue of batches, in the order in which the study hands them out. A worker reads the scan of its batch through storage
that all share (one after the other, at its full speed), works, and gives the rows to the one client, which writes them
one file after the other. Times of work are lognormal. Workers live exponentially long; one that dies loses its batch,
which goes to the head of the queue, and is replaced after a while. What is not simulated: failed scans, which are
short; caches of the storage; the scheduler's own time, about a millisecond for each batch.
"""

from __future__ import annotations

import argparse
import heapq
import sys
from dataclasses import dataclass, fields, replace
from math import ceil
from pathlib import Path

import numpy as np

PAGE = Path(__file__).with_name("beyond_one_machine.md")
BEGIN, END = "<!-- tables by docs/simulate_study.py -->\n", "<!-- end of the tables -->\n"
WORKERS = (2, 16, 64, 256, 1024)


@dataclass(frozen=True)
class Study:
    """What is done, and on what.

    Parameters
    ----------
    scans, settings, per_batch : int
        Scans, settings of each, settings in a batch.
    scan_mb, storage_mb_s : float
        Size of a scan as it is stored, MB, and what the storage gives to all workers together, MB/s.
    prepare_s, run_s : float
        Mean seconds to read, segment and search a scan, and to design and measure once.
    spread : float
        Standard deviation of the logarithm of the time of a batch.
    write_s : float
        Seconds in which the client writes the file of a batch.
    workers : int
    life_h, replace_s : float
        Mean life of a worker, hours, and seconds until another one is there.
    """

    scans: int = 10_000
    settings: int = 50
    per_batch: int = 10
    scan_mb: float = 40.0
    storage_mb_s: float = 500.0
    prepare_s: float = 1.5
    run_s: float = 2.0
    spread: float = 0.5
    write_s: float = 0.012
    workers: int = 64
    life_h: float = 6.0
    replace_s: float = 120.0

    @property
    def batches(self) -> int:
        """How many batches there are."""
        return self.scans * ceil(self.settings / self.per_batch)

    @property
    def batch_s(self) -> float:
        """Seconds of work of a batch."""
        return self.prepare_s + self.settings / ceil(self.settings / self.per_batch) * self.run_s


@dataclass(frozen=True)
class Outcome:
    """What came of it.

    Parameters
    ----------
    hours : float
        From the first batch to the last row.
    core_hours, lost_hours : float
        Paid for, and of them worked in vain.
    storage_busy, client_busy : float
        Share of the time in which the storage, the client were busy.
    deaths : int
    """

    hours: float
    core_hours: float
    lost_hours: float
    storage_busy: float
    client_busy: float
    deaths: int


def simulate(study: Study, seed: int = 0) -> Outcome:
    """Go through a study, event by event."""
    rng = np.random.default_rng(seed)
    work = study.batch_s * rng.lognormal(-(study.spread**2) / 2, study.spread, study.batches)
    lives = iter(rng.exponential(study.life_h * 3600, 4 * study.workers + 2 * study.batches))
    read_s = study.scan_mb / study.storage_mb_s
    todo = list(range(study.batches))[::-1]
    free = [(0.0, i, next(lives)) for i in range(study.workers)]  # when, which worker, when it dies
    heapq.heapify(free)
    storage = busy_storage = lost = last = 0.0
    deaths, ready = 0, []
    while todo:
        now, worker, dies = heapq.heappop(free)
        batch = todo.pop()
        storage = max(storage, now) + read_s
        busy_storage += read_s
        end = storage + work[batch]
        if end > dies:
            todo.append(batch)
            lost, deaths = lost + max(dies - now, 0.0), deaths + 1
            start = max(dies, now) + study.replace_s
            heapq.heappush(free, (start, worker, start + next(lives)))
            continue
        ready.append(end)
        heapq.heappush(free, (end, worker, dies))
    for end in sorted(ready):
        last = max(last, end) + study.write_s
    hours = last / 3600
    return Outcome(
        hours, hours * study.workers, lost / 3600, busy_storage / last, study.batches * study.write_s / last, deaths
    )


def table(studies: dict[str, Study], price: float) -> str:
    """A row for each study, as Markdown."""
    head = ("Run", "Hours", "Core hours", "of them lost", "Storage busy", "Client busy", "Deaths", "Cost")
    lines = [head, tuple("---:" if name else "---" for name in head)]
    for name, study in studies.items():
        o = simulate(study)
        shares = [f"{share:.0%}" for share in (o.lost_hours / o.core_hours, o.storage_busy, o.client_busy)]
        cost = f"{o.core_hours * price:.0f}"
        lines.append((name, f"{o.hours:.1f}", f"{o.core_hours:.0f}", *shares, f"{o.deaths}", cost))
    return "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def tables(base: Study, price: float) -> str:
    """All tables of the page."""
    by_workers = {f"{n} workers": replace(base, workers=n) for n in WORKERS}
    slow = replace(base, storage_mb_s=base.storage_mb_s / 5, workers=256)
    changes = {
        f"{slow.workers} workers, as above": replace(base, workers=256),
        f"storage of {slow.storage_mb_s:g} MB/s": slow,
        "one run in a batch": replace(base, workers=256, per_batch=1),
        "all runs of a scan in a batch": replace(base, workers=256, per_batch=base.settings),
        "workers that live 30 minutes": replace(base, workers=256, life_h=0.5),
        "one setting of each scan": replace(base, workers=256, settings=1),
    }
    given = ", ".join(f"{f.name} {getattr(base, f.name):g}" for f in fields(base) if f.name != "workers")
    return f"With {given}; {price:g} for a core hour:\n\n{table(by_workers, price)}\n{table(changes, price)}"


def main() -> None:
    """Write the page where nothing was changed, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for field in fields(Study):
        parser.add_argument(f"--{field.name.replace('_', '-')}", type=type(field.default), default=field.default)
    parser.add_argument("--price", type=float, default=0.05, help="of a core hour")
    asked = vars(parser.parse_args())
    price, base = asked.pop("price"), Study(**asked)
    text = tables(base, price)
    if base == Study():
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(BEGIN)
        PAGE.write_text(f"{before}{BEGIN}\n{text}\n{END}{rest.partition(END)[2]}", encoding="utf-8")
    sys.stdout.write(text)


if __name__ == "__main__":
    main()
