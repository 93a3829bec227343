"""The later line of a mechanism.py that decides a number, so that its literal has no effect."""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterable, Iterator

from studio.live.numbers import parsed
from studio.live.writing.literals import literal


def written_line(source: bytes, name: str, file: str, variant: str | None) -> int:
    """Return the line of the literal of a number. Raises UserError if it has none."""
    return literal(ast.parse(source), name, file, variant).lineno


def deciding_line(source: bytes, name: str, file: str, variant: str | None) -> int | None:
    """Return the line after a number's literal that most likely decides it; None if none does.

    Looked for are, in this order, the field set again in the body of Params or in a method of it, Params or VARIANTS
    bound again, and what names the field in any other way.
    """
    tree = ast.parse(source)
    place = literal(tree, name, file, variant)
    field, _ = parsed(name)

    def last(inside: Iterable[ast.AST], decides: Callable[[ast.AST], bool]) -> int:
        """Return the last line after the literal in which a node decides it; 0 if there is none."""
        nodes = (node for tree in inside for node in ast.walk(tree))
        return max((_place(node)[0] for node in nodes if _is_after(node, place) and decides(node)), default=0)

    def names(node: ast.AST) -> bool:
        return _sets(node, field) or (isinstance(node, ast.Constant) and node.value == field)

    def binds(node: ast.AST) -> bool:
        if variant:
            return isinstance(node, ast.Name) and node.id == "VARIANTS"
        return _sets(node, "Params") or (isinstance(node, ast.ClassDef) and node.name == "Params")

    in_class = 0 if variant else last(_classes(tree), names)
    rest = (
        tree.body if variant else [line for line in tree.body if not any(_sets(n, "VARIANTS") for n in ast.walk(line))]
    )
    return in_class or last([tree], binds) or last(rest, names) or None


def _classes(tree: ast.Module) -> Iterator[ast.ClassDef]:
    return (node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "Params")


def _is_after(node: ast.AST, place: ast.expr) -> bool:
    return _place(node) >= (place.end_lineno or place.lineno, place.end_col_offset or place.col_offset)


def _place(node: ast.AST) -> tuple[int, int]:
    return getattr(node, "lineno", 0), getattr(node, "col_offset", 0)


def _sets(node: ast.AST, name: str) -> bool:
    """Return True if a node assigns a name, an attribute or a keyword of this name."""
    if isinstance(node, ast.Name | ast.Attribute):
        own = node.id if isinstance(node, ast.Name) else node.attr
        return own == name and not isinstance(node.ctx, ast.Load)
    return isinstance(node, ast.keyword) and node.arg == name
