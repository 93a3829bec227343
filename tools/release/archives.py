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
    """Return names of archives that are in one build alone, or whose bytes differ; of a wheel also which members do."""
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
