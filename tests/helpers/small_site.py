"""A small project whose one lesson has all that a page can hold, and whose pictures are known in closed form."""

import ast

import nbformat
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook, new_output

from cranio_nb.teaching.lesson_text import METADATA, cell_ids
from cranio_nb.teaching.site import lesson_page, turntable
from cranio_nb.teaching.site.pages import TEXTS

NAME = "00_small"
DRAW = """import numpy as np
from cranio_nb.drawing.described import described
from cranio_nb.drawing.scene3d import show_meshes
from cranio_nb.mesh import Mesh
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.controls import Choice, Slider, Switch, View

def draw(grey, side, wide):
    rgb = np.full((60, 90, 3), grey, np.uint8)
    bar = slice(0, 45 if wide else 15) if side == "left" else slice(45 if wide else 75, 90)
    rgb[:, bar] = (0, 114, 178)
    return View(rgb, f"grey {grey}, a {'wide' if wide else 'narrow'} bar at the {side} of it <1>")"""
MOVE = """## Move

Try `panel.set(grey=70)`.

<details>
<summary>Answer</summary>

It brightens.

</details>"""
PANEL = """controls = (
    Slider("grey", "grey of it", 0, 100, 50, 10, unit="levels", player=True),
    Choice("side", "side", ("left", "right"), "left"),
    Switch("wide", "wide bar", False),
)
presets = {"light": {"grey": 100}}
panel = widgets.Panel(controls, draw, alt="A blue bar on grey <box>.", presets=presets)
panel"""
SCENE = """corners = np.array([[0.0, 0, 0], [30, 0, 0], [0, 40, 0], [0, 0, 50]])
solid = Mesh(corners, np.array([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]))
show_meshes(solid, alt="A tetrahedron.", labels=["solid"])"""
FIGURE = 'described(np.zeros((4, 6, 3), np.uint8), "A black <box>.", "black, 6 x 4 px")'
ANSWER = 'def twice(x):\n    "Two times x."\n    return 2 * x'


def lesson():
    """The lesson as it ran; one of its cells cannot be run and nothing needs it."""
    cells = [
        new_markdown_cell("# Small lesson\n\nThe apex is $k N^2 / 8$."),
        new_code_cell("# On Colab this installs the package; elsewhere it does nothing."),
        new_code_cell(DRAW),
        new_code_cell("1 / 0", metadata={"tags": ["raises-exception"]}),
        new_markdown_cell(MOVE),
        new_code_cell(PANEL),
        new_code_cell(SCENE),
        new_code_cell(FIGURE),
        new_code_cell(ANSWER, metadata={"tags": ["solution"]}),
    ]
    names = {}
    for number, (cell, name) in enumerate(zip(cells, cell_ids(cells), strict=True)):
        cell.id = name
        if cell.cell_type == "code" and cell.source != "1 / 0":
            cell.execution_count = number
            cell.outputs = outputs_of(cell.source, names)
    return new_notebook(cells=cells, metadata=METADATA)


def outputs_of(source, names):
    """What a kernel would store of a cell's last expression."""
    if not (statements := ast.parse(source).body):
        return []
    *body, end = statements
    exec(compile(ast.Module(body, []), "cell", "exec"), names)
    if not isinstance(end, ast.Expr):
        exec(compile(ast.Module([end], []), "cell", "exec"), names)
        return []
    data, metadata = eval(compile(ast.Expression(end.value), "cell", "eval"), names)._repr_mimebundle_()
    data = nbformat.from_dict(data | {"image/png": base64(data["image/png"])})
    return [new_output("execute_result", data, metadata=nbformat.from_dict(metadata), execution_count=1)]


def base64(data):
    import base64 as library

    return library.b64encode(data).decode()


def few_views(patched):
    """Scenes seen from all round but from one height: a quarter of their pictures."""
    patched.setattr(lesson_page, "all_round", lambda panel: turntable.all_round(panel)[:1])


def write_project(folder):
    """The project's folder: texts, docs and the lesson with its copy for students."""
    for name in TEXTS:
        (folder / name).write_text(f"# {name}\n\nWords; see [how](docs/how.md) and [licence](LICENSE).\n")
    (folder / "docs").mkdir()
    (folder / "docs" / "how.md").write_text("# How to sharpen\n\nWith a whetstone.\n")
    for home in (folder / "notebooks", folder / "notebooks" / "exercises"):
        home.mkdir()
        nbformat.write(lesson(), home / f"{NAME}.ipynb")
    return folder
