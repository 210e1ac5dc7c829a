"""The lessons still say what they say: nbval runs them and compares the stored output of every tagged cell."""

import re

import nbformat
from notebook_runs import LESSONS, ROOT, run

COMPARE = ["--nbval-lax", "--nbval-sanitize-with", str(ROOT / "san.cfg")]
BALLOON = [path for path in LESSONS if path.stem == "04_deformable_model"]


def compared(path):
    cells = nbformat.read(path, as_version=4).cells
    return sum("nbval-check-output" in cell.metadata.get("tags", []) for cell in cells)


def test_every_lesson_gives_its_stored_output(tmp_path):
    said, code = run(COMPARE, LESSONS, tmp_path)
    assert code == 0, said[-4000:]
    assert sum(map(compared, LESSONS)) > 60


def test_a_change_of_one_stage_is_seen(tmp_path):
    (tmp_path / "sitecustomize.py").write_text(
        "import cranio_nb.stages.deformable_model as stage\n"
        "right = stage.tangent_pressure\n"
        "stage.tangent_pressure = lambda *gap: 1.01 * right(*gap)\n"
    )
    said, code = run(COMPARE, BALLOON, tmp_path, PYTHONPATH=str(tmp_path))
    failed = int(re.search(r"(\d+) failed", said)[1])
    assert code == 1 and failed >= 2, said[-4000:]
