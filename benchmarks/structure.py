"""How the package is built, in figures: imports, lengths, comments, docstrings. It reads text and imports nothing.

    python benchmarks/structure.py [CHECKOUT ...] [--worst 5]

A column for each checkout (default: the one this file lies in), then what stands behind the figures of the last one.

Room: a top-level module or folder of `cranio_nb`, and `data_synth`, `notebooks`, `benchmarks`; the package's own
`__init__` and `__main__` are none. Floors: rooms on the longest chain of imports, a circle counted as one. Imports
inside functions and under TYPE_CHECKING count. Upward: against the list `FLOORS` of tests/test_layers.py, lowest first,
where there is one. Body: lines that hold code, without signature and docstring, nested functions in the outer one. Call
path: functions on the longest chain of calls that names alone tell (own module, imports, attributes of modules, methods
of `self` and of named classes; not the making of objects), recursion counted as one; first by imports at the top of a
module, then by those inside functions as well. Comments: those of their own line and those behind code, without `noqa`
and `type:`, for each 100 lines that hold code.
Public: without a leading underscore, at the top of
a module (functions) or of a public class (methods); where a docstring may leave out a section (nothing is returned,
nothing is given) the function does not count for it.
"""

from __future__ import annotations

import argparse
import ast
import re
import tokenize
from collections.abc import Mapping, Sequence
from pathlib import Path
from statistics import median

from structure_graphs import Graph, circles, grouped, longest_chain
from structure_source import PACKAGE, Function, Module, call_graph, import_graph, outside_functions, read_modules

# --- imports ---------------------------------------------------------------------------------------------------------


def room_of(name: str) -> str:
    """Top-level entry that a module belongs to; the package itself for its `__init__`."""
    parts = name.split(".")
    return parts[1] if parts[0] == PACKAGE and len(parts) > 1 else parts[0]


def floors_named(checkout: Path) -> list[str] | None:
    """The list `FLOORS` of the layers test, lowest first, or None; "nouns" are the files beside the folders."""
    path = checkout / "tests" / "test_layers.py"
    for node in ast.parse(path.read_text(encoding="utf-8")).body if path.exists() else []:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "FLOORS":
            return list(ast.literal_eval(node.value))
    return None


def upward_imports(graph: Graph, floors: Sequence[str]) -> list[str]:
    """Imports within the package from a lower floor to a higher one; its `__init__` and `__main__` stand above all."""

    def height(name: str) -> int:
        if name in (PACKAGE, f"{PACKAGE}.__main__"):
            return len(floors)
        return floors.index(room_of(name) if room_of(name) in floors else "nouns")

    return [f"{a} -> {b}" for a in sorted(graph) for b in sorted(graph[a]) if height(a) < height(b)]


def method_imports(modules: Mapping[str, Module], graph: Graph) -> list[str]:
    """Imports between methods: the entries of `methods` that a catalogue names by a dotted string."""
    catalogues = [m for name, m in modules.items() if name.startswith(PACKAGE) and name.endswith(".catalogue")]
    strings = [
        node.value
        for m in catalogues
        for node in ast.walk(m.tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str)
    ]
    named = {word for s in strings if re.fullmatch(r"[\w.:]*[.:][\w.:]*", s) for word in re.split("[.:]", s)}
    start = f"{PACKAGE}.methods."
    entries = {name: name.removeprefix(start).split(".")[0] for name in modules if name.startswith(start)}
    between = grouped(graph, {n: e for n, e in entries.items() if e in named - {"catalogue", "design"}})
    return [f"{a} -> {b}" for a in sorted(between) for b in sorted(between[a])]


# --- lengths, comments, docstrings, tests ----------------------------------------------------------------------------


def body_lines(modules: Mapping[str, Module]) -> dict[str, int]:
    """Lines of code in the body of every function and method."""
    return {f"{name}:{f}": _body(m, node) for name, m in modules.items() for f, node in m.functions.items()}


def _body(module: Module, node: Function) -> int:
    inside = range(node.body[0].lineno, (node.end_lineno or 0) + 1)
    return sum(n in module.code_lines for n in inside)


