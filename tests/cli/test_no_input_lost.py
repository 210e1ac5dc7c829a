"""No command writes on, into or over what it reads: every command, every way in which paths can meet, every alias.

The work is replaced by stand-ins that write small files of the true names, so that a path that is let through is
really written; what was there before must be there after, by its hash.
"""

import itertools
import os
from pathlib import Path

import nbformat
import pytest
from cli_runs import cranio, digest

from cranio_nb.cli import compare as compare_command
from cranio_nb.cli import console, phantom
from cranio_nb.output import comparison_folder, design_folder
from cranio_nb.output.manifest import read_manifest
from cranio_nb.pipeline import compare, preparation
from cranio_nb.prior import file as prior_file
from cranio_nb.prior import learning, study
from cranio_nb.teaching import build
from data_synth import files as case_files

DESIGN, COMPARISON = (*design_folder.FILES, "manifest.json"), (*comparison_folder.FILES, "manifest.json")
CASE = ("truth.nii.gz", "truth.json", "mask.nii.gz", "ct/1.dcm", "manifest.json")


class Made:
    """Stands in for whatever a run makes."""

    hu = made = trials = ()
    radii = (1,)


@pytest.fixture(autouse=True)
def no_work(monkeypatch):
    """Commands write small files in place of what takes time to make."""

    def write(names):
        def written(*given):
            folder = next(each for each in given if isinstance(each, Path))
            for name in names:
                (folder / name).parent.mkdir(exist_ok=True)
                (folder / name).write_text("new")

        return written

    for module, name, stand_in in (
        (design_folder, "run_and_draw", lambda *a, **k: (Made(), [])),
        (preparation, "prepare", lambda *a, **k: Made()),
        (compare, "compare", lambda *a, **k: Made()),
        (compare_command, "_print", lambda *a: None),
        (console, "print_result", lambda *a: None),
        (design_folder, "write_outputs", write(design_folder.FILES)),
        (comparison_folder, "write_comparison", write(comparison_folder.FILES)),
        (case_files, "write_case", write(("truth.nii.gz", "truth.json", "ct/1.dcm"))),
        (phantom, "_cut", lambda *a: Made()),
        (study, "read_intact_skulls", lambda *a, **k: ()),
        (learning, "learn_prior", lambda *a: Made()),
        (prior_file, "pack_prior", lambda made: b"new"),
    ):
        monkeypatch.setattr(module, name, stand_in)


def command(kind, read, out):
    """A command that reads one path of a kind, and writes into a folder."""
    scan, thin = Path("scan.nii"), ("--method", "thin-plate")
    return {
        "design INPUT": ("design", read, "--out", out),
        "design --truth": ("design", scan, "--truth", read, "--out", out),
        "design --params": ("design", scan, "--params", read, "--out", out),
        "design --prior": ("design", scan, *thin, "--prior", read, "--out", out),
        "design prior in --params": ("design", scan, *thin, "--params", "params.json", "--out", out),
        "compare INPUT": ("compare", read, "--out", out),
        "compare --truth": ("compare", scan, "--truth", read, "--out", out),
        "phantom --from": ("phantom", out, "--from", read),
    }[kind]


WRITTEN = {"design": DESIGN, "compare": COMPARISON, "phantom": CASE}
KINDS = ("design INPUT", "design --truth", "design --params", "design --prior", "design prior in --params")
KINDS += ("compare INPUT", "compare --truth", "phantom --from")
ALIASES = (
    "itself",
    "absolute",
    "dotted",
    "symbolic link",
    "hard link",
    "through a linked folder",
    "into a linked folder",
)
IN_OUT = [(k, name, a) for k in KINDS for name in WRITTEN[k.split()[0]] for a in ALIASES]


