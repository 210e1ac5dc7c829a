"""The methods that can be asked for by name. Nothing is loaded before a method is used."""

from __future__ import annotations

import inspect
from importlib import import_module
from types import ModuleType
from typing import Any

from ..errors import InputRefused

METHODS = {
    "slicewise": "cranio_nb.methods.slicewise",
    "hull": "cranio_nb.methods.hull",
    "reflection": "cranio_nb.methods.reflection",
    "you": "cranio_nb.methods.you.method",
    "thin-plate": "cranio_nb.methods.thin_plate",
    "dnurbs": "cranio_nb.methods.dnurbs.method",
}
"""Name -> module with the door ``design(bone, openings, *, progress, **options) -> Prosthesis``. A module that also has
``paper_options(bone)`` offers the preset "paper"."""

PRESETS = ("default", "paper")


def method_module(name: str) -> ModuleType:
    """The module of a method.

    Raises
    ------
    InputRefused
        ``UnknownMethod``.
    """
    if name not in METHODS:
        raise InputRefused("UnknownMethod", f"There is no method named {name!r}.", f"Known are: {', '.join(METHODS)}.")
    return import_module(METHODS[name])


def default_options(name: str) -> dict[str, Any]:
    """Every option of a method with its default value."""
    parameters = inspect.signature(method_module(name).design).parameters.values()
    return {p.name: p.default for p in parameters if p.kind is p.KEYWORD_ONLY and p.name != "progress"}


def check_options(name: str, options: dict[str, Any]) -> None:
    """Refuse options that a method does not have, or whose values are of another kind than its defaults.

    Raises
    ------
    InputRefused
        ``UnknownOption`` or ``BadOption``.
    """
    known = default_options(name)
    for option, value in options.items():
        if option not in known:
            remedy = f"It has: {', '.join(known)}."
            raise InputRefused("UnknownOption", f"The method {name} has no option {option!r}.", remedy)
        if not _same_kind(value, known[option]):
            raise InputRefused(
                "BadOption",
                f"The option {option!r} of {name} was given as {type(value).__name__}.",
                f"Its default is {known[option]!r}; give a value of that kind.",
            )


def _same_kind(value: Any, default: Any) -> bool:
    """Whether a value may stand where the default stands; None stands for a number that follows from the data."""
    if isinstance(default, bool | str):
        return type(value) is type(default)
    if isinstance(value, bool):
        return False
    if isinstance(default, int):
        return isinstance(value, int)
    return isinstance(value, int | float) or (default is None and value is None)
