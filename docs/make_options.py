"""Writes the table of all options of the built-in methods, docs/options.md, from where they are declared.

python docs/make_options.py
"""

from __future__ import annotations

from pathlib import Path

from cranio_nb.cli.methods import HEAD, option_rows
from cranio_nb.methods.catalogue import METHODS, preset_names

PAGE = Path(__file__).with_name("options.md")
_TOP = """# Options of the methods

`cn.design(bone, method="slicewise", skip_mm=2.0)`, or `cranio-nb design scan --params options.json --out out` with a
file `{"skip_mm": 2.0}`. A value beyond its range is refused, with the range. `cranio-nb methods` prints this list.
Why each limit is where it is stands beside it in the code. This page is written by `python docs/make_options.py`.
"""


def page() -> str:
    """The page as text."""
    parts = [_TOP]
    for name in METHODS:
        rows = [HEAD, ("---",) * len(HEAD), *((f"`{row[0]}`", *row[1:]) for row in option_rows(name))]
        table = "\n".join(f"| {' | '.join(row)} |" for row in rows)
        parts.append(f"## {name}\n\nPresets: {', '.join(preset_names(name))}.\n\n{table}\n")
    return "\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
