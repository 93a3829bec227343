"""HEAD in a folder of its own."""

from __future__ import annotations

import subprocess
from pathlib import Path

from shared.stage.errors import UserError


def clone(root: Path, folder: Path) -> Path:
    """The committed files of the clone ``root``, in ``folder``."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    git(root, "clone", "--quiet", "--no-hardlinks", str(root), str(folder))
    return folder


def dirt(root: Path) -> list[str]:
    """Files that are changed, or new and not ignored."""
    return [line[3:] for line in git(root, "status", "--porcelain").splitlines()]


def commit_time(root: Path) -> int:
    """Seconds since 1970 of HEAD."""
    return int(git(root, "log", "-1", "--format=%ct"))


def git(root: Path, *words: str) -> str:
    """What git answers. Raises UserError with what it says where it fails."""
    done = subprocess.run(["git", *words], cwd=root, capture_output=True, text=True)
    if done.returncode:
        raise UserError(f"git {words[0]}: {done.stderr.strip()}")
    return done.stdout
