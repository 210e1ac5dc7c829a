"""Answers to exercises as students write them: the shipped solutions, their stubs, and other bodies for their heads."""

import ast
from pathlib import Path

import numpy as np
from scipy import ndimage, spatial
from skimage import measure, morphology

from cranio_nb.curves import cubic, spiral
from cranio_nb.stages import deformable_model
from cranio_nb.teaching import build, check

SOURCES = sorted((Path(__file__).parents[2] / "notebooks" / "src").glob("*.py"))
LIBRARY = {
    "np": np,
    "ndimage": ndimage,
    "spatial": spatial,
    "measure": measure,
    "morphology": morphology,
    "convex_hull_image": morphology.convex_hull_image,
    "cubic": cubic,
    "spiral": spiral,
    "deformable_model": deformable_model,
}
"""What the lessons import, for the functions to use."""


def function(text):
    """The function that a text defines."""
    names = dict(LIBRARY)
    exec(text, names)  # the project's own lesson texts
    return names[ast.parse(text).body[-1].name]


def shipped(stub):
    """Exercise -> the function of its solution cell, or of its stub in the student's copy."""
    found = {}
    for source in SOURCES:
        cells = build.read(source).cells
        for cell in cells:
            if "solution" in build.tags(cell):
                number = build._next_number(cells, cell)
                found[number] = function(build._stub(cell.source, number) if stub else cell.source)
    return found


SOLUTIONS, STUBS = shipped(False), shipped(True)


def written(name, body):
    """The shipped function's head with another body."""
    head = SOLUTIONS[name].__code__
    arguments = ", ".join(head.co_varnames[: head.co_argcount])
    return function(f"def answer({arguments}):\n    {body}")


def listed(wrong):
    """(exercise, body, hint) of every wrong answer, for a test's parameters."""
    return [(name, *answer) for name, answers in wrong.items() for answer in answers]


def judge(name, body):
    """The verdict on a body of an exercise's function."""
    return check.exercise(name, written(name, body))
