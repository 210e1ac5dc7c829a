"""Web pages of the lessons: every picture with its description, no kernel needed."""

import html
import re
from pathlib import Path

import nbformat
import pytest
from click.testing import CliRunner

from cranio_nb.cli.main import main
from cranio_nb.errors import InputRefused
from cranio_nb.teaching.web_pages import write_pages

FOLDER = Path(__file__).parents[2] / "notebooks"
NAMES = sorted(path.stem for path in (FOLDER / "src").glob("*.py"))


def pictures(notebook):
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", ())]
    return [output for output in outputs if any(kind.startswith("image/") for kind in output.get("data", {}))]


def test_pages_hold_every_picture_with_its_description_and_need_no_kernel(tmp_path):
    made = CliRunner().invoke(main, ["lessons", "html", str(tmp_path / "pages"), "--folder", str(FOLDER)])
    assert made.exit_code == 0, made.output
    assert sorted(path.stem for path in (tmp_path / "pages").iterdir()) == NAMES
    for name in NAMES:
        shown = pictures(nbformat.read(FOLDER / f"{name}.ipynb", as_version=4))
        page = (tmp_path / "pages" / f"{name}.html").read_text()
        found = re.findall(r'<img alt="([^"]*)"\s+src="data:image/png;base64,', page)
        alts = [html.unescape(alt) for alt in found]
        assert alts == [output.metadata["image/png"]["alt"] for output in shown] and all(alts)
        assert "No description has been provided" not in page


def test_pages_of_no_lessons_are_refused(tmp_path):
    with pytest.raises(InputRefused, match="no notebooks"):
        write_pages(tmp_path, tmp_path / "pages")
    assert not (tmp_path / "pages").exists()
