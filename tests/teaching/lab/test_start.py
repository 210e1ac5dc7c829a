"""Opening the lessons: which folder, which settings, which words when it cannot be."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from cranio_nb.cli import doctor
from cranio_nb.cli.main import main
from cranio_nb.errors import InputRefused
from cranio_nb.teaching.lab import start


@pytest.fixture
def lessons(tmp_path):
    (tmp_path / "notebooks").mkdir()
    (tmp_path / "notebooks" / start.TOUR).write_text("{}")
    return tmp_path


def test_the_lessons_are_found_from_above_and_from_within(lessons, monkeypatch):
    here = (lessons / "notebooks").resolve()
    assert start.lessons_folder(lessons) == start.lessons_folder(lessons / "notebooks") == here
    for place in (lessons, here):
        monkeypatch.chdir(place)
        assert start.lessons_folder() == here


def test_a_folder_without_lessons_is_refused(tmp_path):
    with pytest.raises(InputRefused, match=start.TOUR):
        start.lessons_folder(tmp_path)
    done = CliRunner().invoke(main, ["lab", str(tmp_path)])
    assert done.exit_code == 3 and done.stderr.count("\n") == 1


def test_jupyterlab_reads_the_settings_that_come_with_the_package(lessons):
    pytest.importorskip("jupyterlab")
    command = start.lab_command(lessons, browser=False, port=9000)
    assert "--no-browser" in command and "--ServerApp.port=9000" in command
    done = subprocess.run([*command, "--show-config-json"], capture_output=True, text=True, timeout=60)
    config = json.loads(done.stdout)
    assert config["LabApp"]["app_settings_dir"] == str(start.SETTINGS)
    assert config["LabApp"]["default_url"].endswith(start.TOUR)
    settings = json.loads((start.SETTINGS / "overrides.json").read_text())
    assert settings["@jupyterlab/apputils-extension:kernels-settings"] == {"commsOverSubshells": "disabled"}


def test_the_settings_are_ones_that_jupyterlab_knows():
    """Each key of the overrides is a schema of the installed JupyterLab, and each entry one of its properties."""
    pytest.importorskip("jupyterlab")
    overrides = json.loads((start.SETTINGS / "overrides.json").read_text())
    for plugin, entries in overrides.items():
        package, _, name = plugin.partition(":")
        schema = f"{sys.prefix}/share/jupyter/lab/schemas/{package}/{name}.json"
        with open(schema, encoding="utf-8") as stream:
            assert set(entries) <= set(json.load(stream)["properties"]), plugin


def test_vtk_is_told_to_look_for_no_display(monkeypatch):
    monkeypatch.delenv("VTK_DEFAULT_OPENGL_WINDOW", raising=False)
    assert start.lab_environment()["VTK_DEFAULT_OPENGL_WINDOW"] == "vtkOSOpenGLRenderWindow"
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    assert start.lab_environment()["VTK_DEFAULT_OPENGL_WINDOW"] == "vtkEGLRenderWindow"


@pytest.mark.parametrize(("mark", "name"), [("JUPYTERHUB_USER", "JupyterHub"), ("VSCODE_PID", "VS Code")])
def test_the_doctor_sees_what_stands_before_the_browser(monkeypatch, mark, name):
    monkeypatch.setenv(mark, "1")
    assert doctor._front_end().found.startswith(name)


def test_opening_the_lab_is_not_loaded_with_the_command_line():
    looked_for = ("cranio_nb.teaching.lab.start", "jupyterlab")
    code = f"import sys, cranio_nb.cli.main; print(*(name in sys.modules for name in {looked_for}))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True).stdout.split() == ["False"] * 2


BINDER = Path(__file__).parents[3] / "binder"


@pytest.mark.skipif(not BINDER.is_dir(), reason="only a checkout has Binder's files")
def test_binder_installs_what_is_there():
    build = (BINDER / "postBuild").read_text()
    root = BINDER.parent
    assert all(
        (root / name).is_file() for name in ("constraints.txt", "cranio_nb/teaching/lab/settings/overrides.json")
    )
    assert "constraints.txt" in build and "cranio_nb/teaching/lab/settings/overrides.json" in build
    assert "libosmesa6" in (BINDER / "apt.txt").read_text().split()
    assert all((BINDER / name).stat().st_mode & 0o111 for name in ("postBuild", "start"))
    for name in ("postBuild", "start"):
        assert subprocess.run(["bash", "-n", str(BINDER / name)], check=False).returncode == 0
