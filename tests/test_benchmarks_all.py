"""Every script of `benchmarks` can be loaded: what it imports is there."""

import importlib

import pytest
from benchmark_scripts import FOLDER

OPTIONAL = {"atheris", "distributed", "pyarrow"}


@pytest.mark.parametrize("name", sorted(path.stem for path in FOLDER.glob("*.py")))
def test_a_script_finds_what_it_imports(name, monkeypatch):
    monkeypatch.syspath_prepend(str(FOLDER))
    try:
        module = importlib.import_module(name)
    except ModuleNotFoundError as lacking:
        if lacking.name not in OPTIONAL:
            raise
        pytest.skip(f"{lacking.name} is not installed")
    assert module.__doc__
