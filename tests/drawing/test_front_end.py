"""Where a notebook runs decides how it shows itself."""

import sys

import pytest

from cranio_nb.drawing import front_end
from cranio_nb.errors import InputRefused

MARKS = ("COLAB_RELEASE_TAG", "JUPYTERHUB_USER", "BINDER_SERVICE_HOST", "VSCODE_PID", "CODESPACES")
MARKS += ("KUBERNETES_SERVICE_HOST", "JPY_SESSION_NAME", "CRANIO_NB_MODE")


@pytest.fixture
def nowhere(monkeypatch):
    """A process that no front end has started."""
    for name in MARKS:
        monkeypatch.delenv(name, raising=False)
    monkeypatch.delitem(sys.modules, "google.colab", raising=False)
    monkeypatch.delitem(sys.modules, "ipykernel", raising=False)
    return monkeypatch


@pytest.mark.parametrize("asked", ["static", "widget"])
def test_what_is_asked_for_is_taken(nowhere, asked):
    nowhere.setenv("CRANIO_NB_MODE", asked)
    assert front_end.mode() == asked


def test_without_a_front_end_it_is_static(nowhere):
    assert front_end.mode() == "static" and front_end.is_local() and front_end.proxy() is None
    nowhere.setenv("JPY_SESSION_NAME", "a.ipynb")
    assert front_end.mode() == "static"


def test_a_kernel_that_a_server_started_has_one(nowhere):
    nowhere.setitem(sys.modules, "ipykernel", object())
    assert front_end.mode() == "static"
    nowhere.setenv("JPY_SESSION_NAME", "a.ipynb")
    assert front_end.mode() == "widget"


@pytest.mark.parametrize(
    ("mark", "name"), [("JUPYTERHUB_USER", "JupyterHub"), ("COLAB_RELEASE_TAG", "Colab"), ("VSCODE_PID", "VS Code")]
)
def test_what_lies_before_the_browser_is_named(nowhere, mark, name):
    nowhere.setenv(mark, "1")
    assert front_end.proxy() == name and not front_end.is_local()


def test_an_unknown_mode_is_refused(nowhere):
    nowhere.setenv("CRANIO_NB_MODE", "loud")
    with pytest.raises(InputRefused, match="static, widget, auto"):
        front_end.mode()
