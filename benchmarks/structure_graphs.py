"""Graphs: circles, longest chains, and the graph between groups of nodes. For `structure.py`."""

from __future__ import annotations

from collections.abc import Mapping

Graph = dict[str, set[str]]
"""Node -> the nodes that it leads to."""


def grouped(graph: Graph, group: Mapping[str, str]) -> Graph:
    """The graph between groups of nodes; nodes without a group are left out."""
    found: Graph = {name: set() for name in group.values()}
    for name in group:
        found[group[name]] |= {group[to] for to in graph[name] if to in group} - {group[name]}
    return found


def components(graph: Graph) -> list[list[str]]:
    """Strongly connected sets of nodes, each after all it leads to (Tarjan 1972)."""
    order: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found: list[list[str]] = []

    def visit(node: str) -> None:
        order[node] = low[node] = len(order)
        stack.append(node)
        for to in sorted(graph[node]):
            if to not in order:
                visit(to)
            low[node] = min(low[node], low[to] if to in low else low[node])
        if low[node] == order[node]:
            part = stack[stack.index(node) :]
            del stack[stack.index(node) :]
            for one in part:
                del low[one]
            found.append(part)

    for node in sorted(graph):
        if node not in order:
            visit(node)
    return found


def circles(graph: Graph) -> list[list[str]]:
    """Sets of nodes that lead back to themselves, of two or more."""
    return [part for part in components(graph) if len(part) > 1]


def longest_chain(graph: Graph) -> list[str]:
    """A longest chain of nodes, a circle counted as one and shown as "a = b"."""
    chains: dict[str, list[str]] = {}
    for part in components(graph):
        beyond = [chains[to] for node in part for to in sorted(graph[node]) if to not in part]
        chain = [" = ".join(part), *max(beyond, key=len, default=[])]
        chains |= dict.fromkeys(part, chain)
    return max(chains.values(), key=len, default=[])
