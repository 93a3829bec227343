"""The modules of which a user's code consists: those it imports, and what these import in turn."""

from __future__ import annotations

import ast
import sys
from collections.abc import Callable, Iterator
from functools import lru_cache
from pathlib import Path
from types import ModuleType

from mbsd.dependencies.inputs import Inputs, Places, looks_at_itself, parsed


def modules_below(
    waiting: list[tuple[Path, str]],
    places: Places,
    count: Callable[[ModuleType, Inputs, list[tuple[Path, str]]], None],
    leave_out: Path | None = None,
) -> Inputs:
    """The files ``waiting``, each with its package, and what their import statements name, as inputs.

    ``count`` decides, once for every module that is imported: it counts it, or appends its file to those waiting.
    Where one of the user's files looks at itself, all count by their bytes, too.
    """
    inputs = Inputs()
    seen: set[Path] = {leave_out} if leave_out else set()
    counted: set[ModuleType] = set()
    reflective = False
    while waiting:
        file, package = waiting.pop()
        if file in seen:
            continue
        seen.add(file)
        name = places.name_of(file)
        inputs.modules[name] = places.state("modules", name)
        ours = places.is_program(str(file)) or places.acts_for_itself(str(file))
        reflective |= not ours and looks_at_itself(content_of(file))
        for module in imported(file, package):
            if module not in counted:
                counted.add(module)
                count(module, inputs, waiting)
    if reflective:
        inputs.files.update({name: places.state("files", name) for name in inputs.modules})
    return inputs


def imported(file: Path, package: str) -> Iterator[ModuleType]:
    """The loaded modules that the import statements of a Python file name, packages above them included."""
    if file.suffix != ".py":
        return
    for name in named_modules(content_of(file), package):
        module = sys.modules.get(name)
        if isinstance(module, ModuleType):
            yield module


def absolute_name(node: ast.ImportFrom, package: str) -> str:
    """The module that ``from ... import`` names, without leading dots."""
    return resolved(node.module or "", node.level, package)


def resolved(name: str, level: int, package: str) -> str:
    """The absolute name of a module that is named with ``level`` leading dots within ``package``."""
    if not level:
        return name
    parts = package.split(".")[: len(package.split(".")) - level + 1]
    return ".".join([*parts, *([name] if name else [])])


def with_packages(names: set[str]) -> list[str]:
    """Names of modules and of the packages above them."""
    return sorted({".".join(name.split(".")[:count]) for name in names for count in range(1, name.count(".") + 2)})


def file_of(module: ModuleType) -> Path | None:
    """The file of a module, if it has one."""
    file = getattr(module, "__file__", None)
    return Path(file) if isinstance(file, str) else None


def package_of(module: ModuleType) -> str:
    """The package to which a module's relative imports refer."""
    name = module.__name__
    return name if hasattr(module, "__path__") else name.rpartition(".")[0]


def content_of(file: Path) -> bytes:
    """The bytes of a file; none where it cannot be read."""
    try:
        return file.read_bytes()
    except OSError:
        return b""


@lru_cache(maxsize=8192)  # fewer than a project has modules would keep none: they come in the same order each time
def named_modules(source: bytes, package: str) -> list[str]:
    """Return the modules that Python source imports, with packages above; none if it does not parse."""
    names: set[str] = set()
    try:
        tree = parsed(source)
    except (SyntaxError, ValueError):
        return []
    for node in _statements(tree):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = absolute_name(node, package)
            names.update([base, *(f"{base}.{alias.name}" for alias in node.names)])
    return with_packages(names)


def _statements(tree: ast.Module) -> Iterator[ast.AST]:
    """Yield all statements, those in functions and blocks, too; expressions import nothing."""
    waiting: list[ast.AST] = list(tree.body)
    while waiting:
        node = waiting.pop()
        yield node
        for block in ("body", "orelse", "finalbody", "handlers", "cases"):
            inner = getattr(node, block, None)
            if isinstance(inner, list):
                waiting.extend(inner)
