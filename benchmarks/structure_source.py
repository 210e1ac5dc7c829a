"""A checkout as text -> its modules, and what they import and call. For `structure.py`."""

from __future__ import annotations

import ast
import io
import tokenize
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from structure_graphs import Graph

PACKAGE = "cranio_nb"
NEIGHBOURS = ("data_synth", "notebooks", "benchmarks")
Function = ast.FunctionDef | ast.AsyncFunctionDef
_SILENT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}


@dataclass(frozen=True, eq=False)
class Module:
    """A file of source text; `name` is dotted, without `__init__`."""

    name: str
    path: Path
    text: str

    @cached_property
    def tree(self) -> ast.Module:
        """The syntax tree."""
        return ast.parse(self.text)

    @cached_property
    def tokens(self) -> list[tokenize.TokenInfo]:
        """The tokens, comments among them."""
        return list(tokenize.generate_tokens(io.StringIO(self.text).readline))

    @cached_property
    def code_lines(self) -> set[int]:
        """Numbers of the lines that hold code, docstrings left out."""
        lines = {n for t in self.tokens if t.type not in _SILENT for n in range(t.start[0], t.end[0] + 1)}
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Module | ast.ClassDef | Function) and ast.get_docstring(node) is not None:
                lines -= set(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
        return lines

    @property
    def is_package(self) -> bool:
        """Whether this is an `__init__`."""
        return self.path.name == "__init__.py"

    @cached_property
    def functions(self) -> dict[str, Function]:
        """Functions at the top and methods of classes there, by "name" and "Class.name"."""
        found: dict[str, Function] = {}
        for node in self.tree.body:
            if isinstance(node, Function):
                found[node.name] = node
            elif isinstance(node, ast.ClassDef):
                found |= {f"{node.name}.{part.name}": part for part in node.body if isinstance(part, Function)}
        return found


def read_modules(checkout: Path) -> dict[str, Module]:
    """The modules of the package and its neighbours, by dotted name."""
    found = {}
    for room in (PACKAGE, *NEIGHBOURS):
        for path in sorted((checkout / room).rglob("*.py")):
            parts = path.relative_to(checkout).with_suffix("").parts
            name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
            found[name] = Module(name, path, path.read_text(encoding="utf-8"))
    return found


def bindings(module: Module, known: Mapping[str, Module], lazy: bool = True) -> Iterator[tuple[str, str, str]]:
    """What a module imports from known ones: (name here, module, name there); the last is empty for a whole module."""
    package = module.name.split(".") if module.is_package else module.name.split(".")[:-1]
    for node in ast.walk(module.tree) if lazy else outside_functions(module.tree.body):
        if isinstance(node, ast.Import):
            for alias in node.names:
                if (target := _longest_known(alias.name, known)) is not None:
                    yield alias.asname or alias.name, target, ""
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            base = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                here = alias.asname or alias.name
                if f"{base}.{alias.name}" in known:
                    yield here, f"{base}.{alias.name}", ""
                elif base in known:
                    yield here, base, alias.name


def outside_functions(nodes: Sequence[ast.stmt]) -> Iterator[ast.AST]:
    """Some nodes and all that they hold, but not what stands in functions and classes."""
    todo: list[ast.AST] = list(nodes)
    while todo:
        node = todo.pop()
        yield node
        if not isinstance(node, Function | ast.Lambda | ast.ClassDef):
            todo += ast.iter_child_nodes(node)


def _longest_known(name: str, known: Mapping[str, Module]) -> str | None:
    while name and name not in known:
        name = name.rpartition(".")[0]
    return name or None


def import_graph(modules: Mapping[str, Module]) -> Graph:
    """Module -> the modules it imports."""
    return {name: {to for _, to, _ in bindings(m, modules)} - {name} for name, m in modules.items()}


def call_graph(modules: Mapping[str, Module], lazy: bool = True) -> Graph:
    """Function -> the functions of the package that it calls by name, as "module:function"."""
    names = {name: {here: to for here, *to in bindings(m, modules, lazy)} for name, m in modules.items()}

    def resolve(module: str, dotted: str, seen: frozenset[str] = frozenset()) -> str | None:
        """The function a dotted name means in a module."""
        if module in seen:
            return None
        if dotted in modules[module].functions:
            return f"{module}:{dotted}"
        if f"{module}.{dotted.partition('.')[0]}" in modules and "." in dotted and dotted not in names[module]:
            return resolve(f"{module}.{dotted.partition('.')[0]}", dotted.partition(".")[2])
        for here in _prefixes(dotted):
            if here in names[module]:
                to, there = names[module][here]
                rest = ".".join(part for part in (there, dotted[len(here) + 1 :]) if part)
                return resolve(to, rest, seen | {module}) if rest else None
        return None

    graph: Graph = {f"{name}:{f}": set() for name, m in modules.items() for f in m.functions}
    for name, m in modules.items():
        for function, node in m.functions.items():
            for call in (c for c in ast.walk(node) if isinstance(c, ast.Call)):
                dotted = _dotted(call.func)
                if dotted.startswith(("self.", "cls.")) and "." in function:
                    dotted = f"{function.partition('.')[0]}.{dotted.partition('.')[2]}"
                if dotted and (to := resolve(name, dotted)):
                    graph[f"{name}:{function}"].add(to)
    return graph


def _dotted(node: ast.expr) -> str:
    """The text of an expression that is a name or a.b.c, or nothing."""
    if isinstance(node, ast.Attribute):
        before = _dotted(node.value)
        return f"{before}.{node.attr}" if before else ""
    return node.id if isinstance(node, ast.Name) else ""


def _prefixes(dotted: str) -> list[str]:
    """A dotted name and all it begins with, longest first."""
    parts = dotted.split(".")
    return [".".join(parts[:n]) for n in range(len(parts), 0, -1)]
