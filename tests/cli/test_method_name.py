"""Names of methods on the command line: those of the catalogue, and what is refused with exit code 2."""

import click
import pytest

from cranio_nb.cli import method_name
from cranio_nb.methods.catalogue import METHODS, method_names, preset_names


@pytest.mark.parametrize("name", METHODS)
def test_a_built_in_name_stays_itself_and_no_other_package_is_read(name, monkeypatch):
    monkeypatch.setattr(method_name, "method_names", lambda: pytest.fail("entry points were read"))
    assert method_name.MethodName().convert(name, None, None) == name


@pytest.mark.parametrize("name", ["", "Hull", "thin_plate", "hull "])
def test_any_other_name_is_refused_with_all_that_there_are(name):
    with pytest.raises(click.BadParameter) as refused:
        method_name.MethodName().convert(name, None, None)
    assert refused.value.exit_code == 2 and all(known in refused.value.message for known in method_names())


def test_the_help_lists_every_name_once():
    option = click.Option(["--method"], type=method_name.MethodName())
    text = option.make_metavar(click.Context(click.Command("design")))
    assert text.strip("[]").split("|") == list(method_names())


@pytest.mark.parametrize("name", METHODS)
def test_presets_are_those_of_the_method(name):
    for preset in preset_names(name):
        method_name.check_asked(name, preset)
    with pytest.raises(click.BadParameter) as refused:
        method_name.check_asked(name, "of another method")
    assert refused.value.exit_code == 2 and refused.value.param_hint == "--preset"
