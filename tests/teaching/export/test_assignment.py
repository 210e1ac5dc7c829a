"""Assignments are the lessons: every exercise once, the texts unchanged, solutions between the tool's marks only."""

import nbformat
import pytest
from lesson_answers import TEXTS
from lesson_cells import FOLDER, NAMES
from small_course import write_lesson

from cranio_nb.errors import InputRefused
from cranio_nb.teaching.exercises import EXERCISES
from cranio_nb.teaching.export.assignment import assignment, write_assignments
from cranio_nb.teaching.export.nbgrader import NBGRADER
from cranio_nb.teaching.export.otter import OTTER
from cranio_nb.teaching.lesson_text import tags

TOOLS = pytest.mark.parametrize("tool", [NBGRADER, OTTER], ids=["nbgrader", "otter"])


@TOOLS
@pytest.mark.parametrize("name", NAMES)
def test_a_lesson_keeps_its_texts_and_all_its_exercises(tool, name):
    lesson = nbformat.read(FOLDER / f"{name}.ipynb", as_version=4)
    made = assignment(lesson, name, tool)
    nbformat.validate(made)
    texts = [cell.source for cell in made.cells]
    assert not any(cell.get("outputs") for cell in made.cells)
    for cell in lesson.cells:
        assert cell.source in texts or {"solution", "check"} & set(tags(cell))
    wanted = [number for number in EXERCISES if int(number.split(".")[0]) == int(name[:2])]
    for number in wanted:
        assert any(f'check.exercise("{number}", ' in text for text in texts)
        body = TEXTS[number].splitlines()[-1]
        assert sum(body in text for text in texts) == 1


@TOOLS
def test_all_are_written_together_with_what_else_the_tool_wants(tool, tmp_path):
    folder = write_lesson(tmp_path / "lessons")
    made = write_assignments(folder, tmp_path / "course", tool)
    assert all(path.is_file() for path in made) and len(made) == 1 + len(tool.files)
    with pytest.raises(InputRefused, match="no notebooks"):
        write_assignments(tmp_path / "course", tmp_path / "other", tool)
