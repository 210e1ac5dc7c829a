"""What holds for all answers of a wrong function -> a sentence: a form, a factor, a place, an argument left unused."""

from __future__ import annotations

import dis
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

_ALIKE = 1e-6  # relative
_ROUNDED = 1e-4  # relative; what rounding can do
_POWERS = {1: "{}", 2: "{}^2", -1: "1 / {}", -2: "1 / {}^2"}


@dataclass(frozen=True, eq=False)
class Trial:
    """A function as it was tried.

    Parameters
    ----------
    function : callable
    cases : list of tuple
        What it was given.
    right : list
        The right answer to each case.
    found : list
        Its own answer to each.
    """

    function: Callable[..., Any]
    cases: list[tuple[Any, ...]]
    right: list[Any]
    found: list[Any]

    @property
    def arguments(self) -> Iterator[tuple[str, list[Any]]]:
        """Name of each argument, with its values case by case.

        Returns
        -------
        iterator of (str, list)
            Of none, where the function does not say how it calls them.
        """
        code = getattr(self.function, "__code__", None)
        names = code.co_varnames[: code.co_argcount] if code else ()
        return zip(names, map(list, zip(*self.cases, strict=True)), strict=False)


def by_nothing(trial: Trial) -> str:
    """What is said of a function that uses none of its arguments, whatever its answers happen to be.

    Parameters
    ----------
    trial : Trial

    Returns
    -------
    str
        Empty where it uses one.
    """
    unused = _unused(trial)
    return _by_unused(trial) if unused and len(unused) == len(list(trial.arguments)) else ""


def rule_for(trial: Trial) -> str:
    """The sentence of the first rule that holds.

    Parameters
    ----------
    trial : Trial

    Returns
    -------
    str
        Empty where none does.

    Examples
    --------
    >>> rule_for(Trial(lambda r, h: r, [(1.0, 2.0), (3.0, 5.0)], [2.0, 15.0], [1.0, 3.0]))
    'Each of your numbers is right but for a factor that goes with 1 / h.'
    """
    for rule in (
        _by_argument,
        _by_field,
        by_form,
        _by_mask,
        _by_order,
        _by_number,
        _by_rounding,
        _by_power,
        _by_unused,
        _by_constant,
        _by_place,
    ):
        if sentence := rule(trial):
            return sentence
    return ""


def as_numbers(value: Any) -> NDArray[Any] | None:
    """An answer as an array of numbers or truth values.

    Parameters
    ----------
    value : Any

    Returns
    -------
    ndarray or None
        None where it is something else.
    """
    try:
        found = np.asarray(value)
    except (TypeError, ValueError):  # rows of several lengths
        return None
    return found if found.dtype.kind in "biuf" else None


def near(one: Any, other: Any) -> bool:
    """Whether numbers agree but for rounding.

    Parameters
    ----------
    one, other : array_like
        Of one shape.

    Returns
    -------
    bool
    """
    largest = float(np.abs(np.asarray(other, float)).max(initial=0.0))
    return bool(np.allclose(np.asarray(one, float), np.asarray(other, float), rtol=_ALIKE, atol=_ALIKE * largest))


def _pairs(trial: Trial) -> list[tuple[NDArray[Any], NDArray[Any]]]:
    """Answers beside the right ones; none where one of them is not made of numbers."""
    pairs = [(as_numbers(a), as_numbers(b)) for a, b in zip(trial.found, trial.right, strict=True)]
    good = [(a, b) for a, b in pairs if a is not None and b is not None and a.size]
    return good if len(good) == len(pairs) else []


def _alike(trial: Trial, *, masks: bool) -> list[tuple[NDArray[Any], NDArray[Any]]]:
    """Answers beside the right ones, of the right shapes: masks, or numbers; else none."""
    pairs = _pairs(trial)
    fit = all(a.shape == b.shape and (b.dtype == bool) == masks and (masks or a.dtype != bool) for a, b in pairs)
    return pairs if fit else []


