"""The import rule, read off the folders: imports go down only, siblings are strangers, libraries have owners."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import cranio_nb

ROOT = Path(cranio_nb.__file__).parent
WITNESS = ROOT.parent / "data_synth"

FLOORS = [  # a folder imports only what stands above it in this list; the nouns are the files beside the folders
    "nouns",
    "options",
    "geometry",
    "readers",
    "stages",
    "vault",
    "prior",
    "methods",
    "evaluation",
    "implant",
    "drawing",
    "pipeline",
    "output",
    "study",
    "teaching",
    "cli",
]
LIGHT = FLOORS[: FLOORS.index("implant") + 1]  # these load no heavy library
HEAVY = (
    "vtk",
    "vtkmodules",
    "pyvista",
    "matplotlib",
    "anywidget",
    "ipywidgets",
    "nibabel",
    "nrrd",
    "trimesh",
    "IPython",
)
OWNERS = {"matplotlib": "drawing.figures.axes", "pyvista": "drawing.scene3d", "anywidget": "teaching.widgets.live"}
SHARED_BY_METHODS = {"catalogue", "piece", "transfer"}


def module_name(path):
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(p for p in parts if p != "__init__")


MODULES = {module_name(path): path for path in sorted(ROOT.rglob("*.py"))}


def imports_of(path):
    """Dotted names a file imports, also inside functions; those of this package as its modules, without its name."""
    package = ("cranio_nb", *path.relative_to(ROOT).parent.parts) if path.is_relative_to(ROOT) else ()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = ".".join([*package[: len(package) - node.level + 1], *([node.module] if node.module else [])])
            start = base if node.level else node.module
            found = [f"{start}.{alias.name}" for alias in node.names]
        else:
            continue
        yield from (_module(name) if name.split(".")[0] == "cranio_nb" else name for name in found)


def _module(name):
    """The module of this package that an imported name is, or stands in."""
    inside = name.removeprefix("cranio_nb").removeprefix(".")
    return inside if inside in MODULES else inside.rpartition(".")[0]


def floor(module):
    """Place of a module in `FLOORS`; the package itself and its command line stand above all."""
    if module in ("", "__main__"):
        return len(FLOORS)
    first = module.split(".")[0]
    return FLOORS.index(first) if (ROOT / first).is_dir() else 0


def inner(path):
    """The modules of this package that a file imports."""
    return {name for name in imports_of(path) if name in MODULES}


def test_the_floors_are_the_folders():
    folders = {path.name for path in ROOT.iterdir() if path.is_dir() and path.name != "__pycache__"}
    assert folders == set(FLOORS) - {"nouns"}


def test_few_files_lie_beside_the_folders():
    assert len({path.name for path in ROOT.glob("*.py")} - {"__init__.py"}) <= 8


@pytest.mark.parametrize("name", MODULES)
def test_imports_go_down_only(name):
    too_high = {other for other in inner(MODULES[name]) if floor(other) > floor(name)}
    assert not too_high, f"{name} imports {sorted(too_high)}, which stand above it in FLOORS"


def test_no_modules_import_each_other_in_a_circle():
    wanted = {name: inner(path) - {name} for name, path in MODULES.items()}
    while free := [name for name, needs in wanted.items() if not needs & wanted.keys()]:
        for name in free:
            del wanted[name]
    assert not wanted, "each of these imports another of them, or one that does"


def test_stages_do_not_know_each_other():
    for name, path in MODULES.items():
        if name.startswith("stages."):
            assert not {other for other in inner(path) if other.split(".")[0] == "stages"}, name


def test_methods_do_not_know_each_other():
    for name, path in MODULES.items():
        if name.startswith("methods."):
            own = name.split(".")[1]
            others = {other.split(".")[1] for other in inner(path) if other.startswith("methods.")}
            assert own in SHARED_BY_METHODS or others <= {own} | SHARED_BY_METHODS, name


@pytest.mark.parametrize("library", OWNERS)
def test_a_drawing_library_has_one_owner(library):
    users = {name for name, path in MODULES.items() if library in {i.split(".")[0] for i in imports_of(path)}}
    assert users == {OWNERS[library]}


def test_the_rule_sees_what_it_judges():
    assert "curves" in inner(MODULES["stages.deformable_model"])
    assert "volume" in inner(MODULES["readers.dicom.read"])
    assert floor("cli.main") > floor("methods.slicewise") > floor("stages.segmentation") > floor("volume") == 0


def test_the_witness_knows_nothing_of_the_package():
    files = list(WITNESS.rglob("*.py"))
    assert files
    for path in files:
        assert "cranio_nb" not in path.read_text(), path.name


def test_what_computes_loads_no_heavy_library():
    names = [f"cranio_nb.{name}" for name in MODULES if name and floor(name) < len(LIGHT)]
    code = f"import importlib, sys; [importlib.import_module(m) for m in {names!r}]; print(*sorted(sys.modules))"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {module.split(".")[0] for module in run.stdout.split()}
    assert "scipy" in loaded and "cranio_nb" in loaded
    assert not loaded & set(HEAVY)


def test_the_package_itself_brings_its_reader_and_nothing_heavier_than_numpy():
    code = "import sys, cranio_nb; assert callable(cranio_nb.read_ct); print(*sys.modules)"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    loaded = {name.split(".")[0] for name in run.stdout.split()}
    assert "numpy" in loaded
    assert not loaded & {*HEAVY, "scipy", "skimage", "pydicom"}


def test_matplotlib_is_loaded_with_the_first_figure():
    code = (
        "import sys, cranio_nb.output.design_page as p; assert 'matplotlib' not in sys.modules;"
        "p.figures.new_figure(1.0, 1.0); assert 'matplotlib' in sys.modules"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_only_volume_and_the_readers_know_the_affine():
    """Everything else asks a `Volume`; in the exercises the learner writes the formula."""
    free = {"volume", "grid", "teaching.exercises.ct", "teaching.exercises.image"}
    for name, path in MODULES.items():
        if name not in free and not name.startswith("readers."):
            text = path.read_text()
            assert "affine[:3" not in text and "linalg.inv(affine" not in text, name
