"""Options that several commands share, and what is checked before any work is done.

Nothing here loads more than click and the names of the methods, so that `--help` answers at once.
"""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from ..errors import CannotWrite, InputRefused
from ..methods.catalogue import check_options
from ..options import THRESHOLD, Option
from ..readers import ALLOWANCES


class UserPath(click.Path):
    """A path of the command line; a "~" that the shell left there is the home folder here, too."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Turn a word into a path.

        Parameters
        ----------
        value, param, ctx
            As for `click.ParamType.convert`.

        Returns
        -------
        Path

        Examples
        --------
        >>> PATH.convert("scans/head_ct", None, None).name
        'head_ct'
        """
        return super().convert(os.path.expanduser(value), param, ctx)


PATH = UserPath(path_type=Path)
"""Of every path on the command line."""
SIZES = ("tiny", "class", "full")
"""Grids of the synthetic head."""
HEADS = ("face", "simple")
"""The synthetic heads; `simple` is a dome without a face."""
CASE = ("ct", "mask.nii.gz", "truth.nii.gz", "truth.json")
"""What a synthetic case leaves in its folder."""


LABEL = Option("Take the voxels of this value as bone: the skull in a map of labels.", 1, 2**31 - 1, whole=True)
"""0 is what is no part; files hold labels of at most 32 bits."""
PLANE = Option("Number of a plane.", 0, 65535, whole=True, default=0)
"""DICOM counts rows, columns and frames by 16 bits."""
_LARGEST = 1_000_000  # bytes of a file of options: far more than all of them take


class Number(click.ParamType):
    """A number of the command line, held to what is declared of it."""

    def __init__(self, option: Option) -> None:
        self.option, self.name = option, option.unit or "N"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The number, refused with its range where it may not be given."""
        try:
            found = int(value) if self.option.kind == "whole number" else float(value)
            return self.option.check("It", found)
        except InputRefused as error:
            self.fail(str(error), param, ctx)
        except ValueError:  # no number, or one of too many digits
            self.fail(f"It is no {self.option.kind}. Give {self.option.wanted}.", param, ctx)


def number(name: str, option: Option, shown: str = "") -> Callable[[Any], Any]:
    """The option of a command for a number, its help made from its declaration.

    Parameters
    ----------
    name : str
        With its dashes.
    option : Option
    shown : str
        The default in the help, where it is not a number.

    Returns
    -------
    callable
        Decorator. The command gets None where nothing was given.
    """
    default = shown or ("" if option.default is None else f"{option.default:g}")
    words = f"{option.about} {option.limits}.{f'  [default: {default}]' if default else ''}"
    return click.option(name, type=Number(option), metavar=option.unit or "N", help=words)


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
    "--mask",
    is_flag=True,
    callback=lambda ctx, param, given: given or None,  # not given: the data say whether they are a mask
    help="Take every nonzero voxel as bone. Data of 0 and 1 are a mask without it.",
)
label = number("--label", LABEL)
threshold = number("--threshold", THRESHOLD)
truth = click.option(
    "--truth", type=PATH, metavar="MASK", help="Missing bone on the input's own grid, to score against."
)
opening = click.option(
    "--opening",
    multiple=True,
    type=click.IntRange(1),
    metavar="N",
    help="Close opening N of the list of `cranio-nb inspect`, doubtful or natural ones too; may be repeated.",
)
head = click.option(
    "--head", type=click.Choice(HEADS), default="face", show_default=True, help="simple: a dome without a face."
)
as_json = click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")


def reading(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that say how a scan is read: --mask, --label, --threshold and --allow.

    Parameters
    ----------
    command : callable
        It gets their values as `prepare` takes them.

    Returns
    -------
    callable
    """
    for option in (allow, threshold, label, mask):  # the last one stands first in the help
        command = option(command)
    return command


def read_params(method: str, path: Path | None) -> dict[str, Any]:
    """Options of a method from a JSON file, checked against those that the method has.

    Parameters
    ----------
    method : str
        A name of the catalogue.
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
        with path.open("rb") as file:
            text = file.read(_LARGEST + 1)
        found = json.loads(text) if len(text) <= _LARGEST else None
        if not isinstance(found, dict):
            raise ValueError
        check_options(method, found)
    except (OSError, ValueError, RecursionError) as error:
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
        If these are not two whole numbers of planes, the lower one first.

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
    if not (PLANE.allows(first) and PLANE.allows(last) and first <= last):
        words = f"two plane numbers A:B are wanted, each {PLANE.limits}, the lower one first."
        raise click.BadParameter(words, param_hint="--planes")
    return first, last


@contextmanager
def opening_checked() -> Iterator[None]:
    """Make a number that no opening has a fault of the option --opening.

    Returns
    -------
    context manager

    Raises
    ------
    click.BadParameter
        With the list of the openings that there are.
    """
    try:
        yield
    except InputRefused as error:
        if error.code != "NoSuchOpening":
            raise
        raise click.BadParameter(str(error), param_hint="--opening") from None


def check_reads(**reads: Path | None) -> None:
    """Refuse paths that are not there.

    Parameters
    ----------
    **reads : Path or None
        Option or argument of the command line -> its path; "scan" is called INPUT.

    Raises
    ------
    InputRefused
        ``NotFound``, saying which path it is.
    """
    from ..output import guard

    guard.check_reads(_named(reads))


def check_writes(out: Path, names: Collection[str], reads: Mapping[str, Path | None], **limits: Any) -> None:
    """Refuse, before any work is done, to write on, into or over what is read, or over what is not the program's own.

    Parameters
    ----------
    out : Path
        Folder that gets the files.
    names : collection of str
        Of the files and folders that are written.
    reads : mapping of str to Path or None
        As for `check_reads`.
    **limits : Any
        As for `output.guard.check_writes`.

    Raises
    ------
    click.BadParameter
        If an output would be, replace or lie in what is read.
    InputRefused, CannotWrite
        As `output.guard.check_writes`.
    """
    from ..output import guard
    from ..output.manifest import MANIFEST

    own_manifest = () if "own" in limits else (MANIFEST,)
    try:
        guard.check_writes(out, (*names, *own_manifest), _named(reads), **limits)
    except CannotWrite as error:
        if error.code != "OverInput":
            raise
        raise click.BadParameter(str(error), param_hint="the output") from None


def _named(reads: Mapping[str, Path | None]) -> dict[str, Path | None]:
    """The paths by what they are called on the command line."""
    called = {"scan": "INPUT", "from_": "--from", "patch": "PATCH", "plan": "PLAN"}
    return {
        called.get(name, f"--{name}" if name.isidentifier() and name.islower() else name): path
        for name, path in reads.items()
    }
