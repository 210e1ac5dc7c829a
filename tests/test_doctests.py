"""Every example in a docstring runs and gives what it says."""

import doctest
import importlib
import pkgutil

import pytest

import cranio_nb

MODULES = sorted(module.name for module in pkgutil.walk_packages(cranio_nb.__path__, "cranio_nb."))
FINDER = doctest.DocTestFinder(exclude_empty=True)
FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def examples():
    """The docstrings with examples, as (module, test)."""
    for name in ["cranio_nb", *MODULES]:
        try:
            module = importlib.import_module(name)
        except ModuleNotFoundError:  # an extra that is not installed
            continue
        yield from (test for test in FINDER.find(module, name) if test.examples)


EXAMPLES = list(examples())


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda example: example.name)
def test_the_example_runs(example, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    said = []
    results = doctest.DocTestRunner(optionflags=FLAGS).run(example, out=said.append)
    assert results.attempted and not results.failed, "".join(said)


@pytest.mark.parametrize("name", sorted(set(cranio_nb.__all__) - {"__version__"}))
def test_each_name_of_the_face_has_an_example(name):
    home = getattr(cranio_nb, name)
    assert any(test.name == f"{home.__module__}.{home.__qualname__}" for test in EXAMPLES)


def test_there_are_many():
    assert len(EXAMPLES) >= 60
