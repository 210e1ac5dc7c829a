"""The scripts of `benchmarks` as modules: they lie in no package and import each other by name."""

import importlib
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"


def script(name: str):
    """A fixture that gives the script of this name."""

    @pytest.fixture(scope="module", name=name)
    def module():
        with pytest.MonkeyPatch.context() as patch:
            patch.syspath_prepend(str(FOLDER))
            yield importlib.import_module(name)

    return module
