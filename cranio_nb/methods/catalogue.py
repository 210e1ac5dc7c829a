"""The methods that can be asked for by name: the built-in ones, those of other packages, and those added by hand.

A method is a function ``pieces(bone, openings, *, <options>) -> Iterator[Piece]`` that yields one `Piece` for each
opening, in their order. Its options are its keyword-only parameters, each with a default and, as its annotation, an
`Option`: what it means, its range and its unit. Nothing is loaded before a method is used.

Another package offers a method by an entry point in its ``pyproject.toml`` that names a module with the function
``pieces`` and, where it has them, the dict ``PRESETS`` and the `Work` ``WORK``::

    [project.entry-points."cranio_nb.methods"]
    mine = "my_package.mine"
"""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from importlib import import_module
from importlib.metadata import EntryPoint, entry_points
from typing import Any

from ..errors import InputRefused
from ..options import Option, Work, declared
from ..volume import Volume
from .piece import Piece

METHODS = {
    "slicewise": "cranio_nb.methods.slicewise.method",
    "hull": "cranio_nb.methods.hull",
    "reflection": "cranio_nb.methods.reflection",
    "you": "cranio_nb.methods.you.method",
    "thin-plate": "cranio_nb.methods.thin_plate",
    "dnurbs": "cranio_nb.methods.dnurbs.method",
}
"""The built-in methods: name -> module with the function ``pieces`` and, where it has presets, ``PRESETS``."""

GROUP = "cranio_nb.methods"
"""Group of the entry points by which other packages offer methods."""

COMMON = {"smooth": Option("A surface without stairs.", default=True)}
"""Options that `design` itself gives every method: `smooth` for a surface without stairs."""

Pieces = Callable[..., Iterator[Piece]]
Preset = Mapping[str, Any] | Callable[[Volume], Mapping[str, Any]]


@dataclass(frozen=True)
class Method:
    """A method and its presets.

    Parameters
    ----------
    name : str
    pieces : callable
        ``pieces(bone, openings, *, <options>)``, yields a `Piece` for each opening.
    presets : dict
        Name -> options, or a function of the bone that returns them. The preset "default" is not among them: it is
        the defaults of the options.
    options : dict
        Name -> what is declared of it, as far as it was read off already (`options_of`).
    work : Work or None
    """

    name: str
    pieces: Pieces
    presets: Mapping[str, Preset]
    options: Mapping[str, Option] = field(default_factory=dict)
    work: Work | None = None


_added: dict[str, Method] = {}  # by `add_method`, in this process
_NAME = 40  # letters of an unknown name that are shown


def add_method(name: str, pieces: Pieces | None = None, *, presets: Mapping[str, Preset] | None = None) -> Any:
    """Add an own method to the catalogue, for this process and those that it starts.

    Parameters
    ----------
    name : str
        A name that no other method has, without spaces and colons.
    pieces : callable, optional
        ``pieces(bone, openings, *, <options>)``, yields a `Piece` for each opening. When not given, a decorator for
        such a function is returned. Ranges and units of its options are declared as its annotations (`Option`).
    presets : dict, optional
        Name -> options, or a function of the bone that returns them.

    Returns
    -------
    callable
        `pieces`, or the decorator.

    Raises
    ------
    InputRefused
        ``BadMethod`` for what is no such function; ``MethodNameTaken``. The same function may be added again, so a
        cell of a notebook can be run twice.

    Examples
    --------
    >>> import cranio_nb as cn
    >>> from typing import Annotated
    >>> from scipy import ndimage
    >>> from cranio_nb.methods.catalogue import default_options, remove_method
    >>> from cranio_nb.methods.piece import Piece
    >>> from cranio_nb.options import Option
    >>> @cn.add_method("sheet")
    ... def pieces(bone, openings, *, grow_px: Annotated[int, Option("How far the sheet grows.", 1, 20, "px")] = 2):
    ...     for opening in openings:
    ...         yield Piece(ndimage.binary_dilation(opening.sheet.voxels, iterations=grow_px))
    >>> default_options("sheet")
    {'grow_px': 2, 'smooth': True}
    >>> remove_method("sheet")
    """
    if pieces is None:
        return lambda function: add_method(name, function, presets=presets)
    made = _checked(name, pieces, presets or {})
    options = declared(pieces)
    if off := [option for option, what in options.items() if what.limits and not what.allows(what.default)]:
        message = f"The method {name!r} has a default of {', '.join(off)} beyond its own range."
        raise InputRefused("BadMethod", message, "Declare a range that holds it.")
    before = _added.get(name)
    if (before is None and name in method_names()) or (before and _place(before.pieces) != _place(pieces)):
        remedy = f"Choose a name other than {', '.join(method_names())}."
        raise InputRefused("MethodNameTaken", f"There is a method named {name!r} already.", remedy)
    _added[name] = replace(made, options=options)
    return pieces


def keep_method(method: Method) -> None:
    """Take a method as another process had it into the catalogue, in place of what was added by that name before.

    Parameters
    ----------
    method : Method
        A built-in method of its name, or one of another package, stays.
    """
    if method.name in _added or method.name not in method_names():
        _added[method.name] = method


def remove_method(name: str) -> None:
    """Take a method that `add_method` added out of the catalogue again; other names are left alone.

    Parameters
    ----------
    name : str
    """
    _added.pop(name, None)


def is_method(name: str) -> bool:
    """Whether there is a method of a name; other packages are asked last, as that takes longest.

    Parameters
    ----------
    name : str

    Returns
    -------
    bool
    """
    return name in METHODS or name in _added or name in _offered()


