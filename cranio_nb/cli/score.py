"""The command `cranio-nb score`: a patch against the bone that is missing."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import click

from ..readers import read_ct, warnings_of
from .options import PATH, as_json, check_reads, debug, reading

_UNITS = {"hd95": "mm", "assd": "mm", "rmse": "mm", "overlap": "voxels"}


@click.command()
@click.argument("patch", type=PATH)
@click.argument("truth", type=PATH)
@click.option("--skull", type=PATH, required=True, help="Skull with the hole: bone mask, or a CT.")
@reading
@as_json
@debug
def score(
    patch: Path,
    truth: Path,
    skull: Path,
    mask: bool | None,
    label: int | None,
    threshold: float | None,
    allow: tuple[str, ...],
    as_json: bool,
) -> None:
    """Measure a patch against the true one; all three on one grid.

    The skull's bone is found as `cranio-nb design` finds it: give --mask, --label, --threshold and --allow as
    there.

    \b
    Examples:
      cranio-nb score out/patch.nii.gz case1/truth.nii.gz --skull case1/ct
      cranio-nb score patch.nrrd truth.nrrd --skull skull.nrrd --json
    """
    from ..evaluation import scores
    from ..stages.segmentation import parts_of
    from ..vault.second_skull import second_skull_remarks
    from .console import print_findings, print_json, print_table

    check_reads(patch=patch, TRUTH=truth, skull=skull)
    (made, made_load), (true, true_load) = read_ct(patch, mask=True), read_ct(truth, mask=True)
    scan, scan_load = read_ct(skull, mask=mask, label=label, allow=allow)
    # the same bone that a design of this scan starts from
    parts = parts_of(scan, threshold)
    found = dataclasses.asdict(scores.score(made, true, parts.bone))
    for what, load in (("The patch", made_load), ("The truth", true_load), ("The skull", scan_load)):
        print_findings(warnings_of(load.findings, what), err=True)
    print_findings(second_skull_remarks(parts.bone, parts.others), err=True)
    if as_json:
        print_json(found)
        return
    print_table("", ("Measure", "Value", "Unit"), [(k, f"{v:.4g}", _UNITS.get(k, "")) for k, v in found.items()])
