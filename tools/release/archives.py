"""HEAD in a clone of its own; its sdist and wheel, built, hashed and compared."""

from __future__ import annotations

import hashlib
import os
import subprocess
import sys
import zipfile
from collections.abc import Sequence
from pathlib import Path

from shared.stage.errors import UserError


def clone(root: Path, folder: Path) -> Path:
    """Clone the committed files of the clone ``root``, in ``folder``."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    git(root, "clone", "--quiet", "--no-hardlinks", str(root), str(folder))
    return folder


def dirt(root: Path) -> list[str]:
    """Return files that are changed, or new and not ignored."""
    return [line[3:] for line in git(root, "status", "--porcelain").splitlines()]


def commit_time(root: Path) -> int:
    """Return the time of HEAD (s since 1970)."""
    return int(git(root, "log", "-1", "--format=%ct"))


def git(root: Path, *words: str) -> str:
    """Return the answer of git. Raises UserError with its words where it fails."""
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True)
    if done.returncode:
        raise UserError(f"git {words[0]}: {done.stderr.strip()}")
    return done.stdout


def built(sources: Path, out: Path, time: int, pythons: Sequence[str] = (), **environment: str) -> list[Path]:
    """Build the archives by ``tools.wheel`` of the clone itself, as of ``time`` (s since 1970).

    ``pythons``: versions of Python for which there is a wheel with compiled kernels, too. ``UMASK`` in ``environment``
    is the mask of the process, in octal.
    """
    mask = environment.pop("UMASK", None)
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "MBSD_", "NUMBA_"))}
    variables = kept | {"SOURCE_DATE_EPOCH": str(time), "PYTHONDONTWRITEBYTECODE": "1"} | environment
    done = subprocess.run(
        [sys.executable, "-m", "tools.wheel", "--out", str(out), *(["--kernels", *pythons] if pythons else [])],
        cwd=sources,
        env=variables,
        umask=int(mask, 8) if mask else -1,
        capture_output=True,
        text=True,
    )
    if done.returncode:
        raise UserError(f"{' '.join(done.stderr.split())[-600:]}")
    return sorted(out.iterdir())


def sums(paths: Sequence[Path]) -> str:
    """Return hashes as ``sha256sum -c`` reads them."""
    return "".join(f"{_hash(path)}  {path.name}\n" for path in paths)


def differences(first: Sequence[Path], second: Sequence[Path]) -> list[str]:
    """Return names of archives that are in one build alone, or whose bytes differ.

    Of a wheel also which members do.
    """
    ours, theirs = ({path.name: path for path in paths} for paths in (first, second))
    alone = sorted(set(ours) ^ set(theirs))
    other = [name for name in sorted(set(ours) & set(theirs)) if _hash(ours[name]) != _hash(theirs[name])]
    return alone + [f"{name}{_members(ours[name], theirs[name])}" for name in other]


def names_in(wheel: Path) -> list[str]:
    """Return the names of files in a wheel."""
    with zipfile.ZipFile(wheel) as archive:
        return archive.namelist()


def _members(first: Path, second: Path) -> str:
    if first.suffix != ".whl":
        return ""
    one_by_one = [_checksums(path) for path in (first, second)]
    names = sorted(
        name for name in {*one_by_one[0], *one_by_one[1]} if one_by_one[0].get(name) != one_by_one[1].get(name)
    )
    return f" ({', '.join(names[:5])})" if names else ""


def _checksums(wheel: Path) -> dict[str, object]:
    """Return content, time and mode of each file."""
    with zipfile.ZipFile(wheel) as archive:
        return {entry.filename: (entry.CRC, entry.date_time, entry.external_attr) for entry in archive.infolist()}


def _hash(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


# The wheel as a user gets it: a new environment, pip, and a four-bar whose angles are known.


FOUR_BAR = """
import math
import numpy as np
from mbsd import Mechanism, constant_rate
m = Mechanism("four_bar")
crank, coupler, rocker = m.bar("crank", 0.04), m.bar("coupler", 0.12), m.bar("rocker", 0.09)
m.revolute("A", m.ground.at(0, 0), crank.start)
m.revolute("B", crank.end, coupler.start)
m.revolute("C", coupler.end, rocker.end)
m.revolute("D", m.ground.at(0.12, 0), rocker.start)
m.drive_angle("motor", crank, constant_rate(2 * math.pi))
m.start_near(crank=0, coupler=45, rocker=100)
sol = m.sweep()
r, c = sol.body("rocker").theta, sol.body("crank").theta
dx = 0.12 + 0.09 * np.cos(r) - 0.04 * np.cos(c)
dy = 0.09 * np.sin(r) - 0.04 * np.sin(c)
assert len(r) == 361 and abs(dx**2 + dy**2 - 0.12**2).max() < 1e-14
"""
"""The coupler's length, squared (m^2), must be what it is at every angle."""
SAID = """
import sys
from importlib.metadata import metadata
import mbsd
assert mbsd.__file__.startswith(sys.prefix), mbsd.__file__
print(metadata("mbsd")["Version"], metadata("mbsd")["License-Expression"], f"{np.degrees(np.ptp(r)):.2f}")
"""


def four_bar_in_a_new_environment(wheel: Path, folder: Path) -> str:
    """Install the wheel in ``folder`` and solve.

    Raises UserError where a step fails, with the last lines of it.
    """
    _run([sys.executable, "-m", "venv", str(folder)], "a new environment could not be made")
    pip = [str(folder / "bin" / "pip"), "--disable-pip-version-check"]
    _run([*pip, "install", "--quiet", str(wheel)], "pip could not install the wheel (a network is needed)")
    _run([*pip, "check"], "the installed packages do not fit each other")
    said = _run(
        [str(folder / "bin" / "python"), "-P", "-c", FOUR_BAR + SAID], "the four-bar could not be solved", folder
    )
    version, licence, swing = said.split()
    expected = wheel.name.split("-")[1]
    if version != expected:
        raise UserError(f"the installed package says {version}, its wheel {expected}")
    return f"mbsd {version} ({licence}) solves a four-bar whose rocker swings through {swing} degrees"


def _run(command: list[str], refusal: str, cwd: Path | None = None) -> str:
    away = ("PYTHONPATH", "NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT")
    environment = {name: value for name, value in os.environ.items() if name not in away}
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise UserError(f"{refusal}: {' '.join((done.stderr or done.stdout).split())[-600:]}")
    return done.stdout
