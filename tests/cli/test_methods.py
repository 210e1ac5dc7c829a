"""The command `methods`, and the page of the docs made as it is."""

import importlib.util
from pathlib import Path

import pytest
from cli_runs import cranio

from cranio_nb.methods.catalogue import METHODS, options_of

MAKER = Path(__file__).parents[2] / "docs" / "make_options.py"


@pytest.mark.parametrize("name", METHODS)
def test_each_option_is_listed_with_default_and_range(name):
    result = cranio("methods", name)
    assert result.exit_code == 0
    lines = {line.split()[0]: line for line in result.stdout.splitlines() if line.strip()}
    for option, what in options_of(name).items():
        assert (what.limits or what.kind)[:20] in lines[option]


def test_all_are_listed_and_an_unknown_one_is_refused():
    listed = cranio("methods").stdout
    assert all(f"{name} (presets: default" in listed for name in METHODS)
    assert cranio("methods", "magic").exit_code == 2


def test_the_page_of_the_docs_is_current():
    spec = importlib.util.spec_from_file_location("make_options", MAKER)
    maker = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(maker)
    assert maker.PAGE.read_text(encoding="utf-8") == maker.page(), "run python docs/make_options.py"


def test_help_says_where_options_are_listed():
    for command in ("design", "compare"):
        assert "cranio-nb methods" in " ".join(cranio(command, "--help").stdout.split())
