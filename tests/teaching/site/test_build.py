"""Building: what is missing is named, what Sphinx warns of is refused, all that is written is known.

`tests/browser/test_site.py` looks at a whole site.
"""

from pathlib import Path

import pytest
from small_site import write_project

from cranio_nb.errors import CannotWrite, InputRefused
from cranio_nb.output.guard import check_writes
from cranio_nb.output.staging import staged
from cranio_nb.teaching.site import build
from cranio_nb.teaching.site.panel_html import write_front

pytestmark = pytest.mark.filterwarnings("default")  # Sphinx and its extensions have warnings of their own


def made(tmp_path, text):
    """A site of one page, without lessons."""
    if any(build.find_spec(name) is None for name in build.NEEDS):
        pytest.skip('the extras "lab" and "site" are not installed')
    source = tmp_path / "source"
    (source / "front").mkdir(parents=True)
    write_front(source / "front")
    (source / "index.md").write_text(text)
    with staged(tmp_path / "site", build.NAMES) as part:
        build.run_sphinx(source, part, tmp_path / "trees")
    return tmp_path / "site"


def test_all_of_it_is_named_so_that_it_may_be_written_again_unless_it_was_changed(tmp_path):
    site = made(tmp_path, "# Start\n\nThe apex is $k N^2 / 8$.\n")
    assert {path.name for path in site.iterdir()} <= {*build.NAMES, "manifest.json"}
    assert "<math" in (site / "index.html").read_text()
    check_writes(site, build.NAMES)
    (site / "index.html").write_text("mine")
    with pytest.raises(CannotWrite):
        check_writes(site, build.NAMES)


def test_a_page_that_sphinx_warns_of_is_refused(tmp_path):
    with pytest.raises(InputRefused, match="nowhere"):
        made(tmp_path, "# Start\n\nSee [there](nowhere.md).\n")
    assert not (tmp_path / "site").exists()


def test_what_is_missing_is_named(monkeypatch, tmp_path):
    monkeypatch.setattr(build, "find_spec", lambda name: None if name in ("furo", "sphinx") else name)
    with pytest.raises(InputRefused, match=r"Not installed: sphinx, furo\. Run: pip install"):
        build.build_site(Path(tmp_path), tmp_path / "site")


def test_a_project_without_notebooks_is_refused(monkeypatch, tmp_path):
    monkeypatch.setattr(build, "find_spec", lambda name: name)
    write_project(tmp_path)
    with pytest.raises(InputRefused, match="no notebooks"):
        build.build_site(tmp_path, tmp_path / "site", only="77")
