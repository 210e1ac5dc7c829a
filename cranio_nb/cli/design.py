"""The command `cranio-nb design`: scan -> prosthesis, with its report."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from .method_name import MethodName, check_asked
from .options import PATH, check_writes, debug, opening, opening_checked, parse_planes, read_params, reading, truth


@click.command()
@click.argument("scan", type=PATH, metavar="INPUT")
@click.option("--out", type=PATH, required=True, help="Folder to write to; made if missing.")
@click.option("--method", type=MethodName(), default="slicewise", show_default=True)
@click.option("--preset", default="default", show_default=True, metavar="NAME", help="paper: as published in 2011.")
@click.option(
    "--params",
    type=PATH,
    metavar="JSON",
    help="File with options of the method, {name: value, ...}; see `cranio-nb methods`.",
)
@click.option("--prior", type=PATH, metavar="NPZ", help="What `cranio-nb prior learn` made; for thin-plate.")
@opening
@click.option("--planes", metavar="A:B", help="Close only what lies in planes A to B (see `cranio-nb inspect`).")
@truth
@reading
@debug
def design(
    scan: Path,
    out: Path,
    method: str,
    preset: str,
    params: Path | None,
    prior: Path | None,
    opening: tuple[int, ...],
    planes: str | None,
    truth: Path | None,
    **how_read: Any,
) -> None:
    """Design the prosthesis that closes the hole in a skull.

    INPUT is a folder of DICOM files, or a NIfTI or NRRD file with a CT in HU or a bone mask. Written are
    prosthesis.stl (world mm, LPS), patch.nii.gz (on the input's grid), design.json and report.html; all or nothing.

    \b
    Examples:
      cranio-nb design scans/head_ct --out out
      cranio-nb design skull.nii.gz --mask --preset paper --out out
      cranio-nb design scans/head_ct --opening 2 --out out
      cranio-nb design scans/head_ct --threshold 300 --planes 40:75 --out out
      cranio-nb design scans/head_ct --params options.json --out out
    """
    from ..output.painter import Painter

    with Painter() as painter:  # first of all: it loads what it draws with while the scan is read
        from ..output.design_folder import FILES, run_and_draw, write_outputs
        from ..output.staging import staged
        from ..pipeline.preparation import prepare
        from .console import print_result, progress_bar

        # everything that can be refused without reading the scan comes first
        check_asked(method, preset)
        options, between = read_params(method, params), parse_planes(planes)
        options |= {} if prior is None else {"prior": str(prior)}
        learned = options.get("prior")
        reads = {"scan": scan, "truth": truth, "params": params, "prior": Path(learned) if learned else None}
        check_writes(out, FILES, reads)
        with progress_bar() as progress, opening_checked():
            case = prepare(scan, opening=opening, planes=between, truth=truth, progress=progress, **how_read)
            result, page = run_and_draw(painter, case, method=method, preset=preset, progress=progress, **options)
            with staged(out, FILES) as part:
                write_outputs(result, part, page, progress)
        print_result(result, out)