def quantile(values: Sequence[int], part: float) -> int:
    """The smallest value that at least `part` of the values do not exceed."""
    ranked = sorted(values)
    return ranked[max(0, -int(-part * len(ranked) // 1) - 1)] if ranked else 0


def comments(modules: Mapping[str, Module]) -> tuple[int, int]:
    """Number of comments on a line of their own, and behind code."""
    found = [
        t.line[: t.start[1]].strip() == ""
        for m in modules.values()
        for t in m.tokens
        if t.type == tokenize.COMMENT and not re.match(r"#\s*(noqa|type:)", t.string)
    ]
    return sum(found), len(found) - sum(found)


def is_public(module: str, name: str) -> bool:
    return not any(part.startswith("_") for part in [*module.split("."), *name.split(".")])


def gives_something(node: Function) -> bool:
    """Whether a function returns or yields a value; inner functions do not count."""
    parts = list(outside_functions(node.body))
    values = [part.value for part in parts if isinstance(part, ast.Return)]
    returns = any(not (v is None or (isinstance(v, ast.Constant) and v.value is None)) for v in values)
    return returns or any(isinstance(part, ast.Yield | ast.YieldFrom) for part in parts)


def takes_something(node: Function) -> bool:
    every = [*node.args.posonlyargs, *node.args.args, *node.args.kwonlyargs]
    return any(arg.arg not in ("self", "cls") for arg in every) or bool(node.args.vararg or node.args.kwarg)


def has_section(node: Function, *titles: str) -> bool:
    text = ast.get_docstring(node) or ""
    return any(re.search(rf"^{title}\n-+$", text, re.MULTILINE) for title in titles)


def documented(nodes: Sequence[Function]) -> dict[str, tuple[list[Function], list[Function]]]:
    """(those that have it, those that should) of example, Returns and Parameters."""
    giving, taking = [n for n in nodes if gives_something(n)], [n for n in nodes if takes_something(n)]
    return {
        "with an example": ([n for n in nodes if ">>>" in (ast.get_docstring(n) or "")], list(nodes)),
        "with Returns": ([n for n in giving if has_section(n, "Returns", "Yields")], giving),
        "with Parameters": ([n for n in taking if has_section(n, "Parameters")], taking),
    }


def docstrings_with_examples(modules: Mapping[str, Module]) -> int:
    kinds = ast.Module | ast.ClassDef | Function
    nodes = [node for m in modules.values() for node in ast.walk(m.tree) if isinstance(node, kinds)]
    return sum(">>>" in (ast.get_docstring(node) or "") for node in nodes)


def without_test(modules: Mapping[str, Module], checkout: Path) -> list[str]:
    """Modules without tests/a/test_b.py, nor one of the flat forms tests/test_b.py and tests/test_a_b.py."""
    missing = []
    for name, m in modules.items():
        parts = name.split(".")[1:]
        flat = (f"test_{parts[-1]}", "test_" + "_".join(parts)) if parts else ()
        at = [checkout / "tests" / f"{stem}.py" for stem in flat]
        at += [checkout.joinpath("tests", *parts[:-1], f"test_{parts[-1]}.py")] if parts else []
        if not m.is_package and not any(path.exists() for path in at):
            missing.append(".".join(parts))
    return missing


# --- the table -------------------------------------------------------------------------------------------------------


def figures(checkout: Path, worst: int = 5) -> tuple[dict[str, str], dict[str, list[str]]]:
    """Every figure of a checkout as text, and what stands behind some of them."""
    every = read_modules(checkout)
    own = {name: m for name, m in every.items() if name.split(".")[0] == PACKAGE}
    parts = [import_figures(checkout, every, own), size_figures(own, worst), text_figures(checkout, own)]
    return {k: v for shown, _ in parts for k, v in shown.items()}, {k: v for _, more in parts for k, v in more.items()}


def import_figures(
    checkout: Path, every: Mapping[str, Module], own: Mapping[str, Module]
) -> tuple[dict[str, str], dict[str, list[str]]]:
    """Rooms, floors, circles, upward imports."""
    graph = import_graph(every)
    rooms = grouped(graph, {name: room_of(name) for name in every if name not in (PACKAGE, f"{PACKAGE}.__main__")})
    chain, floors = longest_chain(rooms), floors_named(checkout)
    up = None if floors is None else upward_imports({name: graph[name] & own.keys() for name in own}, floors)
    of_modules, of_rooms, between = (
        circles({n: graph[n] & own.keys() for n in own}),
        circles(rooms),
        method_imports(own, graph),
    )
    direct = [m for name, m in own.items() if name.count(".") == 1 and not m.is_package]
    shown = {
        f"files directly in {PACKAGE}": str(len(direct)),
        "rooms seen from the top": str(len(rooms)),
        "floors": str(len(chain)),
        "imports between modules": str(sum(len(graph[name]) for name in own)),
        "upward imports": "-" if up is None else str(len(up)),
        "circles of modules / of rooms": f"{len(of_modules)} / {len(of_rooms)}",
        "methods that import another": str(len(between)),
    }
    behind = {
        "floors, highest first": [" > ".join(chain)],
        "circles of modules": [", ".join(part) for part in of_modules],
        "circles of rooms": [", ".join(part) for part in of_rooms],
        "upward imports": up or [],
        "methods that import another": between,
    }
    return shown, behind


def size_figures(own: Mapping[str, Module], worst: int) -> tuple[dict[str, str], dict[str, list[str]]]:
    """Lengths of functions and modules, the deepest call path."""
    bodies = body_lines(own)
    lengths = {name: len(m.text.splitlines()) for name, m in own.items() if not m.is_package}
    path, lazy_path = (longest_chain(call_graph(own, lazy)) for lazy in (False, True))
    values, lines = list(bodies.values()), list(lengths.values())
    shown = {
        "functions and methods": str(len(bodies)),
        "body lines median / p90 / max": f"{median(values):g} / {quantile(values, 0.9)} / {max(values)}",
        "modules": str(len(lengths)),
        "module lines median / max": f"{median(lines):g} / {max(lines)}",
        "deepest static call path": str(len(path)),
        "  with imports inside functions": str(len(lazy_path)),
    }
    behind = {
        "longest bodies": _largest(bodies, worst),
        "longest modules": _largest(lengths, worst),
        "deepest static call path": [" > ".join(path)],
        "deepest with imports inside functions": [" > ".join(lazy_path)],
    }
    return shown, behind


def text_figures(checkout: Path, own: Mapping[str, Module]) -> tuple[dict[str, str], dict[str, list[str]]]:
    """Comments, docstrings, tests."""
    n_code = sum(len(m.code_lines) for m in own.values())
    alone, behind_code = comments(own)
    public = [(f, node) for name, m in own.items() for f, node in m.functions.items() if is_public(name, f)]
    shown = {
        "lines that hold code": str(n_code),
        "comments per 100 of them": f"{100 * (alone + behind_code) / n_code:.1f}",
        "  on their own line / behind code": f"{100 * alone / n_code:.1f} / {100 * behind_code / n_code:.1f}",
    }
    for kind, nodes in {
        "public functions": [node for f, node in public if "." not in f],
        "public methods": [node for f, node in public if "." in f],
    }.items():
        for what, (have, should) in documented(nodes).items():
            shown[f"{kind} {what}"] = f"{len(have)} of {len(should)}"
    missing = without_test(own, checkout)
    shown["docstrings with an example"] = str(docstrings_with_examples(own))
    shown["modules without a test file"] = str(len(missing))
    return shown, {"modules without a test file": [", ".join(missing)] if missing else []}


def _largest(values: Mapping[str, int], n: int) -> list[str]:
    ranked = sorted(values, key=lambda name: (-values[name], name))
    return [f"{values[name]:5d}  {name}" for name in ranked[:n]]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("checkouts", nargs="*", type=Path, metavar="CHECKOUT", default=[Path(__file__).parents[1]])
    parser.add_argument("--worst", type=int, default=5, help="how many of the longest are named")
    asked = parser.parse_args()
    found = [figures(checkout.resolve(), asked.worst) for checkout in asked.checkouts]
    print(f"{'':36s}" + "".join(f"{checkout.resolve().name[-15:]:>16s}" for checkout in asked.checkouts))
    for key in found[-1][0]:
        print(f"{key:36s}" + "".join(f"{shown[key]:>16s}" for shown, _ in found))
    for title, lines in found[-1][1].items():
        print(f"\n{title}:" + "".join(f"\n  {line}" for line in lines or ["none"]))


if __name__ == "__main__":
    main()
