"""Mutation score: how many small changes of a module its own tests notice.

python benchmarks/mutation.py [MODULE ...]

Works on a copy of the last commit, so that no changed line is left behind. Needs mutmut: pip install mutmut.
Hours for all modules; name the one you changed. The mutants that survive are listed. Lambdas and constants of a module
are not mutated.

Two scores are given: over all mutants, and without those that change nothing but capitals or marks of prose, that is of
a string with a space between words. Tests ask a message for what it found, wanted and advises, not for its wording.
"""

import ast
import io
import subprocess
import sys
import tarfile
import tempfile
from collections.abc import Collection
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODULES = {
    "readers/dicom/geometry": ["readers/dicom/test_geometry"],
    "readers/dicom/rescale": ["readers/dicom/test_rescale"],
    "readers/dicom/series_groups": ["readers/dicom/test_series_groups"],
    "vault/opening_choice": ["vault/test_opening_choice"],
    "vault/opening_search": ["vault/test_opening_search_steps", "vault/test_opening_search"],
    "vault/verdict": ["vault/test_verdict"],
    "output/mesh_files": ["output/test_mesh_files"],
    "output/nifti_files": ["output/test_nifti_files"],
    "evaluation/scores": ["evaluation/test_scores"],
    "evaluation/mesh_distances": ["evaluation/test_mesh_distances"],
}
"""Module of `cranio_nb` -> the tests that are asked: its own."""
WANTED = 0.85
NOTICED = {"killed", "timeout", "segfault"}
"""A mutant that ends no test in time or ends Python is noticed; one that no test runs is not."""


def main() -> None:
    for module in sys.argv[1:] or MODULES:
        results, prose = statuses(module)
        survived = [name for name, status in results.items() if status not in NOTICED]
        scores = [share(results.keys(), survived), share(results.keys() - prose, survived)]
        below = "" if scores[1] >= WANTED else f", below {WANTED:.0%}"
        print(f"{module}: {len(results) - len(survived)} of {len(results)} mutants noticed ({scores[0]:.0%});", end=" ")
        print(f"without {len(prose)} of prose {scores[1]:.0%}{below}", flush=True)
        print(*(f"  {name}{' (prose)' * (name in prose)}" for name in survived), sep="\n", flush=True)


def share(mutants: Collection[str], survived: list[str]) -> float:
    """Share of the mutants that were noticed."""
    return 1 - len(set(survived) & set(mutants)) / len(mutants)


def statuses(module: str) -> tuple[dict[str, str], set[str]]:
    """Mutant -> what became of it, and those of prose."""
    with tempfile.TemporaryDirectory() as folder:
        packed = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, capture_output=True, check=True).stdout
        with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
            archive.extractall(folder, filter="data")
        project = Path(folder) / "pyproject.toml"
        project.write_text(project.read_text() + settings(module))
        command = [sys.executable, "-m", "mutmut"]
        subprocess.run([*command, "run", "--max-children", "1"], cwd=folder, check=True, stdout=sys.stderr)
        told = subprocess.run([*command, "results", "--all", "true"], cwd=folder, capture_output=True, text=True)
        prose = prose_mutants((Path(folder) / f"mutants/cranio_nb/{module}.py").read_text())
    pairs = (line.split(": ") for line in told.stdout.splitlines() if "__mutmut_" in line)
    results = {name.strip(): status.strip() for name, status in pairs}
    return results, {name for name in results if name.rpartition(".")[2] in prose}


def prose_mutants(source: str) -> set[str]:
    """Mutated functions that equal their original but for capitals and marks of prose."""
    functions = {node.name: node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)}
    plain = {name: _without_prose(node) for name, node in functions.items() if "__mutmut_" in name}
    return {name for name, text in plain.items() if not name.endswith("_orig") and text == plain[_original(name)]}


def _original(name: str) -> str:
    return name.rpartition("_")[0] + "_orig"


def _without_prose(function: ast.FunctionDef) -> str:
    """A function as text, its name and its prose left out; prose has a space between words."""
    function.name = ""
    for node in ast.walk(function):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value.strip("X "):
            node.value = ""
    return ast.dump(function)


def settings(module: str) -> str:
    tests = [f"tests/{test}.py" for test in MODULES[module]]
    return f"""
[tool.mutmut]
source_paths = ["cranio_nb/{Path(module).parent}"]
only_mutate = ["cranio_nb/{module}.py"]
pytest_add_cli_args_test_selection = {tests}
pytest_add_cli_args = ["-m", "not real"]
also_copy = ["cranio_nb", "data_synth", "tests"]
"""


if __name__ == "__main__":
    main()
