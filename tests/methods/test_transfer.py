"""Own methods travel to another process by value, and are there only once."""

import subprocess
import sys

from cranio_nb.methods import catalogue, transfer
from cranio_nb.methods.piece import Piece
from cranio_nb.methods.transfer import pack_methods, unpack_methods

FACTOR = 3


def toy(bone, openings, *, n=2):
    """Uses a name of its module."""
    for opening in openings:
        yield Piece(opening.sheet.voxels, (), {"n": FACTOR * n})


def older(bone, openings, *, n=1):
    yield


def test_nothing_is_packed_where_nothing_was_added():
    assert pack_methods() == b""
    unpack_methods(b"")


def test_a_process_that_cannot_import_the_module_gets_the_method(tmp_path):
    catalogue.add_method("mine", toy, presets={"one": {"n": 1}})
    try:
        (tmp_path / "packed").write_bytes(pack_methods())
    finally:
        catalogue.remove_method("mine")
    code = (
        "import sys; from pathlib import Path; sys.modules['test_transfer'] = None\n"
        "from cranio_nb.methods import catalogue, transfer\n"
        f"transfer.unpack_methods(Path({str(tmp_path / 'packed')!r}).read_bytes())\n"
        f"transfer.unpack_methods(Path({str(tmp_path / 'packed')!r}).read_bytes())\n"
        "print(catalogue.default_options('mine'), catalogue.preset_names('mine'))\n"
        "print(list(catalogue.find_method('mine').pieces(None, [type('O', (), {'sheet': Volume})()], n=2))[0].record)"
    ).replace("Volume", "type('S', (), {'voxels': None})()")
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == ["{'n': 2, 'smooth': True} ('default', 'one')", "{'n': 6}"]


def test_a_process_that_has_an_older_form_gets_the_newer_one(monkeypatch):
    monkeypatch.setattr(catalogue, "_added", {})
    catalogue.add_method("mine", toy)
    monkeypatch.setattr(transfer, "_MADE", "another process")
    packed = pack_methods()
    monkeypatch.undo()
    monkeypatch.setattr(catalogue, "_added", {"mine": catalogue.Method("mine", older, {})})
    unpack_methods(packed)
    assert catalogue.default_options("mine") == {"n": 2, "smooth": True}


def test_what_was_packed_here_is_left_as_it_is(monkeypatch):
    monkeypatch.setattr(catalogue, "_added", {})
    catalogue.add_method("mine", toy)
    unpack_methods(pack_methods())
    assert catalogue.find_method("mine").pieces is toy
