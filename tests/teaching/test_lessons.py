"""The texts of the lessons: few imports, one name for lesson, panels, exercises and stage, no word of what is gone."""

import ast
import importlib
import re
from pathlib import Path

import pytest

from cranio_nb.teaching import exercises, widgets
from cranio_nb.teaching.lesson_text import read_lesson

ROOT = Path(__file__).parents[2]
SOURCES = sorted((ROOT / "notebooks" / "src").glob("*.py"))
NAMES = [source.stem for source in SOURCES]
STAGES = sorted(path.stem for path in (ROOT / "cranio_nb" / "stages").glob("[a-z]*.py"))


@pytest.fixture(params=SOURCES, ids=NAMES)
def lesson(request):
    return request.param


def imports(text):
    return [node for node in ast.walk(ast.parse(text)) if isinstance(node, ast.Import | ast.ImportFrom)]


def test_a_lesson_has_three_to_five_import_lines(lesson):
    lines = [ast.unparse(node) for node in imports(lesson.read_text())]
    assert 3 <= len(lines) <= 5 and "import cranio_nb as cn" in lines, lines


def test_a_lesson_imports_the_stage_it_teaches(lesson):
    topic = lesson.stem[3:]
    wanted = {alias.name for node in imports(lesson.read_text()) for alias in node.names}
    assert topic not in STAGES or topic in wanted


def test_each_stage_has_a_lesson_panels_and_exercises_of_its_name():
    topics = [name[3:] for name in NAMES]
    assert [topic for topic in topics if topic in STAGES] == [
        "segmentation",
        "feature_extraction",
        "deformable_model",
        "prosthesis_volume",
        "surface_reconstruction",
    ]
    for number, topic in enumerate(topics):
        tasks = importlib.import_module(f"{exercises.__name__}.{topic}").EXERCISES
        assert tasks and all(task.split(".")[0] == str(number) for task in tasks), topic
    for stage in STAGES:
        importlib.import_module(f"{widgets.__name__}.{stage}")


def test_every_name_that_a_lesson_puts_in_code_font_with_a_module_is_there(lesson):
    text = "\n".join(cell.source for cell in read_lesson(lesson).cells if cell.cell_type == "markdown")
    for module, name in set(re.findall(r"`(\w+)\.(\w+)[`(]", text)):
        homes = [path for path in (ROOT / "cranio_nb").rglob(f"{module}.py") if "teaching" not in path.parts]
        assert not homes or any(re.search(rf"\b{name}\b", home.read_text()) for home in homes), f"{module}.{name}"


def test_a_picture_of_a_head_has_its_sides_a_scale_and_a_key(lesson):
    """Slices in mm are drawn on `pictures.slices`, and masks are named below them or in a legend."""
    for cell in read_lesson(lesson).cells:
        draws = {name for name in ("show_hu", "show_mask", "show_errors") if f"pictures.{name}(" in cell.source}
        if cell.cell_type == "code" and draws:
            assert "pictures.slices(" in cell.source or "px=1," in cell.source, cell.source
            assert draws == {"show_hu"} or "pictures.key(" in cell.source or ".legend(" in cell.source, cell.source
