"""Logout: whether the system ends processes that a user has left running, and the remedy.

systemd does so where KillUserProcesses is set in logind.conf: a run then has to be in a scope of the user's manager,
and that manager has to linger.
"""

from __future__ import annotations

import getpass
import os
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

LINGERING = Path("/var/lib/systemd/linger")
QUESTION = (
    *("busctl", "get-property", "org.freedesktop.login1", "/org/freedesktop/login1"),
    *("org.freedesktop.login1.Manager", "KillUserProcesses"),
)


def ends_all() -> bool:
    """Return True if the system ends everything at the logout; False if that is unknown."""
    if shutil.which(QUESTION[0]) is None:
        return False
    try:
        answer = subprocess.run(QUESTION, capture_output=True, text=True, timeout=5)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return answer.returncode == 0 and answer.stdout.split() == ["b", "true"]


def scope() -> list[str]:
    """Return the words before a command that is to outlive the session; none if all commands do."""
    if not ends_all() or shutil.which("systemd-run") is None or not os.environ.get("XDG_RUNTIME_DIR"):
        return []
    return ["systemd-run", "--user", "--scope", "--quiet", "--collect"]


def warn_if_it_ends_all(warn: Callable[[str, str], None]) -> None:
    """Warn with a remedy if the system would end the run at the logout."""
    user = _user()
    if ends_all() and not (LINGERING / user).exists():
        warn("night", f"this system ends all programs of yours when you log out; run: loginctl enable-linger {user}")


def _user() -> str:
    try:
        return getpass.getuser()
    except (KeyError, OSError):
        return "$USER"
