"""The command `cranio-nb demo`: a synthetic head, its prosthesis, and how good that is."""

from __future__ import annotations

from pathlib import Path

import click

from .options import CASE, PATH, SIZES, check_writes, debug, head


@click.command()
@click.option("--out", type=PATH, default=Path("cranio_nb_out/demo"), show_default=True, help="Folder to write to.")
@click.option("--size", type=click.Choice(SIZES), default="full", show_default=True, help="Grid of the synthetic CT.")
@head
@debug
def demo(out: Path, size: str, head: str) -> None:
    """Design and score a prosthesis for a synthetic head CT.

    The CT is written as a DICOM series into OUT/ct and read back like any other scan. "full" is the size of the
    paper's scan, 512 x 512 x 68.

    \b
    Examples:
      cranio-nb demo
      cranio-nb demo --size tiny --out demo_tiny
    """
    from ..output.painter import Painter

    with Painter() as painter:  # first of all: it loads what it draws with while the scan is made
        from data_synth import head_case
        from data_synth.files import write_case

        from ..output import comparison_folder
        from ..output.design_folder import FILES, run_and_draw, write_outputs
        from ..output.staging import staged
        from ..pipeline.preparation import prepare
        from .console import print_result, progress_bar

        names = (*CASE, *FILES)
        n_bytes = 128_000_000 if size == "full" else 32_000_000
        check_writes(out, names, {}, results=comparison_folder.FILES, n_bytes=n_bytes)
        with progress_bar() as progress, staged(out, names) as part:
            progress("synthetic CT", 0.0)
            write_case(part, head_case(head, size, "unilateral", 0))
            case = prepare(part / "ct", truth=part / "truth.nii.gz", progress=progress)
            result, page = run_and_draw(painter, case, progress=progress)
            write_outputs(result, part, page, progress)
        print_result(result, out)
