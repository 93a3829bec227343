"""``make check``: versions, packages against the lock, libraries and disk space of this computer."""

from __future__ import annotations

import platform
import re
import shutil
from importlib import metadata
from pathlib import Path

from shared.stage.console import run_cli, say, warn
from shared.stage.paths import ROOT, out_root
from shared.system.missing import missing_libraries, missing_programs, sentence

SHOWN = ("numpy", "scipy", "numba", "cadquery", "trimesh", "manifold3d", "bpy", "matplotlib", "imageio-ffmpeg")
"""Packages whose versions are printed; all of the lock are compared."""
ROOM = 5e9
"""Bytes: below this much free disk a film at the larger presets may not fit."""


def main() -> int:
    """Print the findings, a line each; 1 if something stands in the way of a run, else 0."""
    say("python", f"{platform.python_version()} on {platform.system()} {platform.machine()}")
    say("packages", ", ".join(f"{name} {metadata.version(name)}" for name in SHOWN))
    faults = [*_wrong_packages(), *_missing_libraries()]
    _tell_programs()
    faults += _full_disk()
    for fault in faults:
        warn("check", fault)
    return 1 if faults else 0


def locked(lock: Path) -> dict[str, str]:
    """Names and versions in a lock file; those for another system (behind a ``;``) are left out."""
    lines = re.findall(r"^([A-Za-z0-9._-]+)==(\S+)( ;)?", lock.read_text(), flags=re.MULTILINE)
    return {name: version for name, version, elsewhere in lines if not elsewhere}


def _wrong_packages() -> list[str]:
    wrong = []
    for name, version in locked(ROOT / "requirements.lock").items():
        try:
            installed = metadata.version(name)
        except metadata.PackageNotFoundError:
            installed = "missing"
        if installed != version:
            wrong.append(f"{name} is {installed}, requirements.lock has {version}; remove .venv and run make install")
    return wrong


def _missing_libraries() -> list[str]:
    names = missing_libraries()
    if not names:
        say("system libraries", "all found")
        return []
    return [sentence(names)]


def _tell_programs() -> None:
    """Say which programs are missing; none of them stands in the way of a run."""
    names = missing_programs()
    say("programs", sentence(programs=names) + "; some commands and tests want them" if names else "all found")


def _full_disk() -> list[str]:
    folder = out_root()
    while not folder.exists():
        folder = folder.parent
    free = shutil.disk_usage(folder).free
    say("disk", f"{free / 1e9:.0f} GB free for results")
    return [f"only {free / 1e9:.1f} GB free at {folder}; a film may not fit"] if free < ROOM else []


if __name__ == "__main__":
    run_cli(main)
