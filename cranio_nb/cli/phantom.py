"""The command `cranio-nb phantom`: heads with a hole whose missing bone is known."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import InputRefused
from ..readers import read_ct
from .options import PATH, SIZES, allow, check_case_folder, debug

if TYPE_CHECKING:
    from data_synth import Case


@click.command()
@click.argument("out", type=PATH)
@click.option("--size", type=click.Choice(SIZES), default="class", show_default=True, help="Grid of the phantom.")
@click.option("--defect", default="unilateral", show_default=True, help="Kind of hole, e.g. frontal, vertex, large.")
@click.option("--seed", type=int, default=0, show_default=True, help="Chooses head, place, size and rim.")
@click.option("--from", "source", type=PATH, metavar="CT", help="Cut this intact scan or mask instead of a phantom.")
@allow
@debug
def phantom(out: Path, size: str, defect: str, seed: int, source: Path | None, allow: tuple[str, ...]) -> None:
    """Write a head with a hole, and the bone that is missing.

    Files: OUT/ct (DICOM; OUT/mask.nii.gz for a mask), OUT/truth.nii.gz and OUT/truth.json.

    \b
    Examples:
      cranio-nb phantom case1 --size full --defect unilateral --seed 1
      cranio-nb phantom case2 --from scans/intact_head --defect frontal
    """
    from data_synth import DEFECTS, phantom_case
    from data_synth.files import write_case

    from ..output.staging import check_folder, staged
    from .console import progress_bar

    if defect not in DEFECTS:
        raise click.BadParameter(f"there is none named {defect!r}; choose one of {', '.join(DEFECTS)}.")
    check_folder(out, ("truth.nii.gz", "truth.json"))
    check_case_folder(out)
    with progress_bar() as progress, staged(out) as part:
        progress("making the case", 0.0)
        case = phantom_case(size, defect, seed) if source is None else _cut(source, defect, seed, allow)
        write_case(part, case)
        progress("done", 1.0)
    click.echo(f"{out / ('mask.nii.gz' if case.hu is None else 'ct')}\n{out / 'truth.nii.gz'}")


def _cut(source: Path, defect: str, seed: int, allow: tuple[str, ...]) -> Case:
    """Cut a hole into a given intact scan or mask."""
    from data_synth import cut_case

    scan, load = read_ct(source, allow=allow)
    try:
        return cut_case(scan.voxels, scan.affine, defect, seed, is_mask=load.kind == "mask")
    except ValueError as error:
        raise InputRefused("CannotCut", str(error)) from error