def _by_argument(trial: Trial) -> str:
    for name, values in trial.arguments:
        if all(isinstance(v, np.ndarray) and np.array_equal(f, v) for f, v in zip(trial.found, values, strict=True)):
            return f"This is `{name}`, as it was given."
    return ""


def _by_field(trial: Trial) -> str:
    """A field of an object that has the form of the answer."""
    kind = type(trial.found[0])
    for name in (*getattr(kind, "__dataclass_fields__", ()), *getattr(kind, "_fields", ())):
        parts = [as_numbers(getattr(value, name, None)) for value in trial.found]
        wanted = [np.shape(right) for right in trial.right]
        if all(part is not None and part.shape == shape for part, shape in zip(parts, wanted, strict=True)):
            return f"This is a {kind.__name__}, which holds more than was asked for: take its `.{name}`."
    return ""


def by_form(trial: Trial) -> str:
    """What is said of answers of another number of axes than the right ones, or turned round.

    Parameters
    ----------
    trial : Trial

    Returns
    -------
    str
        Empty where the forms agree.
    """
    pairs = _pairs(trial)
    if pairs and all(b.ndim == 0 < a.ndim and a.size == 1 for a, b in pairs):
        return "One number is wanted, and yours stands in an array: take it out, with [0] or float()."
    if pairs and all(b.ndim == 0 < a.ndim for a, b in pairs):
        return "One number is wanted, and these are many: which step makes one of them (sum, mean, max)?"
    if pairs and all(a.ndim == 0 < b.ndim and a.dtype == bool for a, b in pairs):
        return "Many values are wanted, and this is one True or False: was a tuple compared instead of its array?"
    if pairs and all(a.ndim == 0 < b.ndim for a, b in pairs):
        return "Many numbers are wanted, and this is one: is there a sum or mean too many, or without its axis?"
    if pairs and all(
        a.ndim > 1 and a.shape == b.T.shape and near(a, b.T) and not np.array_equal(a, b) for a, b in pairs
    ):
        return "Rows and columns are exchanged: yours is the transpose of the right one."
    return ""


def _by_mask(trial: Trial) -> str:
    pairs = _alike(trial, masks=True)
    if any(not np.isin(a, (0, 1)).all() for a, _ in pairs):
        return "These are numbers, and a mask is True or False: compare them, with == or >."
    if pairs and all(np.array_equal(a, b) for a, b in pairs):
        return "The right places, but as numbers: a bool mask is wanted, as a comparison makes it."
    if pairs and all(np.array_equal(a.astype(bool), ~b) for a, b in pairs):
        return "Inside out: what should be True is False, and the other way round."
    return ""


def _by_order(trial: Trial) -> str:
    pairs = _alike(trial, masks=False)
    if pairs and all(b.ndim > 0 and near(a, b[::-1]) for a, b in pairs):
        return "These are the right values in turned order: the last comes first."
    return ""


def _by_number(trial: Trial) -> str:
    """A factor or a step between all numbers and the right ones."""
    if not (pairs := _alike(trial, masks=False)):
        return ""
    one, other = (np.concatenate([np.ravel(pair[i]).astype(float) for pair in pairs]) for i in (0, 1))
    if near(one, -other):
        return "The sign is turned: each of your numbers is minus the right one."
    at = int(np.abs(other).argmax())
    if other[at] and np.any(one) and near(one, other * (ratio := one[at] / other[at])):
        if abs(ratio - 1) < _ROUNDED:
            return "The right numbers but for rounding: compute with float64, not float32."
        if near(ratio, np.degrees(1)) or near(ratio, np.radians(1)):
            return (
                "Degrees and radians are taken for each other: each of your numbers is 57.3 times too large or small."
            )
        return f"Each of your numbers is {ratio:.4g} times the right one: is there a factor too many, or one too few?"
    step = float(np.median(one - other))
    if near(one - other, np.full_like(one, step)):
        return f"Each of your numbers is {abs(step):.4g} too {'large' if step > 0 else 'small'}."
    return ""


