"""A page made elsewhere is the one made here, whatever becomes of the process that makes it."""

import re
import subprocess
import sys
import threading
from dataclasses import replace

import pytest

from cranio_nb.output import painter
from cranio_nb.output.design_page import measure_shots, report_page
from cranio_nb.output.design_pictures import patch_shots, skull_views, surface_shots
from cranio_nb.output.painter import Painter
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import run_design
from data_synth import phantom_case
from data_synth.files import write_case


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    folder = tmp_path_factory.mktemp("painted")
    write_case(folder, phantom_case("tiny", "burr_hole", 0))
    return prepare(folder / "ct", truth=folder / "truth.nii.gz")


@pytest.fixture(scope="module")
def run(case):
    return run_design(case, method="slicewise")


@pytest.fixture(scope="module")
def here(case, run):
    surface = surface_shots(case, skull_views(case), run.prosthesis)
    return report_page(run, patch_shots(case, run.prosthesis) | surface | measure_shots(run))


def painted(case, run):
    with Painter() as one:
        one.look_at(case)
        one.draw(run.prosthesis)
        return one.page(run).result()


@pytest.fixture
def processes(monkeypatch):
    """The processes that are started from now on."""
    started, start = [], painter._start
    monkeypatch.setattr(painter, "_n_processors", lambda: 2)
    monkeypatch.setattr(painter, "_start", lambda: started.append(start()) or started[-1])
    return started


def test_with_one_processor_a_thread_makes_the_page(case, run, here, monkeypatch):
    monkeypatch.setattr(painter, "_n_processors", lambda: 1)
    monkeypatch.setattr(painter, "_start", lambda: pytest.fail("a process was started"))
    assert painted(case, run) == here


def test_with_two_processors_a_process_makes_the_page_and_ends(case, run, here, processes, monkeypatch):
    monkeypatch.setattr("cranio_nb.output.design_pictures.surface_shots", lambda *_: pytest.fail("drawn here"))
    assert painted(case, run) == here
    assert len(processes) == 1 and processes[0].wait(60) is not None


def without_times(page):
    return re.sub(r"\d+\.\d s|[\d-]+ \d\d:\d\d UTC", "", page)


@pytest.mark.parametrize("n_processors", [1, 2])
def test_a_patch_drawn_before_there_is_a_surface_makes_the_same_page(n_processors, case, here, monkeypatch):
    monkeypatch.setattr(painter, "_n_processors", lambda: n_processors)
    with Painter() as one:
        one.look_at(case)
        result = run_design(case, method="slicewise", shaped=one.draw_patch, designed=one.draw)
        assert without_times(one.page(result).result()) == without_times(here)


@pytest.mark.parametrize(
    "program",
    [
        "raise SystemExit",
        "import pickle; pickle.load(sys.stdin.buffer)",
        "from cranio_nb.output.painter import _received, _known; case = _received(sys.stdin.buffer);"
        " _received(sys.stdin.buffer, _known(case))",
        "from cranio_nb.output.painter import _received, _known; case = _received(sys.stdin.buffer);"
        " shape = _received(sys.stdin.buffer, _known(case)); _received(sys.stdin.buffer, _known(case, shape))",
        "print('no page', flush=True); sys.stdin.buffer.read()",
    ],
    ids=[
        "dies at once",
        "dies within the case",
        "dies after the patch",
        "dies after the surface",
        "answers something else",
    ],
)
def test_where_the_process_dies_the_page_is_made_here(program, case, run, here, processes, monkeypatch):
    monkeypatch.setattr(painter, "_PROGRAM", program)
    assert painted(case, run) == here
    assert processes[0].wait(60) is not None


def test_what_a_method_keeps_and_cannot_be_sent_is_drawn_here(case, run, here, processes):
    keeps = replace(run.prosthesis, working=(*run.prosthesis.working, lambda: None))
    assert painted(case, replace(run, prosthesis=keeps)) == here


def test_what_a_library_prints_in_the_process_is_no_page(case, run, here, processes, monkeypatch):
    loud = "from cranio_nb.output import design_pictures as d; draw = d.skull_views;"
    loud += "d.skull_views = lambda case: print('a remark', flush=True) or draw(case);"
    monkeypatch.setattr(painter, "_PROGRAM", loud + painter._PROGRAM)
    monkeypatch.setattr("cranio_nb.output.design_pictures.surface_shots", lambda *_: pytest.fail("drawn here"))
    assert painted(case, run) == here


def test_where_no_process_can_be_started_the_page_is_made_here(case, run, here, monkeypatch):
    monkeypatch.setattr(painter, "_n_processors", lambda: 2)
    monkeypatch.setattr(sys, "executable", "/nowhere/python")
    assert painted(case, run) == here


def test_the_modules_are_those_of_the_one_that_asks(processes, tmp_path, monkeypatch):
    (tmp_path / "pickle.py").write_text("raise SystemExit")  # what lies where the user is, is not loaded
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "path", [entry for entry in sys.path if entry])
    monkeypatch.setattr(painter, "_PROGRAM", "import pickle; pickle.dump(sys.path, sys.stdout.buffer)")
    with Painter(), processes[0] as process:
        answer = process.stdout.read()
    assert b"pickle.py" not in answer and str(sys.path[-1]).encode() in answer


def test_what_is_not_wanted_any_more_is_not_made(case, run, processes):
    before = threading.active_count()
    with Painter() as one:
        one.look_at(case)
        one.draw(run.prosthesis)
    assert processes[0].wait(60) is not None
    assert threading.active_count() <= before


def test_the_process_ends_with_the_one_that_started_it():
    process = painter._start()
    process.stdin.write(b"\x80\x05")  # a message that is never finished
    process.stdin.close()
    assert process.wait(60) == 0
    process.stdout.close()
    assert isinstance(process, subprocess.Popen) and sys.executable in process.args
