"""The inputs of an author's code, named as a project names them: relative to it or to its folder of results.

Their names are kept in a stage's stamp; what they hold goes into its key. Whether anything has changed is then known
without running that code again, and a copy of the project elsewhere has the same keys; of files outside, the key holds
the content alone. How inputs are recorded and hashed is in ``mbsd/dependencies/``, which parameter studies use as well.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

from mbsd.dependencies import inputs as dependencies
from mbsd.dependencies.inputs import Inputs, Places
from shared.stage import paths
from shared.stage.files import file_hash, sources_hash
from shared.stage.memory import recalled

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
        """The stages, except automatic parts, which act for the author."""
        return file.startswith(STAGES) or os.path.dirname(file) == DOORS

    def hash_of(self, path: Path) -> str:
        return file_hash(path)

    def module_state(self, name: str) -> str:
        """The author's modules count by what they mean; those of the program by their bytes, as in the stages' keys."""
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
    """What the inputs with these names, from :meth:`Inputs.names`, hold now; None if that is not what ``names`` are."""
    return PROJECT.observed(names)
