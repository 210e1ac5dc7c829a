"""Nothing is written on, into or over what is read, nor over what no run wrote; and the disk is asked first."""

import os
import shutil
from collections import namedtuple
from pathlib import Path

import pytest

from cranio_nb.errors import CannotWrite, InputRefused
from cranio_nb.output import guard
from cranio_nb.output.guard import check_folder, check_reads, check_writes
from cranio_nb.output.manifest import MANIFEST
from cranio_nb.output.staging import staged


def test_a_check_makes_nothing(tmp_path):
    check_folder(tmp_path / "x" / "y", ("a.txt",))
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("inside", ["", "deeper"])
def test_a_file_in_the_way_is_refused(tmp_path, inside):
    (tmp_path / "results").write_text("mine")
    with pytest.raises(CannotWrite, match="in the way") as refusal:
        check_folder(tmp_path / "results" / inside, ())
    assert str(tmp_path) not in str(refusal.value) and refusal.value.exit_code == 5


def test_a_folder_in_the_way_of_a_file_is_refused(tmp_path):
    (tmp_path / "design.json").mkdir()
    with pytest.raises(CannotWrite, match=r"design\.json is in the way"):
        check_folder(tmp_path, ("report.html", "design.json"))


def test_a_folder_that_may_not_be_written_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(os, "access", lambda *a: False)
    with pytest.raises(CannotWrite, match="not allowed"):
        check_folder(tmp_path / "results", ())


def same_file(kind, target, link):
    """Another name of a file or folder."""
    if kind == "hard link":
        os.link(target, link)
    elif kind == "symbolic link":
        link.symlink_to(target)
    return target if kind == "itself" else link


@pytest.mark.parametrize("kind", ["itself", "hard link", "symbolic link"])
def test_an_input_is_known_by_any_of_its_names(kind, tmp_path):
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "a.txt").write_text("input")
    read = same_file(kind, tmp_path / "out" / "a.txt", tmp_path / "other.txt")
    with pytest.raises(CannotWrite, match=r"a\.txt would replace what is read as --truth") as refusal:
        check_writes(tmp_path / "out", ("a.txt",), {"--truth": read})
    assert refusal.value.code == "OverInput" and str(tmp_path) not in str(refusal.value)


@pytest.mark.parametrize("out", ["scan", "scan/out", "scan/a/b/c", "scan/../scan/x", "link/out", "other/up/scan/y"])
def test_an_output_within_a_folder_of_inputs_is_refused(out, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "scan" / "a").mkdir(parents=True)
    (tmp_path / "link").symlink_to(tmp_path / "scan")
    (tmp_path / "other").mkdir()
    (tmp_path / "other" / "up").symlink_to("..")
    with pytest.raises(CannotWrite, match="lies in"):
        check_writes(Path(out), ("a.txt",), {"INPUT": tmp_path / "scan"})


def test_a_folder_that_is_replaced_may_hold_no_input(tmp_path):
    (tmp_path / "ct" / "deep").mkdir(parents=True)
    (tmp_path / "ct" / "deep" / "scan.nii").write_text("input")
    with pytest.raises(CannotWrite, match="ct would replace"):
        check_writes(tmp_path, ("ct",), {"--from": tmp_path / "ct" / "deep" / "scan.nii"})
    check_writes(tmp_path, ("truth.json",), {"--from": tmp_path / "ct" / "deep" / "scan.nii"})


def test_an_input_beside_the_outputs_is_none_of_them(tmp_path):
    (tmp_path / "scan.nii").write_text("input")
    check_writes(tmp_path, ("a.txt", "b.txt"), {"INPUT": tmp_path / "scan.nii", "--truth": None})


def test_names_in_another_case_are_the_same_where_the_system_says_so(tmp_path, monkeypatch):
    """A disk that knows no case: the stat of any name is that of the name in small letters."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "patch.nii").write_text("input")
    stat = os.stat

    def without_case(path, **more):
        return stat(tmp_path / os.path.relpath(path, tmp_path).lower(), **more)

    monkeypatch.setattr(guard.os, "stat", without_case)
    with pytest.raises(CannotWrite, match="would replace"):
        guard._check_overlap(tmp_path / "OUT", ("patch.nii",), {"--truth": tmp_path / "out" / "PATCH.NII"})


def test_what_no_run_wrote_or_somebody_changed_is_not_replaced(tmp_path):
    with staged(tmp_path / "out") as part:
        (part / "a.txt").write_text("ours")
        (part / "ct").mkdir()
        (part / "ct" / "1").write_text("ours")
    check_writes(tmp_path / "out", ("a.txt", "ct", "b.txt", MANIFEST))
    (tmp_path / "out" / "b.txt").write_text("mine")
    (tmp_path / "out" / "ct" / "2").write_text("mine")
    for name in ("b.txt", "ct"):
        with pytest.raises(CannotWrite, match=f"holds {name}, which no run wrote"):
            check_writes(tmp_path / "out", (name,))
    (tmp_path / "out" / "a.txt").write_text("changed")
    with pytest.raises(CannotWrite, match="as it is now"):
        check_writes(tmp_path / "out", ("a.txt",))


def test_a_manifest_of_another_program_is_not_replaced(tmp_path):
    (tmp_path / MANIFEST).write_text('{"name": "a web page"}')
    with pytest.raises(CannotWrite, match=MANIFEST):
        check_writes(tmp_path, ("a.txt", MANIFEST))


def test_old_results_may_not_come_to_lie_beside_new_data(tmp_path):
    (tmp_path / "report.html").write_text("of the data before")
    with pytest.raises(CannotWrite, match=r"report\.html, made from data"):
        check_writes(tmp_path, ("ct",), results=("report.html",))


def test_a_disk_that_is_full_or_takes_nothing_is_refused(tmp_path, monkeypatch):
    usage = namedtuple("usage", "total used free")
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage(10**9, 10**9, 5_000_000))
    with pytest.raises(CannotWrite, match="5 MB free; 32 MB are wanted"):
        check_writes(tmp_path / "out", ("a.txt",))
    monkeypatch.undo()

    def read_only(**_):
        raise OSError(30, "Read-only file system")

    monkeypatch.setattr(guard.tempfile, "TemporaryFile", read_only)
    with pytest.raises(CannotWrite, match="takes no files: Read-only"):
        check_writes(tmp_path / "out", ("a.txt",))


def test_a_path_that_is_missing_is_named(tmp_path):
    with pytest.raises(InputRefused, match="given as --skull"):
        check_reads({"PATCH": tmp_path, "--skull": tmp_path / "none"})


def test_files_that_a_killed_run_left_half_replaced_are_not_read(tmp_path):
    part = tmp_path / "out" / ".part-abcdefgh"
    (part / "commit").mkdir(parents=True)
    (tmp_path / "out" / "patch.nii.gz").write_text("of another run, perhaps")
    with pytest.raises(InputRefused, match="beside PATCH were being replaced"):
        check_reads({"PATCH": tmp_path / "out" / "patch.nii.gz"})
