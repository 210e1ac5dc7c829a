"""How time and memory grow with slices, pixels, width of the gap and snaxels, and with which power."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np
from speed_cases import Head, head

SLICES = (34, 70, 140, 280, 560)
IN_PLANE = (256, 512, 1024)
WIDTHS_MM = (30, 50, 70, 90, 110)
SNAXELS = (21, 41, 81, 141, 201)
METHODS = ("slicewise", "thin-plate")


@dataclass(frozen=True)
class Point:
    """One place on a growth curve: what grows, the method, how much of it, and the design that is run.

    Parameters
    ----------
    what, method : str
    n : float
    ct : str
        Folder of the series.
    params : dict
        Options of the method.
    """

    what: str
    method: str
    n: float
    ct: str
    params: dict[str, int]

    def arguments(self, folder: Path) -> list[str]:
        """Of `cranio-nb design`, without where it writes to."""
        if not self.params:
            return [self.ct, "--method", self.method]
        file = folder / f"params-{self.n:g}.json"
        file.write_text(json.dumps(self.params))
        return [self.ct, "--method", self.method, "--params", str(file)]


def points(folder: Path) -> Iterator[Point]:
    """All points; each series is written when it is asked for, and one after the other."""
    whole = head()[0]
    opened = whole.cut()
    for n in SLICES:
        ct = _write(folder, f"slices-{n}", opened, 0, n)
        yield from (Point("slices", method, n, ct, {}) for method in METHODS)
    for n in IN_PLANE:
        ct = str(opened.resampled(1, n).resampled(2, n).write(folder / f"in-plane-{n}"))
        yield from (Point("in-plane", method, n, ct, {}) for method in METHODS)
    for n in WIDTHS_MM:
        ct = str(whole.cut(n).write(folder / f"width-{n}"))
        yield from (Point("width", method, n, ct, {}) for method in METHODS)
    ct = str(opened.write(folder / "ct"))
    yield from (Point("snaxels", "slicewise", n, ct, {"n_snaxels": n}) for n in SNAXELS)


def _write(folder: Path, name: str, whole: Head, axis: int, n: int) -> str:
    return str(whole.resampled(axis, n).write(folder / name))


def record(point: Point, wall_s: Sequence[float], peak_mb: Sequence[float]) -> dict[str, object]:
    """A point and its runs, without paths."""
    kept = {name: value for name, value in asdict(point).items() if name in ("what", "method", "n")}
    return kept | {"wall_s": list(wall_s), "peak_mb": list(peak_mb)}


def exponent(n: Sequence[float], t: Sequence[float]) -> float:
    """Slope of log t over log n by least squares: t grows as n to this power.

    >>> round(exponent([1, 2, 4, 8], [3, 12, 48, 192]), 6)
    2.0
    """
    return float(np.polyfit(np.log(n), np.log(t), 1)[0])


def at_the_end(n: Sequence[float], t: Sequence[float]) -> float:
    """The power between the two largest n, where what does not grow weighs least.

    >>> round(at_the_end([1, 10, 20], [5, 2, 4]), 6)
    1.0
    """
    return exponent(n[-2:], t[-2:])
