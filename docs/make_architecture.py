"""Draw `docs/img/architecture.png`: the folders of the package on their floors, and the data's way through them.

Run it with the package installed: ``python docs/make_architecture.py``. What it draws is read off the folders and off
the order of floors that `tests/test_layers.py` checks; only the data's way is written here.
"""

from __future__ import annotations

import ast
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from matplotlib.patches import FancyBboxPatch

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "cranio_nb"
OUT = ROOT / "docs" / "img" / "architecture.png"

INK, PAPER, STAGE, BLUE = "#222222", "#F4F1EA", "#DCEBF7", "#0072B2"
LEFT, WIDTH, STEP, HIGH = 0.2, 8.9, 0.78, 0.62  # inches: floors, and the distance between them
WAY_LEFT, WAY_WIDTH = 9.55, 2.7  # inches: the data's way beside them

# what passes on, and what makes it; from below, as the floors
WAY = (
    ("scan on disk", ""),
    ("CT in HU", "readers/read"),
    ("bone mask", "stages/segmentation"),
    ("openings, largest first", "vault/opening_search"),
    ("ends of the gap, slice by slice", "stages/feature_extraction"),
    ("balloon at rest: two curves", "stages/deformable_model"),
    ("patch: voxels", "stages/prosthesis_volume"),
    ("closed mesh", "stages/surface_reconstruction"),
    ("Prosthesis", "methods/design"),
    ("measures", "evaluation/scores"),
    ("files and pages", "output/design_folder"),
)


def main() -> None:
    """Draw the picture and write it."""
    floors = floors_from_test()
    figure = Figure(figsize=(12.5, STEP * len(floors) + 0.55), dpi=110)
    FigureCanvasAgg(figure)
    ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
    ax.set(xlim=(0, 12.5), ylim=(0, STEP * len(floors) + 0.55))
    ax.set_axis_off()
    for i, name in enumerate(floors):
        draw_floor(ax, name, modules(name), STEP * i + 0.12)
    draw_way(ax, STEP * len(floors))
    OUT.parent.mkdir(exist_ok=True)
    figure.savefig(OUT, metadata={"Software": None})


def floors_from_test() -> list[str]:
    """The folders from the ground up, as the layers test holds them."""
    tree = ast.parse((ROOT / "tests" / "test_layers.py").read_text())
    values = {node.targets[0].id: node.value for node in tree.body if isinstance(node, ast.Assign)}  # type: ignore[attr-defined]
    return list(ast.literal_eval(values["FLOORS"]))


def modules(folder: str) -> list[str]:
    """Names of the modules and sub-packages of a folder; of the files beside the folders for the nouns."""
    place = PACKAGE if folder == "nouns" else PACKAGE / folder
    files = [path.stem for path in place.glob("*.py") if path.stem != "__init__"]
    inner = [f"{path.name}/" for path in place.iterdir() if (path / "__init__.py").exists()] if place != PACKAGE else []
    return [*listed_first(folder, sorted(files)), *sorted(inner)]


def listed_first(folder: str, names: list[str]) -> list[str]:
    """The stages in the paper's order, as their folder's docstring numbers them; others by name."""
    text = ast.get_docstring(ast.parse((PACKAGE / folder / "__init__.py").read_text())) if folder == "stages" else ""
    return sorted(names, key=lambda name: (text or "").find(f"`{name}`") if f"`{name}`" in (text or "") else 10**6)


def purpose(folder: str) -> str:
    """What a folder is for: the first sentence of its docstring."""
    if folder == "nouns":
        return "What travels between the folders."
    return (ast.get_docstring(ast.parse((PACKAGE / folder / "__init__.py").read_text())) or "").split("\n")[0]


def draw_floor(ax: Axes, name: str, inside: list[str], bottom: float) -> None:
    """One folder as a box with its modules, lines broken where they would leave it."""
    colour = STAGE if name == "stages" else PAPER
    ax.add_patch(FancyBboxPatch((LEFT, bottom), WIDTH, HIGH, boxstyle="round,pad=0.03", fc=colour, ec=INK, lw=0.8))
    label = "the nouns" if name == "nouns" else f"{name}/"
    ax.text(LEFT + 0.1, bottom + HIGH / 2, label, weight="bold", fontsize=11, va="center", color=INK)
    ax.text(LEFT + 1.45, bottom + HIGH - 0.02, purpose(name), fontsize=8.5, style="italic", va="top", color=BLUE)
    ax.text(
        LEFT + 1.45, bottom + 0.04, broken("  ".join(inside)), fontsize=8.5, va="bottom", color=INK, linespacing=1.15
    )


def broken(text: str, longest: int = 104) -> str:
    """Words in lines of at most `longest` letters."""
    lines = [""]
    for word in text.split("  "):
        if len(lines[-1]) + len(word) > longest:
            lines.append("")
        lines[-1] += word + "  "
    return "\n".join(line.rstrip() for line in lines)


def draw_way(ax: Axes, height: float) -> None:
    """The data's way from below to the top, each step with the module that makes it."""
    apart, middle = height / len(WAY), WAY_LEFT + WAY_WIDTH / 2
    ax.text(middle, height + 0.2, "the data's way", weight="bold", fontsize=11, ha="center", color=BLUE)
    for i, (what, maker) in enumerate(WAY):
        y, colour = apart * i + 0.12, STAGE if maker.startswith("stages") else "white"
        box = FancyBboxPatch((WAY_LEFT, y), WAY_WIDTH, 0.56, boxstyle="round,pad=0.03", fc=colour, ec=BLUE, lw=1)
        ax.add_patch(box)
        ax.text(middle, y + (0.39 if maker else 0.28), what, ha="center", va="center", fontsize=9.5, color=INK)
        ax.text(middle, y + 0.14, maker, ha="center", va="center", fontsize=8, color=BLUE)
        if i:
            arrow = {"arrowstyle": "-|>", "color": BLUE, "lw": 1.6}
            ax.annotate("", (middle, y - 0.02), (middle, y - apart + 0.6), arrowprops=arrow)


if __name__ == "__main__":
    main()
