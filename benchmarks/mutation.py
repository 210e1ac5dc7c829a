"""Mutation score: how many small changes of a module its own tests notice.

python benchmarks/mutation.py [MODULE ...]

Works on a copy of the last commit, so that no changed line is left behind. Needs mutmut: pip install mutmut.
Hours for all modules; name the one you changed. The mutants that survive are listed; many are changes of a message.
"""

import io
import subprocess
import sys
import tarfile
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
MODULES = {
    "readers/dicom/geometry": ["readers/dicom/test_geometry", "readers/dicom/test_duplicates"],
    "readers/dicom/rescale": ["readers/dicom/test_rescale"],
    "readers/dicom/series_groups": ["readers/dicom/test_series_groups", "readers/dicom/test_series_choice"],
    "vault/opening_search": ["vault/test_opening_search"],
    "vault/verdict": ["vault/test_verdict"],
    "output/mesh_files": ["output/test_mesh_files"],
    "output/nifti_files": ["output/test_nifti_files"],
    "evaluation/scores": ["evaluation/test_scores"],
    "evaluation/mesh_distances": ["evaluation/test_mesh_distances"],
}
"""Module of `cranio_nb` -> the tests that are asked."""
WANTED = 0.85


def main() -> None:
    for module in sys.argv[1:] or MODULES:
        results = statuses(module)
        killed = sum(status != "survived" for status in results.values())
        below = "" if killed >= WANTED * len(results) else f", below {WANTED:.0%}"
        print(f"{module}: {killed} of {len(results)} mutants noticed ({killed / len(results):.0%}){below}", flush=True)
        print(*(f"  {name}" for name, status in results.items() if status == "survived"), sep="\n", flush=True)


def statuses(module: str) -> dict[str, str]:
    """Mutant -> what became of it; a mutant that ends no test in time counts as noticed."""
    with tempfile.TemporaryDirectory() as folder:
        packed = subprocess.run(["git", "archive", "HEAD"], cwd=ROOT, capture_output=True, check=True).stdout
        with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
            archive.extractall(folder, filter="data")
        project = Path(folder) / "pyproject.toml"
        project.write_text(project.read_text() + settings(module))
        command = [sys.executable, "-m", "mutmut"]
        subprocess.run([*command, "run", "--max-children", "1"], cwd=folder, check=True, stdout=sys.stderr)
        told = subprocess.run([*command, "results", "--all", "true"], cwd=folder, capture_output=True, text=True)
    pairs = (line.split(": ") for line in told.stdout.splitlines() if "__mutmut_" in line)
    return {name.strip(): status.strip() for name, status in pairs}


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
