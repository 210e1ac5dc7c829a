"""Options that several commands share, and what is checked before any work is done.

Nothing here loads more than click and the names of the methods, so that `--help` answers at once.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from ..errors import CannotWrite, InputRefused
from ..methods.catalogue import check_options
from ..readers import ALLOWANCES

PATH = click.Path(path_type=Path)
SIZES = ("tiny", "class", "full")
"""Grids of the synthetic head."""


def _set_debug(ctx: click.Context, _: click.Parameter, value: bool) -> None:
    """Note that --debug was given, before or after the command's name."""
    ctx.meta["debug"] = ctx.meta.get("debug", False) or value


debug = click.option(
    "--debug", is_flag=True, expose_value=False, callback=_set_debug, help="Show where an error came from."
)
allow = click.option(
    "--allow", multiple=True, type=click.Choice(ALLOWANCES), help="Relax one check of the reader; may be repeated."
)
mask = click.option(
    "--mask", is_flag=True, help="Take every nonzero voxel as bone. Data of 0 and 1 are a mask without it."
)
threshold = click.option("--threshold", type=float, metavar="HU", help="Lowest HU of bone.  [default: 400]")
truth = click.option(
    "--truth", type=PATH, metavar="MASK", help="Missing bone on the input's own grid, to score against."
)
as_json = click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")


def read_params(method: str, path: Path | None) -> dict[str, Any]:
    """Options of a method from a JSON file, checked against those that the method has.

    Parameters
    ----------
    method : str
        A key of `catalogue.METHODS`.
    path : Path or None
        File with ``{name: value, ...}``.

    Returns
    -------
    dict of str to Any
        Empty without a file.

    Raises
    ------
    click.BadParameter
        If the file cannot be read, or the method has no such option.

    Examples
    --------
    >>> _ = Path("params.json").write_text('{"n_snaxels": 31}')
    >>> read_params("slicewise", Path("params.json"))
    {'n_snaxels': 31}
    """
    if path is None:
        return {}
    try:
        found = json.loads(path.read_text(encoding="utf-8"))
        if not isinstance(found, dict):
            raise ValueError
        check_options(method, found)
    except (OSError, ValueError) as error:
        why = str(error) if isinstance(error, InputRefused) else "it is not a readable JSON file of {name: value, ...}."
        raise click.BadParameter(why, param_hint="--params") from None
    return found


def parse_planes(text: str | None) -> tuple[int, int] | None:
    """First and last plane of ``A:B``.

    Parameters
    ----------
    text : str or None

    Returns
    -------
    tuple of int or None
        Both planes included; None where nothing was given.

    Raises
    ------
    click.BadParameter
        If these are not two whole numbers.

    Examples
    --------
    >>> parse_planes("40:75")
    (40, 75)
    """
    if text is None:
        return None
    try:
        first, last = (int(part) for part in text.split(":"))
    except ValueError:
        raise click.BadParameter("two plane numbers A:B are wanted.", param_hint="--planes") from None
    return first, last


def check_not_input(out: Path, scan: Path) -> None:
    """Refuse to write where the input is.

    Raises
    ------
    click.BadParameter
        If both are the same place.
    """
    if out.resolve() == scan.resolve():
        raise click.BadParameter("this is the input; nothing is ever written there.", param_hint="--out")


def check_case_folder(out: Path) -> None:
    """Refuse a folder whose `ct` no earlier synthetic case can have left: it would be replaced.

    Raises
    ------
    CannotWrite
        If there is a folder `ct` and no `truth.json` beside it.
    """
    if (out / "ct").exists() and not (out / "truth.json").is_file():
        message = "The output folder holds a folder named ct that was not written by this command."
        raise CannotWrite("CannotWrite", message, "Name another folder.")
