"""The commands `cranio-nb prior ...`: for whoever has a collection of intact heads."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import InputRefused
from .options import PATH, check_writes, debug, threshold


@click.group()
def prior() -> None:
    """Learn from intact skulls what vaults look like.

    \b
    Example:
      cranio-nb prior learn scans/intact --out prior.npz
    """


@prior.command()
@click.argument("folder", type=PATH)
@click.option("--out", type=PATH, required=True, metavar="NPZ", help="File to write, e.g. prior.npz.")
@threshold
@debug
def learn(folder: Path, out: Path, threshold: float | None) -> None:
    """Learn a shape prior from a folder with one scan of each head.

    FOLDER holds NIfTI or NRRD files, or subfolders of DICOM files: CTs in HU, or bone masks. Scans that do not show
    a whole, closed skull are skipped. Printed is how the error in a hole of 70 mm falls with the number of skulls.

    \b
    Example:
      cranio-nb prior learn scans/intact --out prior.npz
    """
    from ..output.staging import replace_file
    from ..prior.file import pack_prior
    from ..prior.learning import learn_prior
    from ..prior.study import list_scans, measure_learning_curve, read_intact_skulls
    from ..stages.segmentation import BONE_HU
    from .console import print_table, progress_bar

    home, scans = out.absolute().parent, list_scans(folder)
    # the file may lie beside the scans, but not among the slices of one
    reads = {f"FOLDER, scan {i}": path for i, path in enumerate(scans, 1)}
    check_writes(home, (out.name,), reads, own=_is_prior)
    with progress_bar() as progress:
        bones = read_intact_skulls(
            scans,
            threshold=BONE_HU if threshold is None else threshold,
            skipped=lambda name, why: click.echo(f"skipped {name}: {why}", err=True),
            warned=lambda name, why: click.echo(f"warning: {name}: {why}", err=True),
            progress=progress,
        )
        made = learn_prior(bones, progress)
        rows = measure_learning_curve(made, progress=progress) if len(made.radii) > 2 else ()
        replace_file(out, pack_prior(made))
    found = [(str(r.n_skulls), f"{r.outer:.2f}", f"{r.inner:.2f}") for r in rows]
    if found:
        print_table("Error in a hole of a skull that was left out", ("Skulls", "Outer (mm)", "Inner (mm)"), found)
    click.echo(f"{len(made.radii)} of {len(scans)} scans learned: {out}")


def _is_prior(folder: Path, name: str) -> bool:
    """Whether a file is a shape prior, which a new one may replace."""
    from ..prior.file import load_prior

    try:
        load_prior(folder / name)
    except InputRefused:
        return False
    return True
