"""The checks of a release, in order: each returns what it saw, or raises UserError with what is wrong."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path

from shared.stage.errors import UserError
from tools.release.archives import (
    built,
    clone,
    commit_time,
    differences,
    dirt,
    four_bar_in_a_new_environment,
    names_in,
    sums,
)
from tools.release.written import disagreements, faults_of_citation, notes, versions, wanted_version

# Licences of others in a wheel and in the pages that it makes: NOTICE.md must name them.


NOTICE = "NOTICE.md"
FILES = ("LICENSE", NOTICE)
OURS = (
    ".py", ".c", ".h", ".js", ".cjs", ".css", ".json", ".typed", ".txt", ".npmrc", ".nbi", ".nbc",
    "METADATA", "WHEEL", "RECORD", "LICENSE", NOTICE,
)  # fmt: skip
"""Endings of what we write ourselves, and of compiled kernels; a font, a picture, a library is somebody's."""
LOCK = Path("render/view/page/package-lock.json")
FOREIGN = re.compile(r"(?i)copyright|SPDX-License-Identifier|\blicen[sc]ed under\b|@license")
SAYS_SO = ("bundle.py", "document.py", "package-lock.json", "help.js", "layout.js", "LICENSE", NOTICE, "METADATA")
"""Files that speak of licences: those of the page's packages are written into each page."""


def faults_of_licences(names: Sequence[str], root: Path) -> list[str]:
    """A sentence for each licence that is missing in a wheel of these files, built from ``root``."""
    notice = (root / NOTICE).read_text() if (root / NOTICE).is_file() else ""
    missing = [f"the wheel has no {file}" for file in FILES if not any(_is_licence(name, file) for name in names)]
    unknown = [name for name in names if not name.endswith(OURS) and not _named(name, notice)]
    return [
        *missing,
        *(f"{name} is in the wheel and not in {NOTICE}; whose is it?" for name in unknown),
        *(f"{name} speaks of a licence and is not in {NOTICE}" for name in _with_foreign_words(names, root, notice)),
        *(f"{package} {version} ({licence}) goes into pages and is not in {NOTICE}"
          for package, version, licence in packages_of_the_page(root) if not _has_row(notice, package, licence)),
    ]  # fmt: skip


def packages_of_the_page(root: Path) -> list[tuple[str, str, str]]:
    """Name, version and licence of every package that is bundled into a page."""
    entries = json.loads((root / LOCK).read_text())["packages"]
    return [
        (name.rpartition("node_modules/")[2], entry["version"], entry["license"])
        for name, entry in entries.items()
        if name and not entry.get("dev")
    ]


def _is_licence(name: str, file: str) -> bool:
    return bool(re.search(rf"\.dist-info/licenses/{re.escape(file)}$", name))


def _named(name: str, notice: str) -> bool:
    return f"`{Path(name).name}`" in notice


def _with_foreign_words(names: Sequence[str], root: Path, notice: str) -> list[str]:
    """Sources in the wheel with a licence of their own in them."""
    return [
        name
        for name in names
        if not name.endswith(SAYS_SO) and (source := _source(name, root)) and not _named(name, notice)
        if FOREIGN.search(source.read_text("utf-8", errors="replace"))
    ]


def _source(name: str, root: Path) -> Path | None:
    path = root / name.removeprefix("mbsd/rooms/")
    return path if path.is_file() and path.suffix in (".py", ".c", ".h", ".js", ".cjs", ".css", ".txt") else None


def _has_row(notice: str, package: str, licence: str) -> bool:
    return any(f"| {package} |" in line and f"| {licence} |" in line for line in notice.splitlines())


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
