"""Every method on skulls with a known missing part: prints mean, sd and worst of each measure.

    python benchmarks/skullfix.py [FOLDER] [--methods slicewise ...] [--processes 2] [--out skullfix.csv]

FOLDER holds one folder per case with `defective.nrrd` and `implant.nrrd`, masks on one grid; by default
skullfix/cases in the folder of CRANIO_NB_DATA. SkullFix (Kodym et al. 2021, doi 10.1016/j.dib.2021.106902) is
non-commercial; nothing of it is part of this project. Rows are appended to a CSV file; a second run does what is
missing. No hint is given to a method: bone and openings are found as `cranio-nb design` finds them.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import cohort

from cranio_nb.readers import read_ct
from cranio_nb.volume import Volume


def load(folder: str) -> tuple[Volume, Volume]:
    """Skull and missing part of one case."""
    bone, truth = (read_ct(Path(folder) / f"{name}.nrrd", mask=True)[0] for name in ("defective", "implant"))
    return bone, truth


def cases(folder: Path) -> list[cohort.Case]:
    found = sorted(path.parent for path in folder.glob("*/defective.nrrd"))
    return [cohort.Case(case.name, load, (str(case),), {}) for case in found]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cohort.add_arguments(parser, "skullfix.csv")
    asked = parser.parse_args()
    found = cases(cohort.folder_of(asked, "skullfix/cases"))
    rows = cohort.run_cohort(found, cohort.contenders_of(asked), asked.out, processes=asked.processes)
    print(f"\n== SkullFix, {len(found)} cases")
    cohort.print_summary(rows)


if __name__ == "__main__":
    main()
