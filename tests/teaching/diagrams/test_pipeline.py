"""The drawn pipeline: five stages by the names of their modules, each fed by the one before."""

import ast
from pathlib import Path

import numpy as np
import pytest
from hollow_ball import OUTER, ball

from cranio_nb import stages
from cranio_nb.prosthesis import Prosthesis
from cranio_nb.stages.surface_reconstruction import extract_surface
from cranio_nb.teaching.diagrams import pipeline
from cranio_nb.teaching.diagrams.pipeline import STAGES, walk


@pytest.fixture(scope="module")
def holed():
    return ball(np.array([1.0, 0.1, 0.0]))


def test_the_stages_are_the_modules_in_the_papers_order():
    assert {path.stem for path in Path(stages.__file__).parent.glob("*.py")} - {"__init__"} == set(STAGES)
    places = [ast.get_docstring(ast.parse(Path(stages.__file__).read_text())).find(f"`{name}`") for name in STAGES]
    assert places == sorted(places) and places[0] >= 0


def test_each_stage_works_on_what_the_one_before_made(holed):
    bone, opening = holed
    steps = walk(bone, bone, opening, sum(opening.planes) // 2)
    for ends, curve in zip(steps.ends, steps.curves, strict=True):
        assert curve[[0, -1]] == pytest.approx(ends.points)
    assert steps.patch.any() and not (steps.patch & steps.bone).any()
    # the ball's own curve: as far from its middle as its ends are
    middle = bone.to_voxel(opening.head_centre)[1:]
    radius = np.linalg.norm(steps.curves[0] - middle, axis=1) * bone.spacing[1]
    assert radius == pytest.approx(OUTER, abs=3.0)


def test_the_line_tells_what_is_drawn(holed):
    bone, opening = holed
    mesh = extract_surface(opening.sheet, smooth=False)
    drawn = pipeline(bone, bone, opening, Prosthesis(mesh, np.zeros(len(mesh.faces), np.uint8), None, "by hand"))
    assert f"mesh {len(mesh.faces)} triangles" in drawn.line and len(drawn.png) < 140_000
