"""Nothing is written but through the staging of `output`; whatever else touches the disk is named here with its reason.

`output/guard.py` refuses what would be lost, `output/staging.py` writes whole or not at all: a call that writes and
is in neither, nor in the list below, is a way round them.
"""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent / "cranio_nb"
STAGING = {"output/files.py", "output/part_folder.py", "output/staging.py"}  # the writers themselves
METHODS = set(
    (
        "write_text write_bytes savefig to_file to_filename tofile save savez savez_compressed savetxt save_as imsave "
        "write_image export writestr extractall touch mkdir makedirs rmdir unlink remove removedirs rmtree rename "
        "renames symlink_to hardlink_to symlink link truncate copy2 copyfile copytree copystat move mkdtemp mkstemp "
        "mkfifo TemporaryDirectory NamedTemporaryFile TemporaryFile make_archive unpack_archive dump urlretrieve"
    ).split()
)
REASONS = {
    ("output/guard.py", "TemporaryFile"): "tries whether the disk takes files; has no name and goes at once",
    ("output/painter.py", "dump"): "into the pipe of the process that draws, and back",
    ("output/mesh_files.py", "export"): "to bytes: a file type is given and no file",
    ("pipeline/trial.py", "TemporaryDirectory"): "masks for a child process, in the system's folder of such files",
    ("pipeline/trial.py", "save"): "into that folder",
    ("study/store.py", "mkdir"): "the folder of a study, which its command has guarded",
    ("study/store.py", "unlink"): "files of rows, when all of them are in a new one",
    ("teaching/build.py", "TemporaryDirectory"): "where a lesson runs",
    ("teaching/grading/running.py", "TemporaryDirectory"): "where what is handed in runs",
    ("teaching/grading/grades_folder.py", "mkdir"): "in the staged folder",
    ("teaching/export/assignment.py", "mkdir"): "in the staged folder",
    ("teaching/shipped.py", "mkdir"): "in the staged folder",
    ("teaching/classroom.py", "mkdtemp"): "a lesson's own new folder",
    ("teaching/classroom.py", "copytree"): "into that folder",
    ("drawing/described.py", "save"): "into memory",
    ("drawing/figures/axes.py", "savefig"): "into memory",
    ("teaching/diagrams/marks.py", "save"): "into memory",
    ("teaching/diagrams/film.py", "save"): "into memory",
    ("prior/file.py", "savez_compressed"): "into memory",
    ("teaching/widgets/tuning.py", "save"): "of the panel: guarded and staged",
    ("teaching/site/frames.py", "save"): "into memory",
    ("teaching/site/build.py", "TemporaryDirectory"): "where Sphinx finds its sources",
    **dict.fromkeys(
        [
            *(("teaching/site/build.py", call) for call in ("copytree", "mkdir", "rmtree", "unlink", "write_bytes")),
            *(("teaching/site/pages.py", call) for call in ("copytree", "mkdir", "write_text")),
            *(("teaching/site/downloads.py", call) for call in ("ZipFile", "writestr")),
            *(("teaching/site/panel_html.py", call) for call in ("write_bytes", "write_text")),
            *(("teaching/site/slides.py", call) for call in ("copytree", "mkdir", "write_bytes", "write_text")),
        ],
        "in the folder of those sources or in the staged folder",
    ),
}


def is_mode(node):
    """Whether an argument is a mode of `open` that writes."""
    value = node.value if isinstance(node, ast.Constant) else None
    return isinstance(value, str) and set(value) <= set("rwaxbt+") and bool(set(value) & set("wax+"))


def written(text):
    """Names of the calls in a text that may write, each with its line."""
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.Call):
            continue
        called = node.func
        of = ast.unparse(called.value) if isinstance(called, ast.Attribute) else None
        name = called.attr if isinstance(called, ast.Attribute) else getattr(called, "id", "")
        # words that are functions of our own when they stand alone, and the writers of `output.files`
        ours = name in ("write_text", "save", "remove", "move") and of in (None, "files")
        opens = name in ("open", "fdopen", "ZipFile", "GzipFile", "TarFile", "memmap")
        if name in METHODS and not ours:
            yield name, node.lineno
        elif opens and any(map(is_mode, (*node.args, *(word.value for word in node.keywords)))):
            yield name, node.lineno
        elif name == "replace" and (of == "os" or (of and len(node.args) == 1 and not node.keywords)):
            yield name, node.lineno  # text takes two arguments, a dataclass keywords


def test_nothing_is_written_round_the_guard():
    found = {}
    for path in sorted(ROOT.rglob("*.py")):
        name = path.relative_to(ROOT).as_posix()
        for call, line in () if name in STAGING else written(path.read_text()):
            found.setdefault((name, call), []).append(line)
    assert {where: lines for where, lines in found.items() if where not in REASONS} == {}
    assert set(REASONS) == set(found), "a reason stands for a call that is no longer there"


@pytest.mark.parametrize(
    "text",
    [
        'open(path, "w")',
        'path.open("wb")',
        'open(path, mode="r+")',
        'gzip.open(path, "xt")',
        'zipfile.ZipFile(path, "a")',
        "path.write_text(words)",
        "figure.savefig(path)",
        "np.save(path, array)",
        "image.to_filename(path)",
        "os.replace(a, b)",
        "part.replace(path)",
        "shutil.rmtree(folder)",
        "path.unlink()",
        "json.dump(data, file)",
        "rmtree(folder)",
    ],
)
def test_calls_that_write_are_seen(text):
    assert len(list(written(text))) == 1


@pytest.mark.parametrize(
    "text",
    [
        'open(path, "rb")',
        "open(path)",
        'words.replace("a", "b")',
        "replace(case, seed=1)",
        "json.dumps(data)",
        "write_text(p, t)",
    ],
)
def test_calls_that_read_are_not(text):
    assert list(written(text)) == []
