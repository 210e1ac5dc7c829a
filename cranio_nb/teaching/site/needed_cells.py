"""A lesson's cells -> the panels and scenes that they show, running only the cells which these need.

A cell is needed where it gives a name that a needed cell after it reads. Names stand for all that is known: a cell
that changes what another one made without naming it is not seen.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from typing import Any

from nbformat import NotebookNode

from ...drawing.scene3d import Scene
from ...errors import InputRefused
from ..widgets import Panel

_MAKERS = {"widgets", "show", "show_meshes"}  # names that panels and scenes are made with
Shown = Panel | Scene


def shown_by(cells: Sequence[NotebookNode]) -> dict[str, Shown]:
    """What the cells of a lesson show that can be moved.

    Parameters
    ----------
    cells : sequence of NotebookNode
        Executed, in their order.

    Returns
    -------
    dict of str to Panel or Scene
        By the id of the cell.

    Raises
    ------
    InputRefused
        ``OutOfStep`` where a panel says something else than the notebook holds.
    """
    code = [cell for cell in cells if cell.cell_type == "code"]
    trees = [ast.parse(cell.source) for cell in code]
    goals = [i for i, cell in enumerate(code) if _shows(trees, i) and _line(cell)]
    names: dict[str, Any] = {}
    found = {}
    with _static_mode():
        for i in sorted(needed(trees, goals)):
            result = _run(trees[i], names, last=i in goals)
            if isinstance(result, Shown):
                _check_line(code[i], result)
                found[code[i].id] = result
    return found


def needed(trees: Sequence[ast.Module], goals: Sequence[int]) -> set[int]:
    """Which cells must run for some of them to run.

    Parameters
    ----------
    trees : sequence of Module
        Of the cells, in their order.
    goals : sequence of int
        Places of the cells that are wanted.

    Returns
    -------
    set of int
        Their places, those of the goals included.

    Examples
    --------
    >>> cells = [ast.parse(text) for text in ("a = 1", "b = 2", "c = a + 1", "print(b)", "c")]
    >>> sorted(needed(cells, [4]))
    [0, 2, 4]
    """
    found: set[int] = set()
    wanted: set[str] = set()
    for i in range(len(trees) - 1, -1, -1):
        reads, gives = _names(trees[i])
        if i in goals or gives & wanted:
            found.add(i)
            # a name that is read before it is given comes from an earlier cell
            wanted = (wanted - gives) | reads
    return found


def _names(tree: ast.Module) -> tuple[set[str], set[str]]:
    """Names that a cell reads, and names that it gives; what changes an object reads it and gives it."""
    reads: set[str] = set()
    gives: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Name):
            (reads if isinstance(node.ctx, ast.Load) else gives).add(node.id)
        elif isinstance(node, ast.alias):
            gives.add((node.asname or node.name).split(".")[0])
        elif isinstance(node, ast.FunctionDef | ast.ClassDef):
            gives.add(node.name)
        elif isinstance(node, ast.Attribute | ast.Subscript) and isinstance(node.ctx, ast.Store):
            gives |= {inner.id for inner in ast.walk(node.value) if isinstance(inner, ast.Name)}
    return reads, gives


def _shows(trees: Sequence[ast.Module], i: int) -> bool:
    """Whether a cell ends with something that a panel or a scene was made with, or that was made so before."""
    makers = set(_MAKERS)
    for tree in trees[: i + 1]:
        for node in tree.body:
            if isinstance(node, ast.Assign) and _mentioned(node.value) & makers:
                makers |= _names(ast.Module([node], []))[1]
    last = trees[i].body[-1] if trees[i].body else None
    return isinstance(last, ast.Expr) and bool(_mentioned(last) & makers)


def _mentioned(tree: ast.AST) -> set[str]:
    """Names and attributes that an expression mentions."""
    names = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    return names | {node.attr for node in ast.walk(tree) if isinstance(node, ast.Attribute)}


def _run(tree: ast.Module, names: dict[str, Any], *, last: bool) -> Any:
    """Run a cell; the value of its last expression where it is asked for."""
    *body, end = tree.body
    with redirect_stdout(StringIO()):
        exec(compile(ast.Module(body, []), "<lesson>", "exec"), names)
        if last and isinstance(end, ast.Expr):
            return eval(compile(ast.Expression(end.value), "<lesson>", "eval"), names)
        exec(compile(ast.Module([end], []), "<lesson>", "exec"), names)
    return None


@contextmanager
def _static_mode() -> Iterator[None]:
    """Panels without widgets, as the lessons were run."""
    before = os.environ.get("CRANIO_NB_MODE")
    os.environ["CRANIO_NB_MODE"] = "static"
    try:
        yield
    finally:
        if before is None:
            del os.environ["CRANIO_NB_MODE"]
        else:
            os.environ["CRANIO_NB_MODE"] = before


def _line(cell: NotebookNode) -> str:
    """The line below the picture that a cell shows; empty where it shows none."""
    shown = [output.data for output in cell.outputs if "image/png" in output.get("data", {})]
    return shown[-1]["text/plain"] if shown else ""


def _check_line(cell: NotebookNode, shown: Shown) -> None:
    """Refuse a notebook that holds another picture than its panel draws now."""
    now = shown.view.line if isinstance(shown, Panel) else shown.line
    if now != _line(cell):
        message = f"A notebook says {_line(cell)!r} where its panel says {now!r}."
        raise InputRefused("OutOfStep", message, "Run `cranio-nb lessons build`.")
