"""Pictures drawn elsewhere are those drawn here, whatever becomes of the process that draws."""

import subprocess
import sys

import pytest

from cranio_nb.output import painter
from cranio_nb.output.design_pictures import shape_shots, vault_of
from cranio_nb.output.painter import Painter
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import run_design
from data_synth import phantom_case
from data_synth.files import write_case


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("painted")
    write_case(folder, phantom_case("tiny", "burr_hole", 0))
    return run_design(prepare(folder / "ct"), method="slicewise")


@pytest.fixture(scope="module")
def here(run):
    return shape_shots(run.case, vault_of(run.case), run.prosthesis)


def painted(run):
    one = Painter(run.case)
    shots = one.draw(run.prosthesis)
    one.close()
    return shots.result()


def processes(monkeypatch, program=None):
    """The processes that are started from now on, with another program where one is given."""
    started, start = [], painter._start
    if program is not None:
        monkeypatch.setattr(painter, "_PROGRAM", program)
    monkeypatch.setattr(painter, "_LARGE", 0)
    monkeypatch.setattr(painter, "_start", lambda: started.append(start()) or started[-1])
    return started


def test_a_small_scan_is_drawn_in_a_thread(run, here, monkeypatch):
    monkeypatch.setattr(painter, "_start", lambda: pytest.fail("a process was started"))
    assert painted(run) == here and all(here.values())


def test_a_large_scan_is_drawn_in_a_process_which_ends(run, here, monkeypatch):
    started = processes(monkeypatch)
    monkeypatch.setattr(painter, "shape_shots", lambda *_: pytest.fail("drawn here"))
    assert painted(run) == here
    assert len(started) == 1 and started[0].wait(60) is not None


@pytest.mark.parametrize(
    "program",
    ["raise SystemExit", "import pickle, sys; pickle.load(sys.stdin.buffer)", "print('no pictures')"],
    ids=["dies at once", "dies after the case", "answers something else"],
)
def test_where_the_process_dies_the_pictures_are_drawn_here(program, run, here, monkeypatch):
    started = processes(monkeypatch, program)
    assert painted(run) == here
    started[0].wait(60)


def test_without_an_order_the_process_ends(run, monkeypatch):
    started = processes(monkeypatch)
    Painter(run.case).close()
    assert started[0].wait(60) is not None


def test_the_process_ends_with_the_one_that_started_it():
    process = painter._start()
    process.stdin.write(b"\x80\x05")  # a message that is never finished
    process.stdin.close()
    assert process.wait(60) == 0
    process.stdout.close()
    assert isinstance(process, subprocess.Popen) and sys.executable in process.args
