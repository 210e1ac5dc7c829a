"""A plan as a JSON file -> the plan, each word of it checked before any work is done."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from ..errors import InputRefused
from ..methods.catalogue import options_of
from .cases import Case, cut_case, phantom_cases, scan_cases
from .plan import Plan, Setting, bad_plan, vary

_LARGEST = 10_000_000  # bytes of a plan
_WORDS = {"cases", "methods", "threshold_hu", "random", "seed", "folder"}


def read_plan(path: Path) -> tuple[Plan, dict[str, Any]]:
    """Read a plan.

    Parameters
    ----------
    path : Path
        JSON; see `plan`.

    Returns
    -------
    plan : Plan
    words : dict
        What the file says, with the "folder" at which its paths start: what `plan_of` takes.

    Raises
    ------
    InputRefused
        ``NotFound``, ``BadPlan`` and the refusals of `vary`.

    Examples
    --------
    >>> _ = Path("plan.json").write_text('{"cases": [{"kind": "phantom", "seeds": [1]}], "methods": {"hull": {}}}')
    >>> read_plan(Path("plan.json"))[0].n_runs
    1
    """
    try:
        with path.open("rb") as file:
            text = file.read(_LARGEST + 1)
    except OSError as error:
        raise InputRefused("NotFound", f"The plan {path.name} cannot be read.", "Check the path.") from error
    try:
        words = json.loads(text) if len(text) <= _LARGEST else None
    except (ValueError, RecursionError):
        words = None
    if not isinstance(words, dict):
        raise InputRefused("BadPlan", f"{path.name} holds no JSON object.", "See `cranio-nb study new`.")
    words = {"folder": str(path.resolve().parent)} | words
    return plan_of(words), words


def plan_of(words: Mapping[str, Any]) -> Plan:
    """The plan that a JSON object describes.

    Parameters
    ----------
    words : dict
        See `plan`; "folder" is where paths start.

    Returns
    -------
    Plan

    Raises
    ------
    InputRefused
        ``BadPlan`` and the refusals of `vary`.
    """
    if strange := sorted(set(words) - _WORDS):
        raise bad_plan(f"{strange[0]!r} means nothing", f"use {', '.join(sorted(_WORDS))} only")
    cases = cases_of(words)
    methods = _typed(words, "methods", dict, {})
    settings: list[Setting] = []
    random, seed = _typed(words, "random", int, 0), _typed(words, "seed", int, 0)
    for name, ranges in methods.items():
        if not isinstance(ranges, dict):
            raise bad_plan(f"the ranges of {name} are no object", "give {option: values, ...}, or {}")
        settings += vary(name, ranges, words.get("threshold_hu", ()), random=random, seed=seed)
    if not cases or not settings:
        raise bad_plan(f"there are no {'methods' if cases else 'cases'}", "name one at least")
    return Plan(tuple(cases), tuple(settings))


def cases_of(words: Mapping[str, Any]) -> list[Case]:
    """The cases that a JSON object describes.

    Parameters
    ----------
    words : dict
        As for `plan_of`.

    Returns
    -------
    list of Case

    Raises
    ------
    InputRefused
        ``BadPlan``.
    """
    folder = _typed(words, "folder", str, "")
    return [case for group in _typed(words, "cases", list, []) for case in _group(group, folder)]


def example(methods: tuple[str, ...]) -> dict[str, Any]:
    """A plan to begin with: a few small phantoms, and the ranges worth a look of every number of some methods.

    Parameters
    ----------
    methods : tuple of str
        Names of the catalogue.

    Returns
    -------
    dict
        For a JSON file.
    """

    def ranges(name: str) -> dict[str, Any]:
        known = options_of(name)
        numbers = {k: o for k, o in known.items() if o.kind in ("number", "whole number") and o.limits}
        return {k: {"low": o.span[0], "high": o.span[1]} for k, o in numbers.items()}

    cases = [{"kind": "phantom", "size": "tiny", "defects": ["unilateral", "burr_hole"], "seeds": [0, 1, 2]}]
    return {
        "cases": cases,
        "methods": {name: ranges(name) for name in methods},
        "threshold_hu": {"low": 300, "high": 500},
        "random": 20,
        "seed": 0,
    }


def _typed(words: Mapping[str, Any], name: str, kind: type, default: Any) -> Any:
    """A value of the wanted type."""
    found = words.get(name, default)
    if type(found) is not kind:
        called = {list: "list", dict: "object", int: "whole number", str: "text", bool: "truth value"}[kind]
        raise bad_plan(f"{name} is no {called}", "give one")
    return found


def _list(group: Mapping[str, Any], name: str, kind: type, default: Any = None) -> list[Any]:
    """A list of values of one type."""
    found = group.get(name, default)
    if not isinstance(found, list) or not found or any(type(v) is not kind for v in found):
        called = {str: "texts", int: "whole numbers"}[kind]
        raise bad_plan(f"{name} of a group of cases is no list of {called}", f"give {name} as such a list")
    return found


def _scans(group: Mapping[str, Any], folder: str) -> list[Case]:
    truth = _typed(group, "truth", str, "") or None
    mask = _typed(group, "mask", bool, False) or None
    return scan_cases(_paths(group, folder), truth=truth, mask=mask, folder=folder)


def _phantoms(group: Mapping[str, Any], folder: str) -> list[Case]:
    from data_synth import HEADS, SIZES

    size, head = group.get("size", "class"), group.get("head", "simple")
    if size not in SIZES or head not in HEADS:
        raise bad_plan("size or head of phantoms is unknown", f"choose of {', '.join(SIZES)} and of {', '.join(HEADS)}")
    return phantom_cases(_defects(group, ["unilateral"]), _list(group, "seeds", int), size=size, head=head)


def _cuts(group: Mapping[str, Any], folder: str) -> list[Case]:
    mask = _typed(group, "mask", bool, False) or None
    sizes = _list(group, "diameters_mm", int) if "diameters_mm" in group else [None]
    return [
        cut_case(path, defect, seed, diameter_mm=size, mask=mask, folder=folder)
        for path in _paths(group, folder)
        for seed in _list(group, "seeds", int, [0])
        for defect in _defects(group)
        for size in sizes
    ]


_GROUPS: dict[str, tuple[Callable[[Mapping[str, Any], str], list[Case]], set[str]]] = {
    "scan": (_scans, {"paths", "truth", "mask"}),
    "phantom": (_phantoms, {"defects", "seeds", "size", "head"}),
    "cut": (_cuts, {"paths", "defects", "seeds", "diameters_mm", "mask"}),
}


def _group(group: Any, folder: str) -> list[Case]:
    """The cases of one line of a plan."""
    kind = group.get("kind") if isinstance(group, dict) else None
    if not isinstance(kind, str) or kind not in _GROUPS:
        raise bad_plan("a group of cases has no known kind", f"choose of {', '.join(_GROUPS)}")
    make, words = _GROUPS[kind]
    if strange := sorted(set(group) - words - {"kind"}):
        raise bad_plan(f"{strange[0]!r} means nothing for a {kind}", f"use {', '.join(sorted(words))} only")
    return make(group, folder)


def _paths(group: Mapping[str, Any], folder: str) -> list[str]:
    """The paths of a group, patterns filled in; relative to the folder where they lie below it."""
    found: list[str] = []
    for pattern in _list(group, "paths", str):
        root = Path(pattern).anchor or folder
        rest = Path(pattern).relative_to(root) if Path(pattern).anchor else Path(pattern)
        paths = sorted(Path(root).glob(str(rest)))
        if not paths:
            raise bad_plan(
                f"nothing lies at {Path(pattern).name!r}", "check the paths, which start at the plan's folder"
            )
        found += [p.relative_to(folder).as_posix() if p.is_relative_to(folder) else str(p) for p in paths]
    return found


def _defects(group: Mapping[str, Any], default: list[str] | None = None) -> list[str]:
    from data_synth import DEFECTS

    found = _list(group, "defects", str, default)
    if strange := [name for name in found if name not in DEFECTS]:
        raise bad_plan(f"there is no defect {strange[0]!r}", f"choose of {', '.join(DEFECTS)}")
    return found
