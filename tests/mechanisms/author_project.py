"""Projects and mechanism.py of a test's own, and every mechanism of the gallery with its variants."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import mechanisms
from mechanisms.stages.loading import inputs, loading
from shared.stage import paths
from shared.stage.paths import ROOT, mechanism_folder, planar_names, variants_in

HEAD = "from pathlib import Path\nfrom shared.shot import Shot\nHERE = Path(__file__).parent\n"

assert inputs.ROOT == ROOT  # loaded before a project of a test's own takes its place


class Project:
    """The mechanisms ``arm`` and ``other``, one stage of ``arm``, and how often that loads the author's file."""

    def __init__(self, root: Path, monkeypatch: pytest.MonkeyPatch, stage: ModuleType) -> None:
        self.root, self.patch, self.stage = root, monkeypatch, stage
        self.loads = 0
        monkeypatch.setattr(paths, "ROOT", root)
        for module in (paths, loading):
            monkeypatch.setattr(module, "MECHANISMS", root / "mechanisms")
        monkeypatch.setattr(mechanisms, "__path__", [*mechanisms.__path__, str(root / "mechanisms")])
        monkeypatch.setattr(sys, "path", list(sys.path))
        self._count(stage if hasattr(stage, "load") else loading)
        for name in ("arm", "other"):
            (root / "mechanisms" / name).mkdir(parents=True)
            (root / "mechanisms" / name / "mechanism.py").write_text("LENGTH = 1\n")
        self.folder = root / "mechanisms" / "arm"
        (root / "mbsd").symlink_to(ROOT / "mbsd")
        self._forget()  # what a project of another test left

    def _count(self, owner: ModuleType) -> None:
        plain = owner.load

        def load(name: str, file: loading.File) -> ModuleType:
            self.loads += 1
            return plain(name, file)

        self.patch.setattr(owner, "load", load)

    def shot(self, text: str) -> None:
        """Write shot.py, with what it always needs before ``text``."""
        (self.folder / "shot.py").write_text(HEAD + text)

    def run(self) -> bool:
        """Run the stage as a new process would; whether it loaded the author's file."""
        self._forget()
        before = self.loads
        self.stage.run("arm")
        return self.loads > before

    def _forget(self) -> None:
        for name, module in list(sys.modules.items()):
            own = str(getattr(module, "__file__", None) or "").startswith(str(self.root))
            if own or name.startswith(("mechanisms.arm", "mechanisms.other")):
                del sys.modules[name]


def write_file(path: str, text: str) -> Callable[[Project], None]:
    """Writes a file of the project."""

    def step(project: Project) -> None:
        file = project.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    return step


class Author:
    """A mechanism.py of the test's own: ``build``, and whatever else it defines."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, build: Any, **more: Any) -> None:
        self.build = build
        for name, value in more.items():
            setattr(self, name, value)
        monkeypatch.setattr(loading, "load", lambda *_: self)
        monkeypatch.setattr(loading, "params", lambda _: None)


def folders_and_variants() -> list[str]:
    """Return names of all mechanisms, each followed by those of its variants."""
    files = {owner: mechanism_folder(owner) / "mechanism.py" for owner in planar_names()}
    return [name for owner, file in files.items() for name in (owner, *(f"{owner}-{v}" for v in variants_in(file)))]
