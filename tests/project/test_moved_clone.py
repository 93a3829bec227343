"""A clone that was copied or moved with its environment imports its own sources and runs its own Python."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import venv
from pathlib import Path

import pytest

from tests.running.make import copy_tools, run

WHERE = "import mbsd, sys; print(mbsd.PLACE, sys.prefix)"
EDITABLE = """
import sys
from importlib.machinery import PathFinder
class Finder:
    @staticmethod
    def find_spec(name, path=None, target=None):
        return PathFinder.find_spec(name, [{root!r}]) if name == "mbsd" else None
sys.meta_path.append(Finder)
"""
"""An editable installation of setuptools: it knows the folder by its absolute path."""


class Clone:
    """A small project with an environment of nothing but Python."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def make(self, movable: bool) -> None:
        """As the installation made it, or as it did before environments could be moved."""
        copy_tools(self.folder)
        self.source("old")
        for lock in ("requirements.lock", "requirements-bench.lock"):
            (self.folder / lock).write_text("")
        environment = self.folder / ".venv"
        venv.create(environment, symlinks=True, with_pip=False)
        for done in ("requirements.lock", "kernels-compiled", "libraries-found"):
            (environment / done).touch()
        tool = environment / "bin" / "tool"
        # As uv writes it where the path has blanks in it.
        tool.write_text(f"#!/bin/sh\n'''exec' '{environment}/bin/python' \"$0\" \"$@\"\n' '''\n{WHERE}\n")
        tool.chmod(0o755)
        if movable:
            assert self.install() == ""
            return
        [packages] = environment.glob("lib/python3*/site-packages")
        (packages / "__editable___mbsd_0_1_0_finder.py").write_text(EDITABLE.format(root=str(self.folder)))
        (packages / "__editable__.mbsd-0.1.0.pth").write_text("import __editable___mbsd_0_1_0_finder")

    def source(self, place: str) -> None:
        (self.folder / "mbsd").mkdir(exist_ok=True)
        (self.folder / "mbsd" / "__init__.py").write_text(f"PLACE = {place!r}\n")

    def install(self) -> str:
        """Return the output of the installation step; uv is one that only marks the environment."""
        programs = self.folder / "programs"
        programs.mkdir(exist_ok=True)
        uv = programs / "uv"
        uv.write_text('#!/bin/sh\n[ "$1" = --version ] || echo "relocatable = true" >>.venv/pyvenv.cfg\n')
        uv.chmod(0o755)
        path = f"{programs}:{os.environ['PATH']}"
        done = run("sh", "tools/install.sh", cwd=self.folder, PATH=path, HOME=str(self.folder))
        assert done.returncode == 0, done.stderr
        return done.stdout + done.stderr

    def python(self) -> str:
        """Return the sources and the environment that a script of another folder gets."""
        return self._said("python", "-c", WHERE)

    def tool(self) -> str:
        """The same of a program of the environment."""
        return self._said("tool")

    def _said(self, program: str, *arguments: str) -> str:
        environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
        command = [str(self.folder / ".venv" / "bin" / program), *arguments]
        done = subprocess.run(command, cwd="/", env=environment, capture_output=True, text=True)
        return done.stdout.strip() + done.stderr.strip()

    def expected(self, place: str) -> str:
        return f"{place} {self.folder / '.venv'}"


def copied(clone: Clone, target: Path) -> Clone:
    """With hard links, as ``cp -al`` does; the source is edited in the copy."""
    shutil.copytree(clone.folder, target, symlinks=True, copy_function=os.link)
    (target / "mbsd" / "__init__.py").unlink()
    other = Clone(target)
    other.source("new")
    return other


@pytest.fixture
def here(tmp_path: Path) -> Path:
    return tmp_path.resolve() / "my clones"


@pytest.mark.skipif(sys.platform == "win32", reason="environments have another layout")
def test_a_copy_imports_its_own_sources_without_an_installation(here: Path) -> None:
    old = Clone(here / "old")
    old.make(movable=True)
    new = copied(old, here / "new one")
    for _ in range(2):  # side by side, and again after make looked at both
        assert (old.python(), old.tool()) == (old.expected("old"), old.expected("old"))
        assert (new.python(), new.tool()) == (new.expected("new"), new.expected("new"))
        assert old.install() == new.install() == ""
    shutil.rmtree(old.folder)
    assert (new.python(), new.tool()) == (new.expected("new"), new.expected("new"))


@pytest.mark.skipif(sys.platform == "win32", reason="environments have another layout")
@pytest.mark.parametrize("gone", [False, True], ids=["beside it", "gone"])
def test_make_mends_a_copy_of_an_environment_that_knew_its_place(here: Path, gone: bool) -> None:
    old = Clone(here / "old")
    old.make(movable=False)
    new = copied(old, here / "new one")
    assert new.python() == new.expected("old")  # the fault that is mended
    assert new.tool() == old.expected("old")
    if gone:
        old.folder.rename(here / "elsewhere")
    assert new.install() == ""
    assert (new.python(), new.tool()) == (new.expected("new"), new.expected("new"))
    if not gone:  # it shares files with the copy
        assert (old.python(), old.tool()) == (old.expected("old"), old.expected("old"))
