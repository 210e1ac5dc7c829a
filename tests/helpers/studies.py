"""Plans and rows of studies in which nothing is designed."""

from __future__ import annotations

import json
from itertools import product
from typing import Any

import numpy as np

from cranio_nb.pipeline.compare import MEASURES
from cranio_nb.pipeline.trial import Contender
from cranio_nb.study.cases import Case, phantom_cases
from cranio_nb.study.plan import Plan, Setting


def version(method: str) -> str:
    """In place of a digest of the source."""
    return "1"


def plan(n_cases: int = 3, skips: tuple[float, ...] = (0.0, 3.0)) -> Plan:
    """Tiny phantoms, and a method with some values of one option."""
    settings = [Setting(Contender("slicewise", "default", {"skip_mm": skip})) for skip in skips]
    return Plan(tuple(phantom_cases(["burr_hole"], range(n_cases), size="tiny")), tuple(settings))


def rows_for(batch: Any, *_: Any) -> list[dict[str, Any]]:
    """In place of the work on a batch."""
    return [
        {"key": key, "case": batch.case.name, "contender": one.name, "method": one.method, "options": "{}"}
        | {"status": "done", "dice": 0.5}
        for key, one in zip(batch.keys, batch.contenders, strict=True)
    ]


def columns(n: int, **given: Any) -> dict[str, np.ndarray]:
    """Rows as columns: done, all measures nan, but for what is given."""
    text = dict.fromkeys(("key", "version", "kind", "defect", "place", "warnings", "code", "message"), "")
    text |= {"case": "a", "contender": "slicewise", "method": "slicewise", "options": "{}", "status": "done"}
    numbers = ("seed", "asked_mm", "threshold_hu", "length_mm", "n_openings", *MEASURES, "written_s")
    found = {name: np.full(n, value, object) for name, value in text.items()}
    found |= {name: np.full(n, np.nan) for name in numbers}
    return found | {name: np.full(n, value, found[name].dtype) for name, value in given.items()}


def unreadable() -> Case:
    """A case whose file is not there."""
    return Case("gone", "scan", {"path": "gone.nrrd", "truth": None, "mask": None})


def without_defaults(**options: float) -> str:
    """Options as a row has them."""
    return json.dumps({k: v for k, v in options.items() if v != {"coupling_mm": 4.0, "skip_mm": 1.5}[k]})


def two_options() -> dict[str, np.ndarray]:
    """Two options on three cases: the measure falls with one, and both interact. A run on another case failed."""
    places = [*product(range(3), (0.0, 1.5, 3.0), (2.0, 4.0)), (3, 0.0, 2.0)]
    found = columns(
        len(places),
        case=[f"<case{c}>" for c, _, _ in places],
        defect="vertex",
        length_mm=[30.0 + 30 * c for c, _, _ in places],
        options=[without_defaults(coupling_mm=b, skip_mm=a) for _, a, b in places],
        dice=[0.9 - 0.01 * c - 0.05 * a + 0.02 * a * b for c, a, b in places],
        seconds=1.0,
    )
    found["status"][-1], found["code"][-1], found["message"][-1] = "broken", "Oops", "It went wrong."
    return found
