"""The command `cranio-nb phantom`: heads with a hole whose missing bone is known."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import InputRefused
from ..options import Option
from ..readers import read_ct, warnings_of
from .options import CASE, PATH, SIZES, allow, check_writes, debug, head, number

if TYPE_CHECKING:
    from data_synth import Case


SEED = Option("Chooses head, place, size and rim.", 0, 2**32 - 1, whole=True, default=0)
"""32 bits, which every generator of random numbers takes."""


@click.command()
@click.argument("out", type=PATH)
@click.option("--size", type=click.Choice(SIZES), default="class", show_default=True, help="Grid of the phantom.")
@click.option("--defect", default="unilateral", show_default=True, help="Kind of hole, e.g. frontal, vertex, large.")
@number("--seed", SEED)
@click.option("--from", "source", type=PATH, metavar="CT", help="Cut this intact scan or mask instead of a phantom.")
@head
@allow
@debug
def phantom(
    out: Path, size: str, defect: str, seed: int | None, source: Path | None, head: str, allow: tuple[str, ...]
) -> None:
    """Write a head with a hole, and the bone that is missing.

    Files: OUT/ct (DICOM; OUT/mask.nii.gz for a mask), OUT/truth.nii.gz and OUT/truth.json.

    \b
    Examples:
      cranio-nb phantom case1 --size full --defect unilateral --seed 1
      cranio-nb phantom case2 --from scans/intact_head --defect frontal
    """
    from data_synth import DEFECTS, head_case
    from data_synth.files import write_case

    from ..output import comparison_folder, design_folder
    from ..output.staging import staged
    from .console import progress_bar

    seed = SEED.default if seed is None else seed
    if defect not in DEFECTS:
        raise click.BadParameter(f"there is none named {defect!r}; choose one of {', '.join(DEFECTS)}.")
    results = (*design_folder.FILES, *comparison_folder.FILES)
    check_writes(out, CASE, {"from_": source}, results=results, n_bytes=_room(source))
    with progress_bar() as progress, staged(out, CASE) as part:
        progress("making the case", 0.0)
        case = head_case(head, size, defect, seed) if source is None else _cut(source, defect, seed, allow)
        write_case(part, case)
        progress("done", 1.0)
    click.echo(f"{out / ('mask.nii.gz' if case.hu is None else 'ct')}\n{out / 'truth.nii.gz'}")


def _room(source: Path | None) -> int:
    """Bytes that the case may take: a compressed scan grows to about four times its size."""
    files = [] if source is None else [source] if source.is_file() else source.rglob("*")
    return 64_000_000 + 4 * sum(path.stat().st_size for path in files if path.is_file())


def _cut(source: Path, defect: str, seed: int, allow: tuple[str, ...]) -> Case:
    """Cut a hole into a given intact scan or mask."""
    from data_synth import cut_case

    from ..pipeline.survey import survey_scan
    from ..vault.opening_choice import check_intact
    from .console import print_findings

    scan, load = read_ct(source, allow=allow)
    seen = survey_scan(scan)
    check_intact(seen.found, "A case with a known truth is cut from an intact skull.")
    print_findings(warnings_of((*load.findings, *seen.remarks)), err=True)
    try:
        return cut_case(scan.voxels, scan.affine, defect, seed, is_mask=load.kind == "mask")
    except ValueError as error:
        raise InputRefused("CannotCut", str(error)) from error
