"""Draw the pictures of README and docs again: `python docs/make_pictures.py`. All that they show is synthetic.

With names (`python docs/make_pictures.py balloon.gif`) only those of `PICTURES`. Each drawing keeps in its file what it
was drawn from and by which code: `tests/test_docs_pictures.py` asks both.
"""

import ast
import hashlib
import io
import json
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray
from PIL import Image
from PIL.PngImagePlugin import PngInfo

import cranio_nb as cn
from cranio_nb.drawing import figures
from cranio_nb.drawing.coarse_skull import skull_surface
from cranio_nb.drawing.described import Described
from cranio_nb.mesh import Mesh
from cranio_nb.methods.slicewise.slices import SlicedDesign
from cranio_nb.opening import Opening
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import RunResult, run_design
from cranio_nb.teaching import classroom, diagrams
from cranio_nb.teaching.diagrams.film import balloon_film
from cranio_nb.volume import Volume
from data_synth import head_case
from data_synth.files import write_case

IMG = Path(__file__).parent / "img"
NOTHING = Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
PX = 0.5  # mm
VIEW = np.array([1.0, -0.35, 0.15])  # from the left and a little from the front
FOLLOW = {"skip_px": 3.0, "reach_px": 10.0}  # along the bone, as in lessons 00 and 04


def main(names: list[str]) -> None:
    """Draw the pictures of these names, or all."""
    IMG.mkdir(exist_ok=True)
    for name in names or PICTURES:
        (IMG / name).write_bytes(PICTURES[name]())


def drawn_by() -> str:
    """Digest of the code that draws the lessons' diagrams; comments, layout and docstrings do not change it."""
    digest = hashlib.sha256()
    for path in sorted(Path(diagrams.__file__).parent.glob("*.py")):
        tree = ast.parse(path.read_text("utf-8"))
        for node in ast.walk(tree):
            if isinstance(node, (ast.Module, ast.FunctionDef, ast.ClassDef)) and ast.get_docstring(node):
                node.body = node.body[1:]
        digest.update(ast.dump(tree).encode())
    return digest.hexdigest()


@cache
def lesson_head() -> tuple[classroom.LessonCase, Volume, tuple[Opening, ...]]:
    """The head of the lessons, its bone and its openings."""
    case = classroom.synthetic("class")
    bone = cn.segment(case.ct)
    return case, bone, cn.find_openings(bone)


def pipeline() -> bytes:
    """The five stages, as lesson 00 shows them."""
    case, bone, openings = lesson_head()
    return with_source(diagrams.pipeline(case.ct, bone, openings[0], cn.design(bone, openings)))


def legend() -> bytes:
    """What the marks of the drawings mean."""
    return with_source(diagrams.legend())


def balloon() -> bytes:
    """The balloon in the gap of lessons 00 and 04, from the chord to its rest."""
    case, bone, (opening, *_) = lesson_head()
    plane = classroom.bridged_plane(bone, opening, **FOLLOW)
    ends, _ = classroom.gap_ends(bone, opening, plane, **FOLLOW)
    inside = bone.to_voxel(opening.head_centre)[1:]
    gap = diagrams.Gap(ends, inside, bone.voxels[plane], case.px, case.true_curves(plane)[0])
    return balloon_film(gap, drawn_by=drawn_by())


def with_source(made: Described) -> bytes:
    """A drawing as PNG that says what it shows and by which code it was drawn."""
    facts = PngInfo()
    facts.add_text("Description", json.dumps({"line": made.line, "drawn_by": drawn_by()}))
    stream = io.BytesIO()
    Image.open(io.BytesIO(made.png)).save(stream, format="PNG", optimize=True, pnginfo=facts)
    return stream.getvalue()


def result() -> bytes:
    """What `cranio-nb demo` designs: skull, prosthesis and one slice side by side."""
    with TemporaryDirectory() as folder:
        write_case(Path(folder), head_case("face", "full", "unilateral", 0))
        made = run_design(prepare(Path(folder) / "ct"))
    return figures.png(side_by_side([*views(made), middle_slice(made)]))


def views(result: RunResult) -> list[Figure]:
    """The skull with its opening, and closed."""
    skull = skull_surface(result.case.bone)
    return [figures.view_figure(skull, mesh, VIEW, px_mm=PX) for mesh in (NOTHING, result.prosthesis.mesh)]


def middle_slice(result: RunResult) -> Figure:
    """The middle slice, with the boundaries, their ends and tangents, the curves and the patch."""
    sliced = next(part for part in result.prosthesis.working if isinstance(part, SlicedDesign))
    one = sliced.slices[len(sliced.slices) // 2]
    return figures.slice_figure(sliced, one, result.case.bone, result.prosthesis.patch)


def side_by_side(parts: list[Figure]) -> Figure:
    """Finished figures in a row, each in the middle of its height."""
    pictures = [pixels(figure) for figure in parts]
    height = max(len(picture) for picture in pictures)
    row = np.concatenate([centred(picture, height) for picture in pictures], axis=1)
    figure, ax = figures.new_figure(row.shape[1] / figures.DPI, height / figures.DPI)
    ax.imshow(row, interpolation="nearest", aspect="auto")
    return figure


def pixels(figure: Figure) -> NDArray[np.uint8]:
    """What a figure shows, shape (H, W, 3)."""
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[..., :3]  # type: ignore[attr-defined]


def centred(picture: NDArray[np.uint8], height: int) -> NDArray[np.uint8]:
    """A picture with white above and below."""
    spare = height - len(picture)
    return np.pad(picture, ((spare // 2, spare - spare // 2), (0, 0), (0, 0)), constant_values=255)


PICTURES: dict[str, Callable[[], bytes]] = {
    "result.png": result,
    "pipeline.png": pipeline,
    "legend.png": legend,
    "balloon.gif": balloon,
}

if __name__ == "__main__":
    main(sys.argv[1:])
