"""What the project says of itself is true: dependencies, pins, README, citation, check script."""

import ast
import itertools
import re
import shlex
import subprocess
import sys
import tomllib
from importlib.metadata import PackageNotFoundError, packages_distributions, requires, version
from pathlib import Path

import pytest
import yaml
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.utils import canonicalize_name

import cranio_nb
from cranio_nb.cli.examination import examine
from cranio_nb.cli.main import main
from cranio_nb.methods import catalogue
from cranio_nb.output.design_folder import FILES
from data_synth import phantom_case
from data_synth.files import write_case

ROOT = Path(__file__).parent.parent
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
CORE = [Requirement(line) for line in PROJECT["project"]["dependencies"]]
EXTRAS = {
    name: [Requirement(line) for line in lines] for name, lines in PROJECT["project"]["optional-dependencies"].items()
}
EVERY = [*CORE, *itertools.chain.from_iterable(EXTRAS.values())]
README = (ROOT / "README.md").read_text()
PINS = [line for line in (ROOT / "constraints.txt").read_text().splitlines() if not line.startswith("#")]

ON_BEHALF = {"networkx", "lxml", "pyjpegls"}  # asked for by trimesh and pydicom when they do our work
MACHINE_PATH = re.compile(r"(?<![\w.~])/(home|root|work|tmp|Users|opt|mnt|srv)/\w")
# a doi is a citation, the loopback address is on every machine, and the site leads to two services that run notebooks
KNOWN_HOST = r"doi\.org/|127\.0\.0\.1\b|localhost\b|mybinder\.org/|colab\.research\.google\.com/"
HOST = re.compile(rf"\b(?:https?|ftp|file|ssh|git)://(?!{KNOWN_HOST})[\w.]*")


def name_of(requirement):
    return canonicalize_name(requirement.name)


def pinned():
    return {canonicalize_name(line.split("==")[0]): line.split("==")[1] for line in PINS}


def code_lines(text):
    """Command lines of the bash blocks of a page."""
    return [line for block in re.findall(r"```bash\n(.*?)```", text, re.S) for line in block.splitlines() if line]


def installed_below(requirements):
    """Names of requirements and of all that they need in turn, as far as they are installed here as pinned."""
    found, waiting = set(), list(requirements)
    while waiting:
        one = waiting.pop()
        key = (name_of(one), frozenset(one.extras))
        if key in found:
            continue
        found.add(key)
        try:
            as_pinned = version(one.name) == pinned().get(name_of(one))
        except PackageNotFoundError:
            continue
        needs = [Requirement(line) for line in requires(one.name) or ()] if as_pinned else []
        waiting += [n for n in needs if wanted(n, one.extras)]
    return {name for name, _ in found}


def wanted(requirement, extras):
    marker = requirement.marker
    return marker is None or any(marker.evaluate({"extra": extra}) for extra in ("", *extras))


def imported(folder):
    """Names of the packages that the modules below a folder import, at any place."""
    for path in (ROOT / folder).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Import):
                yield from (alias.name.split(".")[0] for alias in node.names)
            elif isinstance(node, ast.ImportFrom) and not node.level:
                yield node.module.split(".")[0]


def distributions(modules):
    """Canonical names of what has to be installed for these modules; those of Python and of this project have none."""
    owners = packages_distributions()
    ours = {"cranio_nb", "data_synth", *sys.stdlib_module_names}
    return {canonicalize_name(owners[m][0] if m in owners else m) for m in set(modules) - ours}


