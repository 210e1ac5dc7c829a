"""A lesson of two exercises, and six hand-ins of it: three that are right and three that are not."""

import re

import nbformat
from lesson_answers import TEXTS

from cranio_nb.teaching.lesson_text import read_lesson

NAME = "90_small"
FUNCTIONS = {"1.3": "slice_step", "4.1": "apex"}
LESSON = f"""# %% [markdown]
# # A small lesson

# %%
import numpy as np

from cranio_nb.teaching import check

# %% tags=["solution"]
{TEXTS["1.3"]}

# %% tags=["check"]
check.exercise("1.3", slice_step)

# %% tags=["raises-exception"]
raise ValueError("on purpose")

# %% tags=["solution"]
{TEXTS["4.1"]}

# %% tags=["check"]
check.exercise("4.1", apex)
"""
HEADS = {number: TEXTS[number].splitlines()[0] for number in FUNCTIONS}
STUB = "raise NotImplementedError()"
# bodies of both functions, and what each exercise gives for them; a warning costs nothing
HAND_INS = {
    "shipped": (None, None, 3, 3),
    "other_words": (
        "return np.median(np.diff(sorted(positions.dot(normal))))",
        "return k / 8 * (n - 1) * (n - 1)",
        3,
        3,
    ),
    "by_hand": (
        "h = np.sort(positions @ normal); d = np.sort(h[1:] - h[:-1]); m = len(d) // 2; return (d[m] + d[~m]) / 2",
        "import warnings; warnings.warn('noise'); N = n - 1; return k * N / 2 * (N - N / 2) / 2",
        3,
        3,
    ),
    "untouched": (STUB, STUB, 0, 0),
    "partly": ("return np.median(np.diff(np.sort(positions[:, 2])))", "return k * n ** 2 / 8", 2, 0),
    "broken": ("return 1 / 0", "print('no result')", 0, 0),
}


def write_lesson(folder):
    """The lesson as a notebook in a folder of lessons."""
    (folder / "src").mkdir(parents=True)
    (folder / "src" / f"{NAME}.py").write_text(LESSON)
    nbformat.write(read_lesson(folder / "src" / f"{NAME}.py"), folder / f"{NAME}.ipynb")
    return folder


def fill_in(students_copy, student):
    """A students' copy, as a tool made it, with the answers of a student in place of the stubs."""
    notebook = nbformat.read(students_copy, as_version=4)
    for number, body in zip(FUNCTIONS, HAND_INS[student][:2], strict=True):
        (cell,) = (c for c in notebook.cells if c.cell_type == "code" and c.source.startswith(HEADS[number]))
        assert "NotImplementedError" in cell.source and not re.search("solution", cell.source, re.I)
        cell.source = TEXTS[number] if body is None else f"{HEADS[number]}\n    {body}"
    return notebook
