"""A run that is killed at any moment leaves the old files or the new ones, and nothing after the next run."""

import json
import os
import random
import signal
import subprocess
import sys
import time

import pytest

from cranio_nb.errors import CannotWrite
from cranio_nb.output import part_folder as parts
from cranio_nb.output.manifest import read_manifest
from cranio_nb.output.staging import staged

NAMES = ("a.txt", "b.txt", "c.txt", "sub")
REPLACING = """
import sys
from pathlib import Path
from cranio_nb.output.staging import staged
folder, n = Path(sys.argv[1]), int(sys.argv[2])
print("ready", flush=True)
while True:
    n += 1
    with staged(folder, ("a.txt", "b.txt", "c.txt", "sub", "even.txt")) as part:
        for name in ("a.txt", "b.txt", "c.txt"):
            (part / name).write_text(str(n))
        (part / "sub").mkdir()
        (part / "sub" / "d.txt").write_text(str(n))
        if n % 2 == 0:
            (part / "even.txt").write_text(str(n))
"""


def runs_in(folder):
    """Numbers of the runs that the files of a folder are of."""
    found = {path.read_text() for name in NAMES[:3] if (path := folder / name).exists()}
    found |= {path.read_text() for path in folder.glob("sub/*")} | {
        path.read_text() for path in folder.glob("even.txt")
    }
    return found


def is_whole(folder):
    """Whether the files are those of one run, all of them, and the manifest says so."""
    (run,) = runs_in(folder)
    names = {*NAMES[:3], "sub/d.txt"} | ({"even.txt"} if int(run) % 2 == 0 else set())
    there = {p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file()}
    return names <= there and set(read_manifest(folder)) == names and ("even.txt" in there) == (int(run) % 2 == 0)


def kill_while_replacing(folder, rng):
    """Start a child that replaces the files again and again, and kill it."""
    number = max(map(int, runs_in(folder)), default=0)
    command = [sys.executable, "-c", REPLACING, folder, str(number)]
    with subprocess.Popen(command, stdout=subprocess.PIPE) as child:
        assert child.stdout.readline()
        time.sleep(rng.uniform(0.0, 0.05))
        child.send_signal(signal.SIGKILL)


def leftovers(tmp_path):
    return [path for path in tmp_path.rglob(".part-*")]


@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGKILL")
@pytest.mark.parametrize("others", [False, True], ids=["a folder of its own", "beside other files"])
def test_kills_leave_the_old_or_the_new_files(others, tmp_path):
    """With CRANIO_NB_KILLS=200 as many as the acceptance asks for."""
    rng, folder = random.Random(0), tmp_path / "out"
    folder.mkdir()
    if others:
        (folder / "mine.txt").write_text("mine")
    mixed = 0
    for _ in range(int(os.environ.get("CRANIO_NB_KILLS", "10"))):
        kill_while_replacing(folder, rng)
        if others:  # files are moved one by one here: what is not whole is known to be so, and the next run ends it
            mixed += len(runs_in(folder)) > 1 and not parts.is_unfinished(folder)
            parts.sweep(folder)
        mixed += bool(runs_in(folder)) and not is_whole(folder)
    with staged(folder, ("a.txt", "b.txt", "c.txt", "sub", "even.txt")) as part:
        (part / "a.txt").write_text("1")
    assert mixed == 0 and leftovers(tmp_path) == []
    assert {p.name for p in folder.iterdir()} == {"a.txt", "manifest.json"} | ({"mine.txt"} if others else set())


def test_what_a_kill_interrupts_is_ended_by_the_next_run(tmp_path, monkeypatch):
    """Stopped after each number of moves: unfinished, as the manifest says, until a sweep."""
    for stop in range(1, 5):
        folder = tmp_path / str(stop)
        folder.mkdir()
        (folder / "mine.txt").write_text("mine")
        for number in ("1", "2"):
            moves = []

            def move(*args, number=number, stop=stop, moves=moves):
                moves.append(args)
                if number == "2" and len(moves) > stop:
                    raise OSError("stopped")
                MOVE(*args)

            monkeypatch.setattr(parts, "_move", move)
            try:
                with staged(folder, ("a.txt", "b.txt", "c.txt", "sub")) as part:
                    for name in NAMES[:3]:
                        (part / name).write_text(number)
                    (part / "sub").mkdir()
                    (part / "sub" / "d.txt").write_text(number)
            except CannotWrite:
                assert number == "2"
        assert parts.is_unfinished(folder)
        monkeypatch.setattr(parts, "_move", MOVE)
        parts.sweep(folder)
        assert runs_in(folder) == {"2"} and not parts.is_unfinished(folder) and leftovers(folder) == []
        assert (folder / "mine.txt").read_text() == "mine"


MOVE = parts._move


def test_what_a_living_run_writes_is_not_swept(tmp_path):
    with parts.part_folder(tmp_path) as part:
        (part / "files" / "a").write_text("at work")
        parts.sweep(tmp_path)
        child = [
            sys.executable,
            "-c",
            f"from pathlib import Path; from cranio_nb.output.part_folder import sweep; sweep(Path({str(tmp_path)!r}))",
        ]
        subprocess.run(child, check=True)
        assert (part / "files" / "a").read_text() == "at work"
    assert list(tmp_path.iterdir()) == []


def test_what_others_made_is_not_swept(tmp_path):
    """Another's folder and file of a like name, and our own file of a run that may still be at work."""
    (tmp_path / ".part-abcdefgh").mkdir()
    (tmp_path / ".part-abcdefgh" / "mine.txt").write_text("mine")
    (tmp_path / ".part-two").write_text("mine")
    (tmp_path / ".part-12345-a.stl").write_text("at work")
    parts.sweep(tmp_path)
    assert len(list(tmp_path.iterdir())) == 3
    os.utime(tmp_path / ".part-12345-a.stl", (0, 0))
    parts.sweep(tmp_path)
    assert {p.name for p in tmp_path.iterdir()} == {".part-abcdefgh", ".part-two"}


@pytest.mark.parametrize("plan", [["../other.txt"], ["mine.txt"], [1], "{"], ids=str)
def test_a_plan_that_touches_what_is_not_ours_is_left_alone(plan, tmp_path):
    """As it may come with a folder from elsewhere."""
    home = tmp_path / "home"
    part = home / ".part-abcdefgh"
    (part / "commit").mkdir(parents=True)
    (part / "lock").touch()
    for path in (tmp_path / "other.txt", home / "mine.txt", home / "too.txt", part / "commit" / "new.txt"):
        path.write_text("mine")
    (part / "stale.json").write_text(plan if isinstance(plan, str) else json.dumps(plan))
    parts.sweep(home)
    assert {p.name for p in home.iterdir()} == {"mine.txt", "too.txt", part.name}
    (part / "stale.json").write_text("[]")
    (part / "commit" / "too.txt").write_text("another's")
    parts.sweep(home)
    assert (home / "too.txt").read_text() == "mine" and (tmp_path / "other.txt").exists()