class TestDependencies:
    def test_what_is_imported_is_declared_and_what_is_declared_is_imported(self):
        optional = {name_of(r) for extra in ("lab", "view", "site", "study") for r in EXTRAS[extra]}
        core = {name_of(r) for r in CORE}
        used = distributions([*imported("cranio_nb"), *imported("data_synth")])
        assert used <= core | optional
        assert core == (used - optional) | ON_BEHALF

    def test_tests_import_what_they_declare(self):
        declared = {name_of(r) for r in [*CORE, *EXTRAS["test"]]}
        local = {path.stem for path in (ROOT / "tests").rglob("*")}
        assert distributions(set(imported("tests")) - local) <= declared

    def test_each_bound_is_explained(self):
        lines = (ROOT / "pyproject.toml").read_text().splitlines()
        bounds = [line for line in lines if re.match(r'\s+"[\w.\[\]-]+>=', line)]
        assert len(bounds) == len(CORE) + sum(map(len, EXTRAS.values()))
        assert all(re.search(r'",\s+# \w', line) for line in bounds)

    def test_doctor_looks_at_each(self):
        looked_at = {check.name for check in itertools.takewhile(lambda check: check.name != "free memory", examine())}
        assert {r.name for r in CORE} <= looked_at

    def test_packages_and_their_files_are_installed(self):
        code = [path for top in ("cranio_nb", "data_synth") for path in (ROOT / top).rglob("*.py")]
        assert all((path.parent / "__init__.py").exists() for path in code)
        wanted_packages = PROJECT["tool"]["setuptools"]["packages"]["find"]["include"]
        assert wanted_packages == ["cranio_nb*", "data_synth*"]
        data = PROJECT["tool"]["setuptools"]["package-data"]
        taken = {
            path
            for package, patterns in data.items()
            for pattern in patterns
            for path in (ROOT / package.replace(".", "/")).glob(pattern)
        }
        extra = {p for p in (ROOT / "cranio_nb").rglob("*") if p.is_file() and "__pycache__" not in p.parts}
        assert {p for p in extra if p.suffix != ".py"} == taken


class TestPins:
    def test_are_names_and_versions_only(self):
        assert PINS and all(re.fullmatch(r"[\w.-]+==[\w.+!]+", line) for line in PINS)

    def test_agree_with_the_bounds(self):
        for requirement in EVERY:
            assert pinned()[name_of(requirement)] in requirement.specifier, requirement

    def test_cover_all_that_these_need_in_turn(self):
        needed = installed_below(EVERY)
        assert needed > {name_of(r) for r in CORE}
        assert needed <= set(pinned())

    def test_conda_environment_is_in_step(self):
        environment = yaml.safe_load((ROOT / "environment.yml").read_text())
        python, installer, by_pip = environment["dependencies"]
        assert environment["name"] == PROJECT["project"]["name"] and environment["channels"][0] == "conda-forge"
        assert python.removeprefix("python=") in SpecifierSet(PROJECT["project"]["requires-python"])
        pins, ours = by_pip["pip"]
        assert (installer, pins) == ("pip", "-c constraints.txt")
        extras = re.fullmatch(r"-e \.\[([\w,]+)\]", ours)[1].split(",")
        assert set(extras) == set(EXTRAS) - {"dev"}  # these name every dependency


class TestReadme:
    def test_exactly_two_commands_set_up_and_are_one_line_each(self):
        setting_up = [line for line in README.splitlines() if "-m venv" in line]
        assert setting_up == [line for line in code_lines(README) if "-m venv" in line]
        assert len(setting_up) == 2
        assert all("pip install -q -c constraints.txt " in line for line in setting_up)
        assert setting_up[0].endswith("cranio-nb demo") and "pytest" in setting_up[1]

    def test_says_early_that_it_is_not_for_clinical_use(self):
        assert "**Not for clinical use.**" in README[:800]

    def test_pictures_are_there_light_and_described(self):
        pictures = re.findall(r"!\[(.*?)\]\((.*?)\)", README, re.S)
        assert len(pictures) == 3
        for alt, path in pictures:
            picture = (ROOT / path).read_bytes()
            assert picture.startswith((b"\x89PNG", b"GIF89a")) and len(picture) < 300_000 and len(alt.split()) > 20

    def test_links_lead_somewhere(self):
        headings = {heading.lower().replace(" ", "-") for heading in re.findall(r"^## (.*)", README, re.M)}
        for target in re.findall(r"\]\(([^)]+)\)", README):
            assert target[1:] in headings if target.startswith("#") else (ROOT / target).exists()

    @pytest.mark.parametrize("line", [line for line in code_lines(README) if "cranio-nb " in line])
    def test_commands_exist_with_their_options(self, line):
        command, *arguments = shlex.split(line.split("&&")[-1])[1:]
        context = main.commands[command].make_context(command, arguments)
        assert context.params

    def test_names_in_the_symbol_table_exist(self):
        rows = re.findall(r"^\| [^|]+ \| (`[^|]+) \| `[^|]+ \| [^|]+ \|$", README, re.M)
        assert len(rows) > 15
        source = "\n".join(path.read_text() for path in (ROOT / "cranio_nb").rglob("*.py"))
        words = set(re.findall(r"\w+", source))
        for name in re.findall(r"`([\w.]+)`", " ".join(rows)):
            assert set(name.split(".")) <= words, name


