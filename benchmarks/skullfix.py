"""Every method on skulls with a known missing part: prints mean, sd and worst of each measure.

    python benchmarks/skullfix.py [FOLDER] [--methods slicewise ...] [--processes 2] [--out skullfix]

FOLDER holds one folder per case with `defective.nrrd` and `implant.nrrd`, masks on one grid; by default
skullfix/cases in the folder of CRANIO_NB_DATA. SkullFix (Kodym et al. 2021, doi 10.1016/j.dib.2021.106902) is
non-commercial; nothing of it is part of this project. Rows go to the folder of a study; a second run does what is
missing, and `cranio-nb study report` sums it up. No hint is given to a method: bone and openings are found as
`cranio-nb design` finds them.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import cohort

from cranio_nb.study.cases import Case, scan_cases


def cases(folder: Path) -> list[Case]:
    found = sorted(path.relative_to(folder).as_posix() for path in folder.glob("*/defective.nrrd"))
    return scan_cases(found, truth="implant.nrrd", mask=True, folder=folder)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    cohort.add_arguments(parser, "skullfix")
    asked = parser.parse_args()
    found = cases(cohort.folder_of(asked, "skullfix/cases"))
    columns = cohort.run(found, asked)
    print(f"\n== SkullFix, {len(found)} cases")
    cohort.print_summary(columns)


if __name__ == "__main__":
    main()
