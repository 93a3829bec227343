"""Inputs of a stage: files that an author's code reads, recorded while it runs, and their hashes."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import ModuleType
from typing import Any

from mbsd.dependencies import inputs as dependencies
from mbsd.dependencies import recording as recorded_reads
from mbsd.dependencies.imported import file_of, imported, modules_below, package_of
from mbsd.dependencies.inputs import Inputs, Places
from mbsd.dependencies.installed import distributions, is_installed
from mbsd.dependencies.recorder import Recorder
from shared.stage import paths
from shared.stage.files import file_hash, sources_hash
from shared.stage.memory import recalled
from shared.stage.paths import MECHANISMS, SOLVER, in_workshop

# The inputs of an author's code, named as a project names them: relative to it or to its folder of results.
#
# Their names are kept in a stage's stamp; what they hold goes into its key. Whether anything has changed is then known
# without running that code again, and a copy of the project elsewhere has the same keys; of files outside, the key
# holds the content alone. How inputs are recorded and hashed is in ``mbsd/dependencies/``, which parameter studies use
# as well.

PICTURES = ("mbsd/drawing",)
"""Sources that decide no number; what they draw has them in its key by their own name."""
RESULTS = "results:"
"""Before the names of files in the folder of results, which may be anywhere."""
WORKSHOP = "workshop:"
"""Before the names of files in a user's own folder of machines."""
ROOT = paths.ROOT
STAGES = str(ROOT / "mechanisms" / "stages") + os.sep
DOORS = str(ROOT / "mechanisms")
ROOMS = ("shared", "render", "mechanisms/stages/automatic")
PROGRAM = tuple(f"{folder}{os.sep}" for folder in (paths.SOLVER, *(ROOT / room for room in ROOMS)))


OURS = ("mbsd/", "shared/", "render/", "mechanisms/stages/")
"""Names of the program's files begin so."""


class _Project(Places):
    """The project; in a look at many stages every file is hashed once."""

    @property
    def root(self) -> Path:
        return paths.ROOT

    def name_of(self, path: str | os.PathLike[str]) -> str:
        absolute, results = Path(os.path.abspath(path)), Path(os.path.abspath(paths.out_root()))
        if absolute.is_relative_to(results):
            return RESULTS + absolute.relative_to(results).as_posix()
        machines = paths.MECHANISMS
        programs = absolute.is_relative_to(self.root) and not machines.is_relative_to(self.root)
        if paths.in_workshop() and absolute.is_relative_to(machines) and not programs:
            return WORKSHOP + absolute.relative_to(machines).as_posix()
        return super().name_of(path)

    def path_of(self, name: str) -> Path:
        if name.startswith(RESULTS):
            return Path(os.path.abspath(paths.out_root())) / name.removeprefix(RESULTS)
        if name.startswith(WORKSHOP):
            return paths.MECHANISMS / name.removeprefix(WORKSHOP)
        place = super().path_of(name)
        return place if name != "mbsd" or place.exists() else paths.SOLVER

    def is_program(self, file: str) -> bool:
        return file.startswith(PROGRAM)

    def acts_for_itself(self, file: str) -> bool:
        """Return True for the stages, except automatic parts, which act for the author."""
        return file.startswith(STAGES) or os.path.dirname(file) == DOORS

    def hash_of(self, path: Path) -> str:
        return file_hash(path)

    def module_state(self, name: str) -> str:
        """Return the hash: author's modules count by what they mean, the program's by their bytes."""
        if os.path.dirname(name) == "mechanisms" or name.startswith(OURS):
            return self.file_state(name)
        return recalled(("module", self.path_of(name)), lambda: super(_Project, self).module_state(name))

    def sources_state(self, name: str) -> str:
        folder = self.path_of(name)
        if not folder.exists():
            return "missing"
        leave_out = [self.path_of(other) for other in PICTURES if other != name]
        if folder == paths.ROOT.parent:  # an installed package, which brings the rooms in a folder of its own
            leave_out.append(paths.ROOT)
        return sources_hash(folder, leave_out=leave_out)

    def package_state(self, name: str) -> str:
        return recalled(("version or none", name), lambda: dependencies.package_state(name))


PROJECT = _Project(ROOT)
"""Names of files below the project, and what counts as its program."""
name_of, path_of, file_state = PROJECT.name_of, PROJECT.path_of, PROJECT.file_state
sources_state, package_state = PROJECT.sources_state, PROJECT.package_state


def observed(names: Any) -> Inputs | None:
    """Return the inputs with these names, from :meth:`Inputs.names`, as they are now.

    None if ``names`` are none.
    """
    return PROJECT.observed(names)


# Records what an author's code reads while it runs (mbsd/dependencies/recording.py), as inputs of the project.


@contextmanager
def recording() -> Iterator[Recorder]:
    """Record what the author's code reads in this block."""
    with recorded_reads.recording(Recorder(PROJECT)) as recorder:
        yield recorder


# Finds the files that the author's code consists of: the modules it imports, and what those import in turn.
#
# In the program's own rooms, a module that the author's code imports counts with those that it imports itself; the
# solver counts as a whole, without its drawing. Installed packages count by their version.


def loaded_inputs(start: Path, package: str, before: set[str], leave_out: Path | None = None) -> Inputs:
    """Return files, rooms and packages that ``start``, a file of the package ``package``, was made of.

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
    """Return the author's own files that ``start`` was made of, itself included, each with its package."""
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
    """Return True if a file belongs neither to an installed package nor to the program."""
    if is_installed(str(file)):
        return False
    if in_workshop() and MECHANISMS.is_relative_to(ROOT) and file.is_relative_to(MECHANISMS):
        return True
    ours = [ROOT / room for room in ("mbsd", "shared", "render", "tests", "mechanisms/stages")]
    return file.parent != ROOT / "mechanisms" and not any(file.is_relative_to(room) for room in ours)
