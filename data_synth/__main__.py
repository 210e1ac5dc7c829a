"""Command line: write a synthetic or a cut case to a folder.

Examples
--------
A phantom as `OUT/ct/` (DICOM), `OUT/truth.nii.gz` (the missing bone) and `OUT/truth.json`::

    python -m data_synth OUT --size full --defect unilateral --seed 1

The same from an intact scan; a mask gives `OUT/mask.nii.gz` instead of `OUT/ct/`::

    python -m data_synth OUT --from CT --defect frontal --seed 2
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence

from .case import Case
from .cut import cut_case
from .defect import DEFECTS
from .files import read_scan, write_case
from .heads import HEADS, head_case
from .phantom import SIZES, phantom_case


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; wrong input ends with one sentence and exit code 2."""
    parser = _parser()
    options = parser.parse_args(arguments)
    try:
        write_case(options.out, _make(options))
    except (ValueError, OSError) as error:
        parser.error(str(error))
    return 0


def _make(options: argparse.Namespace) -> Case:
    if options.source is None and options.head == "face":
        if options.couch or options.metal or options.tilt or options.diameter:
            raise ValueError("--couch, --metal, --tilt and --diameter are for --head simple.")
        return head_case("face", options.size, options.defect, options.seed)
    if options.source is None:
        return phantom_case(
            options.size,
            options.defect,
            options.seed,
            diameter=options.diameter,
            couch=options.couch,
            metal=options.metal,
            tilt_deg=options.tilt,
        )
    voxels, affine, is_mask = read_scan(options.source)
    return cut_case(voxels, affine, options.defect, options.seed, is_mask=is_mask, diameter=options.diameter)


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m data_synth", description="Write a head with a hole in its skull.")
    parser.add_argument("out", metavar="OUT", help="new folder for the case")
    parser.add_argument("--from", dest="source", metavar="CT", help="cut this intact scan or mask; else a phantom")
    parser.add_argument("--defect", choices=DEFECTS, default="unilateral")
    parser.add_argument("--seed", type=int, default=0, help="chooses head, place, size and rim")
    parser.add_argument("--diameter", type=float, metavar="MM", help="mean diameter of every hole")
    parser.add_argument("--head", choices=HEADS, default="simple", help="face: skull base, face and neck as well")
    parser.add_argument("--size", choices=SIZES, default="tiny", help="grid of the phantom")
    parser.add_argument("--couch", action="store_true", help="phantom: put a plate behind the head")
    parser.add_argument("--metal", action="store_true", help="phantom: put a metal clip near the hole")
    parser.add_argument("--tilt", type=float, default=0.0, metavar="DEG", help="phantom: gantry tilt")
    return parser


if __name__ == "__main__":
    raise SystemExit(main())