def alias(kind, read):
    """A path, and the output folder ``o``, by other names."""
    out, back = Path("o"), Path("links")
    back.mkdir()
    if kind == "absolute":
        return read.absolute(), out
    if kind == "dotted":
        return Path("links/..") / read, Path("o/../o")
    if kind == "symbolic link":
        (back / read.name).symlink_to(read.absolute())
        return back / read.name, out
    if kind == "hard link":
        os.link(read, back / read.name)
        return back / read.name, out
    (back / "o").symlink_to(out.absolute())
    return (back / read, out) if kind == "through a linked folder" else (read, back / "o")


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder to be in, with a scan."""
    monkeypatch.chdir(tmp_path)
    Path("scan.nii").write_text("{}")
    return tmp_path


def fill(path, text="{}"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def kept(before, place):
    """Whether all that was there is there, by hash; also through links and in replaced folders."""
    after = digest(place)
    return {name: after.get(name) for name in before} == before


@pytest.mark.parametrize(("kind", "name", "other"), IN_OUT)
def test_an_input_among_the_outputs_is_never_replaced(kind, name, other, place):
    read = Path("o") / name
    fill(read, "{}")
    read, out = alias(other, read)
    Path("params.json").write_text(f'{{"prior": "{read}"}}')
    before = digest(place)
    result = cranio(*command(kind, read, out))
    assert result.exit_code == 2 and "would replace what is read" in " ".join(result.stderr.split()), result.output
    assert digest(place) == before


WITHIN = ("in", "in/out", "in/a/b", "in/../in/out", "linked/out", "in/../linked")
FOLDERS = [
    k for k in KINDS if k in ("design INPUT", "design --truth", "compare INPUT", "compare --truth", "phantom --from")
]


@pytest.mark.parametrize(("kind", "out"), list(itertools.product(FOLDERS, WITHIN)))
def test_nothing_is_written_into_a_folder_that_is_read(kind, out, place):
    fill(Path("in/deep/1.dcm"))
    Path("linked").symlink_to("in")
    before = digest(place)
    result = cranio(*command(kind, Path("in"), Path(out)))
    assert result.exit_code == 2 and digest(place) == before, result.output


@pytest.mark.parametrize("kind", KINDS)
def test_an_input_elsewhere_in_the_output_folder_stays(kind, place):
    fill(Path("o/mine.nii.gz"), "{}")
    Path("params.json").write_text('{"prior": "o/mine.nii.gz"}')
    before = digest(place)
    for _ in range(2):
        result = cranio(*command(kind, Path("o/mine.nii.gz"), Path("o")))
        assert result.exit_code in (0, 4), result.output
        assert kept(before, place) and read_manifest(Path("o"))


OWN = [("design", n) for n in DESIGN] + [("compare", n) for n in COMPARISON] + [("phantom", n) for n in CASE]
OWN += [("demo", name) for name in {*DESIGN, *CASE}]


@pytest.mark.parametrize(("name", "file"), sorted(OWN))
@pytest.mark.parametrize("beside", [(), ("truth.json",)], ids=["alone", "beside truth.json"])
def test_what_no_run_wrote_is_never_replaced(name, file, beside, place):
    for path in (file, *beside):
        fill(Path("o") / path, "mine")
    before = digest(place)
    wanted = {"design": ("design", "scan.nii", "--out", "o"), "compare": ("compare", "scan.nii", "--out", "o")}
    result = cranio(*wanted.get(name, (name, *(("--out",) if name == "demo" else ()), "o")))
    if name in ("design", "compare") and beside == ("truth.json",) and file == "truth.json":
        return
    assert result.exit_code == 5 and digest(place) == before, result.output


def test_a_finished_folder_gets_no_new_data_beside_its_old_report(place):
    assert cranio("phantom", "o").exit_code == 0 and cranio("phantom", "o").exit_code == 0
    assert cranio("design", "o/ct", "--out", "o").exit_code == 0
    before = digest(place)
    for again in (("phantom", "o"), ("phantom", "o", "--from", "scan.nii")):
        result = cranio(*again)
        assert result.exit_code == 5 and "made from data that would be replaced" in result.stderr
        assert digest(place) == before
    assert cranio("design", "o/ct", "--truth", "o/truth.nii.gz", "--out", "o").exit_code == 0
    assert {p.name for p in Path("o").iterdir()} == {*DESIGN, "ct", "truth.nii.gz", "truth.json"}


PRIOR = [
    "scans/a.nii.gz",
    "scans/b/1.dcm",
    "scans/b/c/2.dcm",
    "scans/b/new.npz",
    "scans/../scans/a.nii.gz",
    "link/a.nii.gz",
]


@pytest.mark.parametrize("out", [*PRIOR, "hard.npz", "soft.npz", "notes.txt"])
def test_a_prior_replaces_priors_only(out, place):
    fill(Path("scans/a.nii.gz"))
    fill(Path("scans/b/1.dcm"))
    fill(Path("scans/b/c/2.dcm"))
    fill(Path("notes.txt"), "mine")
    Path("link").symlink_to("scans")
    os.link("scans/a.nii.gz", "hard.npz")
    Path("soft.npz").symlink_to("scans/a.nii.gz")
    before = digest(place)
    result = cranio("prior", "learn", "scans", "--out", out)
    assert result.exit_code in (2, 5) and digest(place) == before, result.output
    assert cranio("prior", "learn", "scans", "--out", "scans/prior.npz").exit_code == 0
    assert kept(before, place)


LESSON = "# %% [markdown]\n# # One\n\n# %%\n1 + 1\n"


def test_a_notebook_that_somebody_wrote_into_is_not_built_over(place, monkeypatch):
    monkeypatch.setattr(build, "execute", lambda notebook: notebook)
    fill(Path("notebooks/src/01_one.py"), LESSON)
    for _ in range(2):
        assert cranio("lessons", "build").exit_code == 0
    filled = Path("notebooks/exercises/01_one.ipynb")
    filled.write_text(filled.read_text().replace("1 + 1", "1 + 1  # my answer"))
    before = digest(place)
    result = cranio("lessons", "build")
    assert result.exit_code == 5 and "exercises/01_one.ipynb" in result.stderr and digest(place) == before


@pytest.mark.parametrize("name", ["notebooks/01_one.ipynb", "notebooks/exercises/01_one.ipynb"])
@pytest.mark.parametrize("link", [os.link, lambda target, name: Path(name).symlink_to(Path(target).absolute())])
def test_a_lesson_is_not_built_over_its_text(name, link, place):
    fill(Path("notebooks/src/01_one.py"), LESSON)
    Path("notebooks/exercises").mkdir()
    link("notebooks/src/01_one.py", name)
    before = digest(place)
    assert cranio("lessons", "build").exit_code == 2 and digest(place) == before


def test_pages_replace_pages_only(place, monkeypatch):
    fill(Path("notebooks/a.ipynb"), nbformat.writes(nbformat.v4.new_notebook()))
    for out in ("pages", "notebooks"):
        for _ in range(2):
            assert cranio("lessons", "html", out, "--folder", "notebooks").exit_code == 0
    Path("mine").mkdir()
    fill(Path("mine/a.html"), "mine")
    Path("linked").mkdir()
    os.link("notebooks/a.ipynb", "linked/a.html")
    before = digest(place)
    assert cranio("lessons", "html", "mine", "--folder", "notebooks").exit_code == 5
    assert cranio("lessons", "html", "linked", "--folder", "notebooks").exit_code == 2
    assert digest(place) == before


def test_what_only_reads_says_which_path_is_missing(place):
    for arguments, called in (
        (("inspect", "none"), "INPUT"),
        (("score", "none", "scan.nii", "--skull", "scan.nii"), "PATCH"),
        (("score", "scan.nii", "none", "--skull", "scan.nii"), "TRUTH"),
        (("score", "scan.nii", "scan.nii", "--skull", "none"), "--skull"),
        (("design", "scan.nii", "--truth", "none", "--out", "o"), "--truth"),
        (("compare", "scan.nii", "--truth", "none"), "--truth"),
        (("phantom", "o", "--from", "none"), "--from"),
    ):
        result = cranio(*arguments)
        assert result.exit_code == 3 and f"given as {called}." in result.stderr, result.output
    assert not Path("o").exists()


def test_they_are_more_than_three_hundred_commands():
    assert len(IN_OUT) + len(FOLDERS) * len(WITHIN) + 2 * len(OWN) + len(KINDS) + len(PRIOR) + 3 >= 300