def _by_rounding(trial: Trial) -> str:
    """The right numbers with fewer digits; where all are alike that says nothing."""
    if not (pairs := _alike(trial, masks=False)):
        return ""
    one, other = (np.concatenate([np.ravel(pair[i]).astype(float) for pair in pairs]) for i in (0, 1))
    if np.ptp(one) > 0 and any(np.array_equal(one, np.round(other, digits)) for digits in range(5)):
        return "The numbers were rounded: return them as they are."
    if np.ptp(one) > 0 and np.array_equal(one, np.trunc(other)):
        return "The numbers were cut to whole ones: by int, by `//`, or by an array of integers?"
    return ""


def _by_power(trial: Trial) -> str:
    """A factor that changes from case to case as a power of an argument."""
    pairs = _alike(trial, masks=False)
    if not pairs or any(b.ndim or not a * b > 0 for a, b in pairs):
        return ""
    ratio = np.array([float(a / b) for a, b in pairs])
    for name, values in trial.arguments:
        whole = all(isinstance(v, int) for v in values)
        for words, shift in ((name, 0), (f"({name} - 1)", 1)) if whole else ((name, 0),):
            base = np.array(values, float) - shift if all(isinstance(v, int | float) for v in values) else np.zeros(1)
            if np.all(base > 0) and np.ptp(base) > 0:
                for power, form in _POWERS.items():
                    if near(ratio / base**power, np.full(len(base), ratio[0] / base[0] ** power)):
                        return f"Each of your numbers is right but for a factor that goes with {form.format(words)}."
    return ""


def _unused(trial: Trial) -> list[str]:
    """Names of arguments that the function never reads."""
    code = getattr(trial.function, "__code__", None)
    if code is None:
        return []
    loads = [step.argval for step in dis.get_instructions(code) if "LOAD" in step.opname]
    used = {name for found in loads for name in (found if isinstance(found, tuple) else (found,))}
    return [f"`{name}`" for name, _ in trial.arguments if name not in used | set(code.co_cellvars)]


def _by_unused(trial: Trial) -> str:
    unused = _unused(trial) if _pairs(trial) else []
    what = "what is it" if len(unused) == 1 else "what are they"
    return f"The function does not use {' and '.join(unused)}: {what} given for?" if unused else ""


def _by_constant(trial: Trial) -> str:
    pairs = _alike(trial, masks=True)
    for value in (True, False):
        if pairs and all((a == value).all() for a, _ in pairs):
            return f"Every place is {value}: nothing was chosen."
    return ""


def _by_place(trial: Trial) -> str:
    """Where the places that are too many, or else those that are missing, lie among the masks that were given."""
    pairs = [(a.astype(bool), b) for a, b in _alike(trial, masks=True)]
    for words, wrong, could in (
        ("too much", [a & ~b for a, b in pairs], [~b for _, b in pairs]),
        ("missing", [b & ~a for a, b in pairs], [b for _, b in pairs]),
    ):
        for name, masks in trial.arguments if any(place.any() for place in wrong) else ():
            if all(isinstance(m, np.ndarray) and m.shape == w.shape for m, w in zip(masks, wrong, strict=True)):
                # said only where it need not be so
                if _within(wrong, masks) and not _within(could, masks):
                    return f"All that is {words} lies in `{name}`."
                outside = [~m for m in masks]
                # an answer that holds all of a mask lacks nothing in it: that says nothing of the cause
                whole = words == "missing" and _within(masks, [a for a, _ in pairs])
                if _within(wrong, outside) and not _within(could, outside) and not whole:
                    return f"All that is {words} lies outside `{name}`."
    return ""


def _within(places: list[NDArray[np.bool_]], masks: list[NDArray[np.bool_]]) -> bool:
    return not any((place & ~mask).any() for place, mask in zip(places, masks, strict=True))
