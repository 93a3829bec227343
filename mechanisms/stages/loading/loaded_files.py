"""Finds the files that the author's code consists of: the modules it imports, and what those import in turn.

Of the program's own rooms, a module that the author's code imports counts with those that it imports itself; the solver
counts as a whole, without its drawing. Of installed packages the version counts.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from functools import cache
from importlib import metadata
from pathlib import Path
from types import ModuleType

from mechanisms.stages.loading.inputs import Inputs, file_state, name_of, package_state, sources_state
from mechanisms.stages.loading.recording import is_installed
from shared.stage.files import file_hash
from shared.stage.paths import ROOT

DYNAMIC = ("import_module", "__import__", "sys.modules", "runpy", "exec(", "eval(")
"""Words in a file that may load modules unseen by its import statements."""


def loaded_inputs(start: Path, package: str, before: set[str], leave_out: Path | None = None) -> Inputs:
    """Files, rooms and packages that ``start``, a file of the package ``package``, was made of.

    ``before``: names of the modules that were loaded before it; later ones count although no import
    statement names them. ``leave_out`` and what only that file imports do not count.
    """
    found = Inputs()
    waiting: list[tuple[Path, str]] = [(start, package)]
    waiting += [
        (file, _package(module))
        for name, module in list(sys.modules.items())
        if name not in before and (file := _file(module)) is not None and _is_authors(file) and file != leave_out
    ]
    seen: set[Path] = {leave_out} if leave_out else set()
    while waiting:
        file, package = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        name = name_of(file)
        found.files[name] = file_state(name)
        for module in imported(file, package):
            _count(module, found, waiting)
    return found


def author_files(start: Path, package: str, leave_out: Path) -> list[tuple[Path, str]]:
    """The author's own files that ``start`` was made of, itself included, each with its package."""
    seen: dict[Path, str] = {}
    waiting = [(start, package)]
    while waiting:
        file, package = waiting.pop()
        if file in seen or file == leave_out:
            continue
        seen[file] = package
        for module in imported(file, package):
            below = _file(module)
            if below is not None and _is_authors(below):
                waiting.append((below, _package(module)))
    return list(seen.items())


def imported(file: Path, package: str) -> Iterator[ModuleType]:
    """The loaded modules that the import statements of a Python file name, packages above them included."""
    if file.suffix != ".py":
        return
    names: set[str] = set()
    for node in ast.walk(_parsed(file, file_hash(file))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = absolute(node, package)
            names.update([base, *(f"{base}.{alias.name}" for alias in node.names)])
    above = {".".join(name.split(".")[:count]) for name in names for count in range(1, name.count(".") + 2)}
    for name in sorted(above):
        module = sys.modules.get(name)
        if isinstance(module, ModuleType):
            yield module


def absolute(node: ast.ImportFrom, package: str) -> str:
    """The module that ``from ... import`` names, without leading dots."""
    if not node.level:
        return node.module or ""
    parts = package.split(".")[: len(package.split(".")) - node.level + 1]
    return ".".join([*parts, *([node.module] if node.module else [])])


def _count(module: ModuleType, found: Inputs, waiting: list[tuple[Path, str]]) -> None:
    top = module.__name__.partition(".")[0]
    file = _file(module)
    if file is None:
        return
    if is_installed(str(file)):
        if top not in sys.stdlib_module_names:
            for package in _distributions(top):
                found.packages.setdefault(package, package_state(package))
    elif top == "mbsd" and file.is_relative_to(ROOT / "mbsd"):
        found.sources.setdefault("mbsd", sources_state("mbsd"))
        if file.is_relative_to(ROOT / "mbsd" / "drawing"):
            found.sources.setdefault("mbsd/drawing", sources_state("mbsd/drawing"))
    else:
        waiting.append((file, _package(module)))


def _is_authors(file: Path) -> bool:
    """Whether a file belongs neither to an installed package nor to the program."""
    if is_installed(str(file)):
        return False
    ours = [ROOT / room for room in ("mbsd", "shared", "render", "tests", "mechanisms/stages")]
    return file.parent != ROOT / "mechanisms" and not any(file.is_relative_to(room) for room in ours)


def _file(module: ModuleType) -> Path | None:
    file = getattr(module, "__file__", None)
    return Path(file) if isinstance(file, str) else None


def _package(module: ModuleType) -> str:
    name = module.__name__
    return name if hasattr(module, "__path__") else name.rpartition(".")[0]


@cache
def _parsed(file: Path, content: str) -> ast.Module:
    """The syntax tree of a file with this hash of its content."""
    return ast.parse(file.read_bytes())


@cache
def _distributions(top: str) -> list[str]:
    """The installed distributions that bring a top-level module; looking through all of them takes a second."""
    if package_state(top) != "missing":
        return [top]
    return sorted(set(metadata.packages_distributions().get(top, ())))
