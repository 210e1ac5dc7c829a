"""Rows of one state of the source are told from those of another."""

from importlib.metadata import version as release_of

import pytest

from cranio_nb.methods import catalogue
from cranio_nb.study import version
from cranio_nb.study.version import version_of


def one(bone, openings, *, n=1):
    yield


def other(bone, openings, *, n=2):
    yield


@pytest.fixture
def no_process(monkeypatch):
    monkeypatch.setattr(version, "_loaded", lambda modules: repr(modules).encode())


def test_names_the_release_and_the_source(no_process):
    release, digest = version_of("hull").split("+")
    assert release == release_of("cranio-nb") and len(digest) == 8
    assert version_of("hull") == version_of("hull") != version_of("reflection")


def test_follows_the_text_of_an_own_method(no_process, monkeypatch):
    found = []
    for function in (one, other):
        monkeypatch.setattr(catalogue, "_added", {})
        catalogue.add_method("mine", function)
        found.append(version_of("mine"))
    assert found[0] != found[1]


def test_a_method_without_a_text_has_one_too(no_process, monkeypatch):
    monkeypatch.setattr(catalogue, "_added", {})
    found = []
    for n in (1, 2):
        space: dict = {"__name__": "nowhere"}
        exec(f"def made(bone, openings, *, n={n}):\n    yield {n}", space)
        catalogue._added.clear()
        catalogue.add_method("mine", space["made"])
        found.append(version_of("mine"))
    assert found[0] != found[1]


def test_the_files_that_a_method_loads_count():
    with_method, without = (version._loaded(modules) for modules in (("cranio_nb.methods.hull",), ()))
    assert len(with_method) == 32 and with_method != without
