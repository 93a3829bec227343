"""Finds whether parts.py uses more of mechanism.py than the class Params for its annotations.

If nothing more, the solids follow from mechanism.py only through the parameters that ``parts()`` reads, and an edit of
anything else there leaves them alone.
"""

from __future__ import annotations

import ast
from collections.abc import Iterable
from pathlib import Path

from mbsd.dependencies.imported import absolute_name
from mbsd.dependencies.meaning import DYNAMIC


def only_annotates(files: Iterable[tuple[Path, str]], module: str) -> bool:
    """Whether these files, each with its package, use of ``module`` nothing but ``Params``, and that in annotations."""
    return all(_file_only_annotates(file, package, module) for file, package in files)


def _file_only_annotates(file: Path, package: str, module: str) -> bool:
    text = file.read_text(errors="replace")
    if any(word in text for word in DYNAMIC):
        return False
    tree = ast.parse(text)
    folder, _, stem = module.rpartition(".")
    local: set[str] = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import) and any(f"{alias.name}.".startswith(f"{folder}.") for alias in node.names):
            if any(alias.name in (folder, module) for alias in node.names):
                return False
        elif isinstance(node, ast.ImportFrom):
            base = absolute_name(node, package)
            if base == folder and any(alias.name in (stem, "*") for alias in node.names):
                return False
            if base == module:
                if any(alias.name != "Params" for alias in node.names):
                    return False
                local.update(alias.asname or alias.name for alias in node.names)
    uses = _Uses(local)
    uses.visit(tree)
    return not uses.used


class _Uses(ast.NodeVisitor):
    """Looks for names outside of annotations."""

    def __init__(self, names: set[str]) -> None:
        self.names = names
        self.used = False

    def visit_Name(self, node: ast.Name) -> None:
        """A name that is used."""
        self.used |= node.id in self.names

    def visit_arg(self, node: ast.arg) -> None:
        """A parameter of a function; its annotation is not looked into."""

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        """A variable with an annotation; only its value is looked into."""
        if node.value is not None:
            self.visit(node.value)

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        for child in (node.args, *node.decorator_list, *node.body):
            self.visit(child)

    visit_FunctionDef = _function
    visit_AsyncFunctionDef = _function
