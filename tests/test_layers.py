"""The import rule: nouns know no stage, stages and methods do not know each other, libraries stay where they belong."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

import cranio_nb

ROOT = Path(cranio_nb.__file__).parent
WITNESS = ROOT.parent / "data_synth"

NOUNS = {"errors", "volume", "curves", "maps", "mesh", "prosthesis"}
MESH_WORK = {"nearest", "crossings", "mesh_check", "tetrahedra", "solid", "membrane"}  # geometry of triangle meshes
STAGES = {
    "readers",
    "segment",
    "lesion",
    "features",
    "balloon",
    "fill",
    "surface",
    "evaluate",
    "export",
    "implant",
    "fit",
}
# stage 2 for real skulls, and whom each may see
VAULT = {"casting": set(), "chart": {"casting"}, "symmetry": set(), "rays": set(), "slicing": {"chart", "rays"}}
SHEETS = {"sheet": set(), "sheet_motion": {"sheet"}}  # elastic surfaces
LEARNED = {  # from other skulls, and whom each may see
    "headframe": {"lesion"},
    "vaultmap": {"headframe", "casting"},
    "prior": {"headframe", "chart", "vaultmap"},
    "prior_file": {"headframe", "prior", "vaultmap"},
}
ASSEMBLY = {"assembly": {"surface"}}  # the last step of every method
CORE = NOUNS | MESH_WORK | set(SHEETS) | STAGES | set(VAULT) | set(LEARNED) | set(ASSEMBLY)
OWNERS = {"matplotlib": {"plot"}, "pyvista": {"view3d"}, "ipywidgets": {"widgets.live"}}
HEAVY = ("vtk", "vtkmodules", "pyvista", "matplotlib", "ipywidgets", "nibabel", "nrrd", "trimesh", "IPython")


def module_name(path):
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(p for p in parts if p != "__init__") or "cranio_nb"


def imports_of(path):
    """Dotted names a file imports, also inside functions; those of this package without its name."""
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
        yield from (name.removeprefix("cranio_nb.") for name in found)


MODULES = {module_name(path): path for path in sorted(ROOT.rglob("*.py"))}
ROOMS = {name: name.split(".")[0] for name in MODULES}


def rooms_seen(name):
    """Rooms of the package that a module imports from, without its own."""
    known = set(ROOMS.values()) - {"cranio_nb"}
    return {found.split(".")[0] for found in imports_of(MODULES[name])} & known - {ROOMS[name]}


def allowed(name):
    room = ROOMS[name]
    if room in NOUNS:
        return NOUNS
    if room in MESH_WORK:
        return NOUNS | MESH_WORK
    if room in VAULT:
        return NOUNS | VAULT[room]
    if room in SHEETS:
        return NOUNS | SHEETS[room]
    if room in LEARNED:
        return NOUNS | LEARNED[room]
    if room in ASSEMBLY:
        return NOUNS | ASSEMBLY[room]
    if room in STAGES:
        return NOUNS | MESH_WORK
    if room == "methods":
        return CORE
    return set(ROOMS.values())


@pytest.mark.parametrize("name", MODULES)
def test_imports_go_down_only(name):
    too_high = rooms_seen(name) - allowed(name)
    assert not too_high, f"{name} imports {sorted(too_high)}; a new core module states its room at the top of this file"


def test_the_rule_sees_what_it_judges():
    assert CORE <= set(ROOMS.values())
    assert {"curves"} <= rooms_seen("balloon") and {"lesion", "curves"} <= rooms_seen("methods.slicewise")
    assert "volume" in rooms_seen("readers.dicom")


def test_methods_do_not_import_each_other():
    for name, path in MODULES.items():
        if name.startswith("methods."):
            others = {found for found in imports_of(path) if found.split(".")[0] == "methods"}
            assert not others, name


@pytest.mark.parametrize(
    "library",
    [
        "matplotlib",
        "pyvista",
        "ipywidgets",
    ],
)
def test_a_drawing_library_has_its_own_module(library):
    users = {name for name, path in MODULES.items() if library in {i.split(".")[0] for i in imports_of(path)}}
    assert users <= OWNERS[library]


def test_the_witness_knows_nothing_of_the_package():
    files = list(WITNESS.rglob("*.py"))
    assert files
    for path in files:
        assert "cranio_nb" not in path.read_text(), path.name


def test_the_core_loads_no_heavy_library():
    core = [f"cranio_nb.{name}" for name in MODULES if ROOMS[name] in CORE | {"methods"}]
    code = f"import importlib, sys; [importlib.import_module(m) for m in {core!r}]; print(*sorted(sys.modules))"
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
