"""The command `cranio-nb inspect`: how a scan is read, and where its skull is open."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import click

from ..errors import CranioError
from ..readers import read_ct
from .options import PATH, as_json, check_reads, debug, reading

if TYPE_CHECKING:
    from ..vault.opening_choice import JudgedOpening


@click.command()
@click.argument("scan", type=PATH, metavar="INPUT")
@reading
@as_json
@debug
def inspect(
    scan: Path, mask: bool | None, label: int | None, threshold: float | None, allow: tuple[str, ...], as_json: bool
) -> None:
    """Show how a scan is read and which openings its skull has.

    Each opening has a number, by which `--opening` of design and compare chooses it, and a verdict: cut ones are
    closed; doubtful and natural ones are left open unless they are chosen.

    \b
    Examples:
      cranio-nb inspect scans/head_ct
      cranio-nb inspect skull.nrrd --mask --json
    """
    from ..output.design_folder import load_record
    from ..pipeline.survey import survey_scan
    from ..vault.remarks import thickness_remarks
    from .console import print_json, print_load, print_openings, progress_bar

    check_reads(scan=scan)
    with progress_bar() as progress:
        volume, load = read_ct(
            scan, mask=mask, label=label, allow=allow, progress=lambda i, n: progress("reading", i / n)
        )
    # what was read is printed also where the skull is refused; the refusal ends the command
    problem: CranioError | None = None
    found: tuple[JudgedOpening, ...] = ()
    closed: tuple[JudgedOpening, ...] = ()
    said = thickness_remarks(max(load.spacing))
    try:
        seen = survey_scan(volume, threshold)
        found, said = seen.found, seen.remarks
        closed = seen.choose()
    except CranioError as error:
        problem = error
    load = replace(load, findings=(*load.findings, *said))
    if as_json:
        listed = {"openings": closed, "left_open": [one for one in found if one not in closed]}
        records = {name: [one.record() for one in some] for name, some in listed.items()}
        print_json({"load": load_record(load), **records, "problem": problem and problem.code})
    else:
        print_load(load)
        print_openings(found)
    if problem:
        raise problem