def method_names() -> tuple[str, ...]:
    """Names of all methods: the built-in ones, those of other packages, those added by `add_method`.

    Returns
    -------
    tuple of str
    """
    return tuple(dict.fromkeys((*METHODS, *_offered(), *_added)))


def find_method(name: str) -> Method:
    """The method of a name.

    Parameters
    ----------
    name : str

    Returns
    -------
    Method

    Raises
    ------
    InputRefused
        ``UnknownMethod``; ``BadMethod`` for an entry point that names no method.
    """
    if name in _added:
        return _added[name]
    path = METHODS.get(name)
    if path is None:
        offered = _offered()
        if name not in offered:
            known = ", ".join(dict.fromkeys((*METHODS, *offered, *_added)))
            raise InputRefused("UnknownMethod", f"There is no method named {name!r}.", f"Known are: {known}.")
        path = offered[name].value
    module = import_module(path)
    made = _checked(name, getattr(module, "pieces", None), getattr(module, "PRESETS", {}))
    return replace(made, work=getattr(module, "WORK", None))


def added_methods() -> tuple[Method, ...]:
    """The methods that `add_method` added in this process.

    Returns
    -------
    tuple of Method
    """
    return tuple(_added.values())


def preset_names(name: str) -> tuple[str, ...]:
    """The presets of a method, "default" first.

    Parameters
    ----------
    name : str
        Of the method.

    Returns
    -------
    tuple of str
    """
    return ("default", *find_method(name).presets)


def preset_options(name: str, preset: str, bone: Volume) -> dict[str, Any]:
    """The options that a preset changes.

    Parameters
    ----------
    name, preset : str
        Of the method and of its preset.
    bone : Volume
        Bool mask of the skull, for presets that depend on its grid.

    Returns
    -------
    dict

    Raises
    ------
    InputRefused
        ``UnknownPreset``.
    """
    check_preset(name, preset)
    found = {} if preset == "default" else find_method(name).presets[preset]
    return dict(found(bone) if callable(found) else found)


def check_preset(name: str, preset: str) -> None:
    """Refuse a preset that a method does not have.

    Parameters
    ----------
    name, preset : str
        Of the method and of its preset.

    Raises
    ------
    InputRefused
        ``UnknownMethod`` or ``UnknownPreset``.
    """
    if preset not in preset_names(name):
        message = f"The method {name} has no preset named {preset!r}."
        raise InputRefused("UnknownPreset", message, f"It has: {', '.join(preset_names(name))}.")


def default_options(name: str) -> dict[str, Any]:
    """Every option of a method with its default value.

    Parameters
    ----------
    name : str
        Of the method.

    Returns
    -------
    dict
    """
    return {option: what.default for option, what in options_of(name).items()}


def options_of(name: str) -> dict[str, Option]:
    """Every option of a method: what it means, its range, its unit and its default.

    Parameters
    ----------
    name : str
        Of the method.

    Returns
    -------
    dict of str to Option

    Examples
    --------
    >>> from cranio_nb.methods.catalogue import options_of
    >>> options_of("slicewise")["skip_mm"].limits
    '0 to 20 mm'
    """
    found = find_method(name)
    return {**(found.options or declared(found.pieces)), **COMMON}


def check_options(name: str, options: Mapping[str, Any]) -> None:
    """Refuse options that a method does not have, values beyond what is declared, and too much work together.

    Parameters
    ----------
    name : str
        Of the method.
    options : dict

    Raises
    ------
    InputRefused
        ``UnknownOption``, ``BadOption`` or ``TooMuchWork``.
    """
    known = options_of(name)
    for option, value in options.items():
        if option not in known:
            message = f"The method {name} has no option {option[:_NAME]!r}."
            raise InputRefused("UnknownOption", message, f"It has: {', '.join(known)}.")
        known[option].check(f"The option {option} of {name}", value)
    if work := find_method(name).work:
        work.check({option: what.default for option, what in known.items()} | dict(options))


def _offered() -> dict[str, EntryPoint]:
    """The methods that other installed packages offer."""
    return {point.name: point for point in entry_points(group=GROUP)}


def _place(function: Pieces) -> tuple[str, str]:
    """Where a function was written: its module and its name there."""
    return getattr(function, "__module__", ""), getattr(function, "__qualname__", "")


def _checked(name: Any, pieces: Any, presets: Any) -> Method:
    """The method, refused where it is none (``BadMethod``)."""
    parameters = list(inspect.signature(pieces).parameters.values()) if callable(pieces) else []
    loose = [p.name for p in parameters[2:] if p.kind is not p.KEYWORD_ONLY or p.default is p.empty]
    if not isinstance(name, str) or not name or any(c.isspace() or c == ":" for c in name):
        problem = "needs a name that is a word without spaces and colons"
    elif not callable(pieces):
        problem = f"is given as {type(pieces).__name__}, and wanted is a function"
    elif len(parameters) < 2 or any(p.kind is not p.POSITIONAL_OR_KEYWORD for p in parameters[:2]):
        problem = "does not take bone and openings as its first two parameters"
    elif loose:
        problem = f"has parameters that are no keyword-only options with a default: {', '.join(loose)}"
    elif COMMON.keys() & {p.name for p in parameters}:
        problem = f"has an option that `design` gives to every method: {', '.join(COMMON)}"
    elif not isinstance(presets, Mapping) or "default" in presets:
        problem = "needs presets as a dict of names other than 'default'"
    else:
        return Method(name, pieces, presets)
    remedy = "Write it as pieces(bone, openings, *, option=default, ...), which yields a Piece for each opening."
    raise InputRefused("BadMethod", f"The method {name!r} {problem}.", remedy)
