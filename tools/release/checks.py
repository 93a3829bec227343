"""The checks of a release, in order: each returns what it saw, or raises UserError with what is wrong."""

from __future__ import annotations

import shutil
import subprocess
import sys
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path

from shared.stage.errors import UserError
from tools.release.archives import built, clone, commit_time, differences, dirt, names_in, sums
from tools.release.installed import four_bar_in_a_new_environment
from tools.release.licences import faults_of_licences
from tools.release.written import disagreements, faults_of_citation, notes, versions, wanted_version


class Release:
    """The clone that is released; archives are built once, when a check first asks."""

    def __init__(self, root: Path, sources: Path, folder: Path) -> None:
        self.root, self.sources, self.folder = root, sources, folder
        self._archives: list[Path] = []

    def archives(self) -> list[Path]:
        """The sdist and the wheel."""
        if not self._archives:
            self._archives = built(self.sources, self.folder / "archives", commit_time(self.sources))
        return self._archives

    def text(self, name: str) -> str:
        """A file of the clone. Raises UserError where it is missing."""
        path = self.sources / name
        if not path.is_file():
            raise UserError(f"there is no {name}; write it")
        return path.read_text()

    @property
    def wheel(self) -> Path:
        """The wheel."""
        return next(path for path in self.archives() if path.suffix == ".whl")


def clean_tree(release: Release) -> str:
    """Nothing that is not committed: what is tested is what is released."""
    _refuse(dirt(release.root), "is not committed; commit or remove it")
    return "all that is here is committed"


def same_version(release: Release) -> str:
    """pyproject.toml, the package, CITATION.cff and CHANGELOG.md say the same version."""
    _refuse(disagreements(versions(release.sources)), "")
    return f"{wanted_version(release.sources)} everywhere"


def citation(release: Release) -> str:
    """CITATION.cff says what its format asks for."""
    _refuse(faults_of_citation(release.text("CITATION.cff")), "")
    return "CITATION.cff is complete"


def notes_of_the_tag(release: Release) -> str:
    """CHANGELOG.md has a section of this version that says something."""
    written = notes(release.text("CHANGELOG.md"), wanted_version(release.sources))
    return f"{len(written.splitlines())} lines"


def same_bytes(release: Release) -> str:
    """Another clone in another folder gives the same archives."""
    other = clone(release.root, release.folder / "second" / "deeper")
    again = built(other, release.folder / "again", commit_time(other), TZ="Pacific/Auckland", LC_ALL="C", UMASK="077")
    _refuse(differences(release.archives(), again), "differs in a second build; something tells time or place")
    return ", ".join(line.split()[0][:12] + " " + line.split()[1] for line in sums(again).splitlines())


def licences(release: Release) -> str:
    """Check that NOTICE.md names what the wheel brings of others, and that it has both licence files."""
    _refuse(faults_of_licences(names_in(release.wheel), release.sources), "")
    return "LICENSE and NOTICE.md are in the wheel and name all that is not ours"


def installs(release: Release) -> str:
    """The wheel in a new environment, where it solves a four-bar."""
    return four_bar_in_a_new_environment(release.wheel, release.folder / "environment")


def metadata(release: Release) -> str:
    """Check the metadata by twine, where it is installed."""
    program = [sys.executable, "-m", "twine"] if find_spec("twine") else [shutil.which("twine") or ""]
    if not program[-1]:
        return "twine is not here and was not asked (pip install twine)"
    command = [*program, "check", "--strict", *map(str, release.archives())]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise UserError((done.stdout + done.stderr).strip()[-800:])
    return "twine has nothing against it"


def _refuse(faults: list[str], what: str) -> None:
    if faults:
        raise UserError("; ".join(f"{fault} {what}".strip() for fault in faults[:20]))


CHECKS: dict[str, Callable[[Release], str]] = {
    "clean tree": clean_tree,
    "same version": same_version,
    "citation": citation,
    "notes": notes_of_the_tag,
    "same bytes": same_bytes,
    "licences": licences,
    "metadata": metadata,
    "installs": installs,
}
"""By the name under which a failure is reported."""
