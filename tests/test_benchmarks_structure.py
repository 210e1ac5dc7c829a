"""The structural figures on a tiny made-up package whose figures are counted by hand."""

import pytest
from benchmark_scripts import script

FILES = {
    "cranio_nb/__init__.py": '"""Nothing here."""\n',
    "cranio_nb/__main__.py": "from .stages import cut\n",
    "cranio_nb/ground.py": '''"""The ground."""

# a comment of its own line
LIMIT = 3  # one behind code
import os  # noqa: E402


def half(x):
    """Half of it.

    Parameters
    ----------
    x : int

    Returns
    -------
    int

    Examples
    --------
    >>> half(4)
    2
    """
    def inner(y):
        return y  # inner lines count in the outer function

    # no code in this line
    return inner(
        x // 2
    )


def tell(x):
    """Give nothing back."""
    _quiet(x)
    return None


def _quiet(x): os.fspath(x)
''',
    "cranio_nb/stages/__init__.py": "from .cutting import cut\n",
    "cranio_nb/stages/cutting.py": '''from .. import ground
from ..ground import half as halved


class Knife:
    """A knife."""

    def edge(self):
        """Its edge."""
        return self._grind()

    def _grind(self):
        return ground.half(1)


def cut(x):
    return halved(x) + again(x)


def again(x):
    return cut(x - 1)
''',
    "cranio_nb/stages/lazy.py": """from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .knot import tie


def loose(x):
    from . import cutting
    return cutting.cut(x)
""",
    "cranio_nb/stages/knot.py": """def bow(x):
    return tie(x)


def tie(x):
    from .lazy import loose
    return loose(x)
""",
    "cranio_nb/methods/__init__.py": "",
    "cranio_nb/methods/catalogue.py": 'METHODS = {"a": "cranio_nb.methods.a", "b": "cranio_nb.methods.b"}\n',
    "cranio_nb/methods/shared.py": "def share():\n    return 1\n",
    "cranio_nb/methods/a.py": """from .shared import share
from ..stages import cut


def design(x):
    return cut(share())
""",
    "cranio_nb/methods/b/__init__.py": "from .inside import design\n",
    "cranio_nb/methods/b/inside.py": "from .. import a\n\n\ndef design(x):\n    yield a.design(x)\n",
    "data_synth/__init__.py": "",
    "benchmarks/speed.py": "from cranio_nb.methods import b\n",
    "notebooks/src/one.py": "import cranio_nb.ground\n",
    "tests/test_ground.py": "",
    "tests/stages/test_cutting.py": "",
    "tests/test_stages_lazy.py": "",
    "tests/test_inside.py": "",
    "tests/test_layers.py": 'FLOORS = ["nouns", "methods", "stages"]\n',
}


structure = script("structure")
structure_source = script("structure_source")
structure_graphs = script("structure_graphs")


@pytest.fixture(scope="module")
def checkout(tmp_path_factory):
    root = tmp_path_factory.mktemp("checkout")
    for name, text in FILES.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text)
    return root


@pytest.fixture(scope="module")
def shown(structure, checkout):
    return structure.figures(checkout)


@pytest.mark.parametrize(
    ("figure", "value"),
    {
        "files directly in cranio_nb": "2",
        "rooms seen from the top": "6",  # ground stages methods; data_synth notebooks benchmarks
        "floors": "4",  # benchmarks methods stages ground
        "upward imports": "1",
        "circles of modules / of rooms": "1 / 0",
        "methods that import another": "1",
        "functions and methods": "13",
        # half 5, of them 2 of its inner function; tell, loose and tie 2; the others 1
        "body lines median / p90 / max": "1 / 2 / 5",
        "modules": "9",
        "deepest static call path": "4",  # b.design a.design cut half
        "  with imports inside functions": "5",  # bow tie loose cut half
        "public functions with an example": "1 of 10",
        "public functions with Returns": "1 of 9",
        "public functions with Parameters": "1 of 9",
        "public methods with an example": "0 of 1",
        "docstrings with an example": "1",
        "modules without a test file": "5",
    }.items(),
)
def test_figures_are_those_counted_by_hand(figure, value, shown):
    assert shown[0][figure] == value


def test_what_stands_behind_the_figures_is_named(shown):
    behind = shown[1]
    assert behind["circles of modules"] == ["cranio_nb.stages.knot, cranio_nb.stages.lazy"]
    assert behind["upward imports"] == ["cranio_nb.methods.a -> cranio_nb.stages"]
    assert behind["methods that import another"] == ["b -> a"]
    assert behind["modules without a test file"] == [
        "__main__, methods.a, methods.catalogue, methods.shared, stages.knot"
    ]
    assert behind["longest bodies"][0].split() == ["5", "cranio_nb.ground:half"]


def test_comments_and_lines_of_a_module(structure, structure_source, checkout):
    module = structure_source.read_modules(checkout)["cranio_nb.ground"]
    assert structure.comments({"ground": module}) == (2, 2)
    assert len(module.code_lines) == 2 + 6 + 3 + 1


def test_calls_follow_names_modules_and_what_a_package_gives_on(structure_source, checkout):
    own = {name: m for name, m in structure_source.read_modules(checkout).items() if name.startswith("cranio_nb")}
    graph = structure_source.call_graph(own)
    assert graph["cranio_nb.methods.a:design"] == {"cranio_nb.stages.cutting:cut", "cranio_nb.methods.shared:share"}
    assert graph["cranio_nb.stages.cutting:Knife.edge"] == {"cranio_nb.stages.cutting:Knife._grind"}
    assert graph["cranio_nb.stages.cutting:Knife._grind"] == {"cranio_nb.ground:half"}
    assert graph["cranio_nb.stages.lazy:loose"] == {"cranio_nb.stages.cutting:cut"}
    assert structure_source.call_graph(own, lazy=False)["cranio_nb.stages.lazy:loose"] == set()


def test_chains_take_a_circle_as_one(structure_graphs):
    graph = {"a": {"b", "d"}, "b": {"c"}, "c": {"b", "d"}, "d": {"e"}, "e": set(), "alone": set()}
    assert structure_graphs.longest_chain(graph) in (["a", "b = c", "d", "e"], ["a", "c = b", "d", "e"])
    assert [sorted(part) for part in structure_graphs.circles(graph)] == [["b", "c"]]


@pytest.mark.parametrize(("part", "value"), [(0.5, 5), (0.9, 9), (0.91, 10), (1.0, 10), (0.01, 1)])
def test_quantile_is_a_value_that_so_many_do_not_exceed(part, value, structure):
    assert structure.quantile(range(1, 11), part) == value
