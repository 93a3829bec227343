"""``make release``: sdist, wheel, hashes and NOTES.md in dist/, if all that a release promises holds.

    python -m tools.release [--out FOLDER] [--only WORD] [--pythons VERSION ...]

Everything is built from a clone of HEAD in a temporary folder; nothing is tagged and nothing leaves the machine. Checks
go on after a failure, so that one run names all; ``--only`` runs those whose names hold a word, and writes nothing.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

from shared.stage.console import run_cli, say, warn
from shared.stage.errors import UserError
from shared.stage.files import write_bytes
from shared.stage.paths import ROOT
from tools.release.archives import built, clone, commit_time, sums
from tools.release.checks import CHECKS, Release
from tools.release.written import notes, wanted_version

PYTHONS = ("3.11", "3.12", "3.13", "3.14")
"""Versions whose wheels have compiled kernels; uv finds or fetches them."""


def main() -> int:
    """Run the checks; 1 if any failed, and then nothing is written."""
    parser = argparse.ArgumentParser("tools.release", description=__doc__)
    parser.add_argument("--out", type=Path, default=ROOT / "dist", help="the folder, dist if not given")
    parser.add_argument("--only", default="", help="checks whose names hold this word")
    parser.add_argument("--pythons", nargs="*", default=PYTHONS, help="versions with compiled kernels in their wheels")
    asked = parser.parse_args()
    chosen = {name: check for name, check in CHECKS.items() if asked.only in name}
    if not chosen:
        raise UserError(f"release: no check is called '{asked.only}'; there is: {', '.join(CHECKS)}")
    with tempfile.TemporaryDirectory(prefix="mbsd-release-") as folder:
        release = Release(ROOT, clone(ROOT, Path(folder) / "first"), Path(folder))
        failed = [name for name, check in chosen.items() if not passes(name, check, release)]
        if failed:
            raise UserError(f"release: {len(failed)} of {len(chosen)} checks failed: {', '.join(failed)}")
        if not asked.only:
            write(release, asked.out, asked.pythons)
    return 0


def passes(name: str, check: object, release: Release) -> bool:
    """Return True if a check holds; its line says what it saw or what is wrong."""
    assert callable(check)
    try:
        say("release", f"{name}: {check(release)}")
    except UserError as error:
        warn("release", f"{name}: {error}")
        return False
    return True


def write(release: Release, out: Path, pythons: Sequence[str]) -> None:
    """Write the archives, with compiled kernels for these Pythons, their hashes and the notes of the tag."""
    version = wanted_version(release.sources)
    archives = built(release.sources, release.folder / "released", commit_time(release.sources), pythons)
    files = {path.name: path.read_bytes() for path in archives}
    files["SHA256SUMS"] = sums(archives).encode()
    files["NOTES.md"] = notes(release.text("CHANGELOG.md"), version).encode()
    for name, content in files.items():
        write_bytes(out / name, content)
    say("release", f"{version}: {', '.join(files)} in {out}")
    say("release", f"the tag: git tag -a v{version} -F {out / 'NOTES.md'} --cleanup=whitespace")


if __name__ == "__main__":
    run_cli(main)
