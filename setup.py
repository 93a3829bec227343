"""Brings the rooms beside the solver into the package ``mbsd``, below ``mbsd/rooms``: they are no names for themselves.

The program ``mbsd`` puts that folder on the path of its own processes alone (mbsd/__main__.py).
"""

import shutil
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.build_py import build_py

ROOMS = ("mechanisms", "render", "shared", "studio")


class WithRooms(build_py):
    """Copies the rooms as they are, without the mechanisms of the gallery."""

    def run(self) -> None:
        """Build the package, then copy."""
        super().run()
        if self.editable_mode:
            return
        for room in ROOMS:
            target = Path(self.build_lib) / "mbsd" / "rooms" / room
            shutil.rmtree(target, ignore_errors=True)
            shutil.copytree(room, target, ignore=_left_out)


def _left_out(folder: str, names: list[str]) -> set[str]:
    gallery = {name for name in names if (Path(folder) / name / "mechanism.py").is_file()}
    return gallery | {name for name in names if name == "__pycache__" or name.endswith(".pyc")}


class WithMachineCode(Distribution):
    """A wheel with compiled kernels inside: its tag names Python and platform."""

    def has_ext_modules(self) -> bool:
        """It has."""
        return True


compiled = Path("mbsd", "kernels", "made_for.json").is_file()
setup(cmdclass={"build_py": WithRooms}, distclass=WithMachineCode if compiled else Distribution)
