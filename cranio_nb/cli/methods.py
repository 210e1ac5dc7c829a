"""The command `cranio-nb methods`: what can be set of each method, in which range and unit."""

from __future__ import annotations

import click

from ..methods.catalogue import method_names, options_of, preset_names
from .method_name import MethodName
from .options import debug

HEAD = ("Option", "Default", "Range", "Meaning")


@click.command()
@click.argument("names", nargs=-1, type=MethodName(), metavar="[NAME]...")
@debug
def methods(names: tuple[str, ...]) -> None:
    """List the methods with their presets and options.

    Options go into a JSON file, {name: value, ...}, that `cranio-nb design --params` reads.

    \b
    Examples:
      cranio-nb methods
      cranio-nb methods slicewise
    """
    from .console import print_table

    for name in names or method_names():
        print_table(f"{name} (presets: {', '.join(preset_names(name))})", HEAD, option_rows(name))


def option_rows(name: str) -> list[tuple[str, str, str, str]]:
    """The options of a method as rows of a table.

    Parameters
    ----------
    name : str
        Of the method.

    Returns
    -------
    list of tuple of str
        For each option its name, default, range with unit and meaning.

    Examples
    --------
    >>> option_rows("you")[0]
    ('n_guides', '12', '3 to 48', 'Guiding points around each hole.')
    """
    from json import dumps

    return [
        (option, dumps(what.default, default=str), what.limits or what.kind, what.about)
        for option, what in options_of(name).items()
    ]
