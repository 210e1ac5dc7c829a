"""What a study is to do: cases, and the settings that each of them is designed with.

A plan is a JSON file::

    {
      "cases": [
        {"kind": "phantom", "defects": ["unilateral", "burr_hole"], "seeds": [0, 1, 2], "size": "class"},
        {"kind": "scan", "paths": ["scans/*/defective.nrrd"], "truth": "implant.nrrd"},
        {"kind": "cut", "paths": ["whole/*.nrrd"], "defects": ["frontal"], "seeds": [0], "diameters_mm": [40, 80]}
      ],
      "methods": {"slicewise": {"skip_mm": [0, 1.5, 3], "tension": {"n": 4}}, "thin-plate": {}, "hull:paper": {}},
      "threshold_hu": [300, 400, 500]
    }

Paths start at the folder of the file. A parameter has a list of values, or ``{"low": ..., "high": ..., "n": ...}``;
what is left out follows from the declaration of the option: the part of its range that is worth a look, 5 values. Every
combination is run, or, with ``"random": 50``, so many that are spread over all ranges at once (Latin hypercube,
``"seed"``). The defaults of each method are always among them: they are what others are compared with.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby, product
from math import prod
from typing import Any

import numpy as np
from scipy.stats import qmc

from ..errors import InputRefused
from ..methods.catalogue import check_preset, options_of
from ..options import THRESHOLD, Option
from ..pipeline.trial import Contender
from .cases import Case
from .work import Batch

THRESHOLD_HU = "threshold_hu"
"""The bone threshold among the parameters of a study."""
_GRID = 5  # values of a parameter whose number is not given
_MOST = 1_000_000  # places of a grid
_PER_BATCH = 10  # runs that share one reading of a case, and one file of rows


@dataclass(frozen=True)
class Setting:
    """A method with its options, and the threshold that it gets its bone by.

    Parameters
    ----------
    contender : Contender
        Its options are only those that differ from the preset.
    threshold_hu : float or None
        Lowest HU of bone; None for the default, and for masks.
    """

    contender: Contender
    threshold_hu: float | None = None


@dataclass(frozen=True)
class Plan:
    """Every case with every setting.

    Parameters
    ----------
    cases : tuple of Case
    settings : tuple of Setting
    """

    cases: tuple[Case, ...]
    settings: tuple[Setting, ...] = field(default_factory=tuple)

    def __post_init__(self) -> None:
        names = [case.name for case in self.cases]
        if twice := sorted({name for name in names if names.count(name) > 1}) if len(set(names)) < len(names) else []:
            raise bad_plan(f"two cases are named {twice[0]!r}", "name each case once")

    @property
    def n_runs(self) -> int:
        """How many designs it asks for.

        Returns
        -------
        int
        """
        return len(self.cases) * len(self.settings)

    def part(self, number: int, of: int) -> Plan:
        """A share of the cases, all with the same settings.

        Parameters
        ----------
        number, of : int
            Which of how many shares, from 1 on.

        Returns
        -------
        Plan
        """
        return Plan(self.cases[number - 1 :: of], self.settings)

    def keys(self, version: Callable[[str], str]) -> dict[str, tuple[Case, Setting]]:
        """Every run by its key, in the order of the cases.

        Parameters
        ----------
        version : callable
            Name of a method -> what tells its source from an older one; see `version_of`.

        Returns
        -------
        dict of str to tuple
        """
        return {run_key(c, s, version(s.contender.method)): (c, s) for c in self.cases for s in self.settings}

    def batches(self, done: Collection[str], version: Callable[[str], str]) -> Iterator[Batch]:
        """What is left to do, cut into pieces that share one reading of a case.

        Parameters
        ----------
        done : collection of str
            Keys of the runs that are not wanted again.
        version : callable
            As for `keys`.

        Returns
        -------
        iterator of Batch
            In the order of the cases, so that a study stopped early has covered what its cases cover.
        """
        left = [(key, *run) for key, run in self.keys(version).items() if key not in done]
        left.sort(key=_by_threshold(self.cases))
        for (_, threshold), runs in groupby(left, key=lambda run: (run[1].name, run[2].threshold_hu)):
            own = list(runs)
            for start in range(0, len(own), _PER_BATCH):
                keys, cases, settings = zip(*own[start : start + _PER_BATCH], strict=True)
                asked = tuple(setting.contender for setting in settings)
                yield Batch(cases[0], threshold, asked, keys, tuple(version(one.method) for one in asked))


def run_key(case: Case, setting: Setting, version: str) -> str:
    """What a run is known by: a digest of case, method, parameters and version.

    Parameters
    ----------
    case : Case
    setting : Setting
    version : str

    Returns
    -------
    str
        24 hexadecimal digits.
    """
    asked = setting.contender
    said = [case.kind, case.source, asked.method, asked.preset, asked.options, setting.threshold_hu, version]
    return hashlib.sha256(json.dumps(said, sort_keys=True).encode()).hexdigest()[:24]


def vary(
    name: str,
    ranges: Mapping[str, Any] | None = None,
    thresholds_hu: Any = (),
    *,
    random: int = 0,
    seed: int = 0,
) -> list[Setting]:
    """Settings of a method: its defaults, then a grid over its parameters, or random places in their ranges.

    Parameters
    ----------
    name : str
        ``method`` or ``method:preset``.
    ranges : dict, optional
        Option -> list of values, or ``{"low": ..., "high": ..., "n": ...}``; what is left out follows from the
        declaration of the option.
    thresholds_hu : list or dict
        The same for the bone threshold.
    random : int
        Number of places of a Latin hypercube; 0 for the grid.
    seed : int
        Of these places.

    Returns
    -------
    list of Setting
        Each once.

    Raises
    ------
    InputRefused
        ``UnknownMethod``, ``UnknownPreset``, ``BadOption``, ``BadPlan``.

    Examples
    --------
    >>> [setting.contender.options for setting in vary("slicewise", {"skip_mm": [0, 1.5, 3]})]
    [{}, {'skip_mm': 0.0}, {'skip_mm': 3.0}]
    >>> [setting.threshold_hu for setting in vary("hull", thresholds_hu=[300, 500])]
    [None, 300.0, 500.0]
    """
    method, _, preset = name.partition(":")
    base = Contender(method, preset or "default")
    check_preset(base.method, base.preset)
    ranges = dict(ranges or {}) | ({THRESHOLD_HU: thresholds_hu} if thresholds_hu else {})
    known = options_of(base.method) | {THRESHOLD_HU: THRESHOLD}
    if strange := sorted(set(ranges) - set(known)):
        raise bad_plan(f"{base.method} has no option {strange[0]!r}", f"it has {', '.join(known)}")
    sought = {option: (known[option], wanted) for option, wanted in ranges.items()}
    places = _drawn(sought, random, seed) if random else _crossed(sought)
    found = [_setting(base, place, known) for place in ({}, *places)]
    return list({json.dumps([s.contender.options, s.threshold_hu], sort_keys=True): s for s in found}.values())


def bad_plan(found: str, wanted: str) -> InputRefused:
    """The refusal of a plan.

    Parameters
    ----------
    found, wanted : str
        Parts of sentences.

    Returns
    -------
    InputRefused
        ``BadPlan``.
    """
    return InputRefused("BadPlan", f"In the plan, {found}.", f"{wanted[0].upper()}{wanted[1:]}.")


def _by_threshold(cases: Sequence[Case]) -> Callable[[Any], tuple[int, float]]:
    """Sort runs by case, then by threshold; the runs of one threshold share one segmentation."""
    place = {case.name: i for i, case in enumerate(cases)}
    return lambda run: (place[run[1].name], run[2].threshold_hu or 0.0)


def _crossed(sought: Mapping[str, tuple[Option, Any]]) -> Iterator[dict[str, Any]]:
    """Every combination of the values of all parameters."""
    values = [_values(name, option, wanted) for name, (option, wanted) in sought.items()]
    if (n := prod(map(len, values))) > _MOST:
        raise bad_plan(f"the grid has {n} places", 'name fewer values, or give "random" as the number of places')
    return (dict(zip(sought, place, strict=True)) for place in product(*values))


def _drawn(sought: Mapping[str, tuple[Option, Any]], n: int, seed: int) -> Iterator[dict[str, Any]]:
    """Random places: in each parameter alone, the n values lie evenly over its range."""
    shares = qmc.LatinHypercube(len(sought), rng=seed).random(n) if sought else np.empty((0, 0))
    for place in shares:
        yield {
            name: _at(name, option, wanted, share)
            for (name, (option, wanted)), share in zip(sought.items(), place, strict=True)
        }


def _at(name: str, option: Option, wanted: Any, share: float) -> Any:
    """The value at a share, 0 to 1, of what is wanted of a parameter."""
    if not _is_range(option, wanted):
        values = _listed(name, option, wanted)
        return values[int(share * len(values))]
    low, high, _ = _ends(name, option, wanted)
    if option.kind == "whole number":
        return int(np.floor(low + share * (high + 1 - low)))
    return float(low + share * (high - low))


def _values(name: str, option: Option, wanted: Any) -> list[Any]:
    """The values of a parameter in a grid."""
    if not _is_range(option, wanted):
        return _listed(name, option, wanted)
    steps = np.linspace(*_ends(name, option, wanted))
    return sorted({round(step) for step in steps}) if option.kind == "whole number" else steps.tolist()


def _is_range(option: Option, wanted: Any) -> bool:
    return isinstance(wanted, Mapping) and option.kind != "true or false"


def _listed(name: str, option: Option, wanted: Any) -> list[Any]:
    """The values of a list, numbers of one type; both truth values where nothing is said."""
    if isinstance(wanted, Mapping):
        return [False, True]
    if not isinstance(wanted, list | tuple) or not wanted:
        raise bad_plan(f"{name} has no values", 'give a list of values, or {"low": ..., "high": ..., "n": ...}')
    return [float(v) if option.kind == "number" and type(v) is int else v for v in wanted]


def _ends(name: str, option: Option, wanted: Mapping[str, Any]) -> tuple[float, float, int]:
    """Least and largest value and how many of them; from the declaration where nothing is said."""
    if strange := sorted(set(wanted) - {"low", "high", "n"}):
        raise bad_plan(f"{name} has {strange[0]!r}", 'give "low", "high" and "n" only')
    low, high = wanted.get("low", option.span[0]), wanted.get("high", option.span[1])
    n = wanted.get("n", _GRID)
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) and np.isfinite(v) for v in (low, high))
    if option.kind == "text" or not numbers or not low <= high:
        raise bad_plan(f"{name} has no range from low to high", "give a list of values, or two finite ends")
    if not isinstance(n, int) or isinstance(n, bool) or not 1 <= n <= 1000:
        raise bad_plan(f'"n" of {name} is no whole number from 1 to 1000', "give one")
    return low, high, n


def _setting(base: Contender, place: Mapping[str, Any], known: Mapping[str, Option]) -> Setting:
    """A setting at a place; what equals the default is left out, so that each setting has one form."""
    threshold = THRESHOLD.check(THRESHOLD_HU, place.get(THRESHOLD_HU, THRESHOLD.default))
    options = {name: value for name, value in place.items() if name != THRESHOLD_HU}
    for name, value in options.items():
        known[name].check(f"The option {name} of {base.method}", value)
    if base.preset == "default":
        options = {name: value for name, value in options.items() if value != known[name].default}
    usual = threshold == THRESHOLD.default
    return Setting(Contender(base.method, base.preset, options), None if usual else float(threshold))
