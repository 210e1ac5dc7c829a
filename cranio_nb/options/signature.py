"""The signature of a function -> the options that it declares."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import replace
from typing import Annotated, Any, get_args, get_origin

from ..errors import InputRefused
from .option import Option


def declared(function: Callable[..., Any]) -> dict[str, Option]:
    """The options that a function declares: its keyword-only parameters with their defaults.

    Parameters
    ----------
    function : callable
        Options without a declaration get one that says nothing but their kind.

    Returns
    -------
    dict of str to Option

    Raises
    ------
    InputRefused
        ``BadMethod`` where the text of an annotation that holds an `Option` names what its module does not know.

    Examples
    --------
    >>> from typing import Annotated
    >>> from cranio_nb.options import Option, declared
    >>> def grow(bone, *, px: Annotated[int, Option("How far.", 0, 20, "px")] = 2, round=True): ...
    >>> declared(grow)["px"].limits, declared(grow)["round"].wanted
    ('0 to 20 px', 'true or false')
    """
    parameters = inspect.signature(function).parameters.values()
    return {
        p.name: replace(_declaration(p, function), default=p.default) for p in parameters if p.kind is p.KEYWORD_ONLY
    }


def _declaration(parameter: inspect.Parameter, function: Callable[..., Any]) -> Option:
    """The option in the annotation of a parameter; an empty one where there is none."""
    hint = parameter.annotation
    if isinstance(hint, str) and Option.__name__ in hint:  # text, where annotations are not run
        try:
            hint = eval(hint, getattr(inspect.unwrap(function), "__globals__", {}))
        except NameError as error:
            message = f"The declaration of the option {parameter.name} cannot be read: {error}."
            raise InputRefused("BadMethod", message, "Import what it names at the top of its module.") from None
    parts = get_args(hint)[1:] if get_origin(hint) is Annotated else ()
    return next((part for part in parts if isinstance(part, Option)), Option(""))