class TestCheckScript:
    script = ROOT / ".ci" / "run"

    def test_runs_the_readmes_own_test_command(self):
        text = self.script.read_text()
        (taking,) = re.findall(r"^command=.*$", text, re.M)
        asked = subprocess.run(
            ["bash", "-c", f'{taking}; printf %s "$command"'], cwd=ROOT, capture_output=True, text=True, check=True
        )
        (command,) = (line for line in code_lines(README) if "-m venv" in line and "pytest" in line)
        assert asked.stdout == command
        assert 'bash -c "$command"' in text.splitlines()

    def test_runs_the_numerics_on_three_kernels(self):
        assert ".venv/bin/python benchmarks/kernels.py" in self.script.read_text().splitlines()

    def test_is_a_program_that_stops_at_the_first_failure(self):
        assert self.script.stat().st_mode & 0o111
        assert self.script.read_text().splitlines()[2] == "set -euo pipefail"


class TestCitation:
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text())

    def test_names_the_tool_as_it_is(self):
        assert self.citation["cff-version"] == "1.2.0" and self.citation["authors"] and self.citation["message"]
        assert self.citation["version"] == cranio_nb.__version__ == version("cranio-nb")
        assert self.citation["license"] == PROJECT["project"]["license"]
        assert f"## [{cranio_nb.__version__}]" in (ROOT / "CHANGELOG.md").read_text()

    def test_cites_the_paper(self):
        (paper,) = self.citation["references"]
        assert paper["doi"] == "10.5220/0003356601370142" and paper["doi"] in README
        assert (paper["year"], paper["start"], paper["end"], len(paper["authors"])) == (2011, 137, 142, 6)
        assert all(author["family-names"] in README for author in paper["authors"])


@pytest.fixture(scope="module")
def tracked():
    """Path -> text of every file that belongs to the project."""
    if not (ROOT / ".git").exists():
        pytest.skip("not a git checkout: which files belong to the project is not known")
    listed = ["git", "-c", "safe.directory=*", "ls-files", "-z"]
    names = subprocess.run(listed, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    paths = [ROOT / name for name in names if name and (ROOT / name).is_file()]
    return {path.relative_to(ROOT): path.read_bytes().decode("utf-8", "ignore") for path in paths}


class TestTrackedFiles:
    def test_none_names_a_place_on_a_machine(self, tracked):
        found = {str(path): hit[0] for path, text in tracked.items() if (hit := MACHINE_PATH.search(text))}
        assert len(tracked) > 50 and not found

    def test_none_names_a_host(self, tracked):
        assert not {str(path): hit[0] for path, text in tracked.items() if (hit := HOST.search(text))}


class TestReadmeExample:
    def test_the_python_of_the_readme_runs_on_what_the_demo_leaves(self, tmp_path, monkeypatch, capsys):
        (block,) = re.findall(r"```python\n(.*?)```", README, re.S)
        write_case(tmp_path / "cranio_nb_out" / "demo", phantom_case("tiny", "unilateral", 0))
        monkeypatch.chdir(tmp_path)
        exec(compile(block, "README", "exec"), {})
        sound, dice = capsys.readouterr().out.split()
        assert sound == "True" and 0.9 < float(dice) <= 1
        assert {path.name for path in (tmp_path / "cranio_nb_out" / "by_hand").iterdir()} == {
            "manifest.json",
            *FILES,
        } - {"report.html"}


class TestArchitecturePage:
    page = (ROOT / "docs" / "architecture.md").read_text()

    def test_the_places_it_names_are_there(self):
        table = self.page.split("## Where is it?")[1].split("## Add a method")[0]
        places = re.findall(r"`([\w/]+(?:\.py|/))`", table)
        assert len(places) >= 9
        for place in places:
            assert (ROOT / "cranio_nb" / place).exists(), place

    def test_its_method_joins_the_others(self, monkeypatch):
        monkeypatch.setattr(catalogue, "_added", {})
        (block,) = re.findall(r"```python\n(.*?)```", self.page, re.S)
        space = {}
        exec(compile(block, "architecture", "exec"), space)
        cn, case = space["cn"], phantom_case("tiny", "unilateral", 0)
        made = cn.design(cn.Volume(case.bone, case.affine), method="sheet", thickness_mm=3.0)
        assert made.method == "sheet" and made.parameters["thickness_mm"] == 3.0 and made.patch.voxels.any()
