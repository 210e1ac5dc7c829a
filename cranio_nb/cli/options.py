"""Options that several commands share, and what is checked before any work is done.

Nothing here loads more than click and the names of the methods, so that `--help` answers at once.
"""

from __future__ import annotations

import json
import os
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import click

from ..errors import CannotWrite, InputRefused
from ..methods.catalogue import check_options
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
THRESHOLDS_HU = (50.0, 3000.0)
"""Between which a threshold of bone makes sense: above soft tissue and below metal."""
SIZES = ("tiny", "class", "full")
"""Grids of the synthetic head."""
HEADS = ("face", "simple")
"""The synthetic heads; `simple` is a dome without a face."""
CASE = ("ct", "mask.nii.gz", "truth.nii.gz", "truth.json")
"""What a synthetic case leaves in its folder."""


def _set_debug(ctx: click.Context, _: click.Parameter, value: bool) -> None:
    """Note that --debug was given, before or after the command's name."""
    ctx.meta["debug"] = ctx.meta.get("debug", False) or value


def _check_threshold(_: click.Context, __: click.Parameter, value: float | None) -> float | None:
    """Refuse a threshold that would take air or soft tissue for bone, or find none."""
    low, high = THRESHOLDS_HU
    if value is not None and not low <= value <= high:  # not a number is none of them, either
        what = "air or soft tissue" if value < low else "no bone"
        message = f"{value:g} HU would find {what}; bone begins at some 150 to 700 HU. Give {low:g} to {high:g}."
        raise click.BadParameter(message)
    return value


debug = click.option(
    "--debug", is_flag=True, expose_value=False, callback=_set_debug, help="Show where an error came from."
)
allow = click.option(
    "--allow", multiple=True, type=click.Choice(ALLOWANCES), help="Relax one check of the reader; may be repeated."
)
mask = click.option(
    "--mask", is_flag=True, help="Take every nonzero voxel as bone. Data of 0 and 1 are a mask without it."
)
label = click.option(
    "--label", type=int, metavar="N", help="Take the voxels of this value as bone: the skull in a map of labels."
)
threshold = click.option(
    "--threshold", type=float, metavar="HU", callback=_check_threshold, help="Lowest HU of bone.  [default: 400]"
)
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
    called = {"scan": "INPUT", "from_": "--from", "patch": "PATCH"}
    return {
        called.get(name, f"--{name}" if name.isidentifier() and name.islower() else name): path
        for name, path in reads.items()
    }
