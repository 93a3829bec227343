"""Finds the files that the author's code consists of: the modules it imports, and what those import in turn.

In the program's own rooms, a module that the author's code imports counts with those that it imports itself; the solver
counts as a whole, without its drawing. Installed packages count by their version.
"""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType

from mbsd.dependencies.imported import file_of, imported, modules_below, package_of
from mbsd.dependencies.installed import distributions, is_installed
from mechanisms.stages.loading.inputs import PROJECT, ROOT, Inputs, package_state, sources_state
from shared.stage.paths import MECHANISMS, SOLVER, in_workshop


def loaded_inputs(start: Path, package: str, before: set[str], leave_out: Path | None = None) -> Inputs:
    """Files, rooms and packages that ``start``, a file of the package ``package``, was made of.

    ``before``: names of the modules that were loaded before it; later ones count although no import
    statement names them. ``leave_out`` and what only that file imports do not count.
    """
    later = [
        (file, package_of(module))
        for name, module in list(sys.modules.items())
        if name not in before and (file := file_of(module)) is not None and _is_authors(file) and file != leave_out
    ]
    return modules_below([(start, package), *later], PROJECT, _count, leave_out)


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
            below = file_of(module)
            if below is not None and _is_authors(below):
                waiting.append((below, package_of(module)))
    return list(seen.items())


def _count(module: ModuleType, inputs: Inputs, waiting: list[tuple[Path, str]]) -> None:
    top = module.__name__.partition(".")[0]
    file = file_of(module)
    if file is None:
        return
    if is_installed(str(file)):
        for name in distributions(top):
            if name not in inputs.packages:
                inputs.packages[name] = package_state(name)
    elif top == "mbsd" and file.is_relative_to(SOLVER):
        folders = ["mbsd", "mbsd/drawing"] if file.is_relative_to(SOLVER / "drawing") else ["mbsd"]
        for folder in folders:
            if folder not in inputs.sources:  # hundreds of modules, and hashing reads all files
                inputs.sources[folder] = sources_state(folder)
    else:
        waiting.append((file, package_of(module)))


def _is_authors(file: Path) -> bool:
    """Whether a file belongs neither to an installed package nor to the program."""
    if is_installed(str(file)):
        return False
    if in_workshop() and MECHANISMS.is_relative_to(ROOT) and file.is_relative_to(MECHANISMS):
        return True
    ours = [ROOT / room for room in ("mbsd", "shared", "render", "tests", "mechanisms/stages")]
    return file.parent != ROOT / "mechanisms" and not any(file.is_relative_to(room) for room in ours)
