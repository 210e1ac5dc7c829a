"""The command `cranio-nb inspect`: how a scan is read, and where its skull is open."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import CranioError
from ..readers import read_ct
from .options import PATH, allow, as_json, check_reads, debug, label, mask, threshold

if TYPE_CHECKING:
    from ..evaluation.opening_size import OpeningSize


@click.command()
@click.argument("scan", type=PATH, metavar="INPUT")
@mask
@label
@threshold
@allow
@as_json
@debug
def inspect(
    scan: Path, mask: bool, label: int | None, threshold: float | None, allow: tuple[str, ...], as_json: bool
) -> None:
    """Show how a scan is read and which openings its skull has.

    \b
    Examples:
      cranio-nb inspect scans/head_ct
      cranio-nb inspect skull.nrrd --mask --json
    """
    from ..evaluation.opening_size import measure_opening
    from ..output.design_folder import load_record
    from ..stages.segmentation import bone_of
    from ..vault.head_frame import find_head_frame
    from ..vault.opening_search import find_openings
    from ..vault.remarks import remarks
    from .console import print_json, print_load, print_openings, progress_bar

    check_reads(scan=scan)
    with progress_bar() as progress:
        volume, load = read_ct(
            scan, mask=mask or None, label=label, allow=allow, progress=lambda i, n: progress("reading", i / n)
        )
    # what was read is printed also where the skull is refused; the refusal ends the command
    problem: CranioError | None = None
    sizes: list[OpeningSize] = []
    try:
        bone = bone_of(volume, threshold)
        frame = find_head_frame(bone)
        load = replace(load, findings=(*load.findings, *remarks(bone, frame)))
        sizes = [measure_opening(one) for one in find_openings(bone, scan=volume, frame=frame)]
    except CranioError as error:
        problem = error
    if as_json:
        print_json({"load": load_record(load), "openings": sizes, "problem": problem and problem.code})
    else:
        print_load(load)
        print_openings(sizes)
    if problem:
        raise problem
