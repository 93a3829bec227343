"""Films of the project fetched to another folder through an sshd on loopback, and what is wrong with what came."""

from __future__ import annotations

import getpass
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from shared.system.missing import missing_programs
from tests.studio.night.torture.project import Project

PROGRAMS = ("rsync", "ssh", "ssh-keygen", "sshd")
PATIENCE = 120.0
"""Seconds that a fetch may take."""


def is_possible() -> bool:
    """Return True if this machine has the programs."""
    return not missing_programs(PROGRAMS)


def fetch_killed(project: Project, chance: random.Random) -> bool:
    """Begin to fetch and end that by SIGKILL, SIGTERM or SIGINT a moment later."""
    run = subprocess.Popen(_command(project), env=_environment(project), stdout=subprocess.DEVNULL)
    time.sleep(chance.uniform(0.0, 1.5))
    run.send_signal(chance.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT]))
    run.wait(timeout=PATIENCE)
    return True


def fetch_again(project: Project) -> int:
    """Fetch to the end: films that are not those of the project, byte by byte, missing and left over."""
    done = subprocess.run(
        _command(project), env=_environment(project), capture_output=True, text=True, timeout=PATIENCE
    )
    films = {path.name: path.read_bytes() for path in project.films}
    home = _home(project)
    came = {path.name: path.read_bytes() for path in (home / "films").iterdir()}
    wrong = sum(films.get(name) != content for name, content in came.items())
    wrong += len(films.keys() - came.keys()) + int(done.returncode != 0)
    wrong += sum(path.name != "films" for path in home.iterdir())
    shutil.rmtree(home)
    return wrong


def _home(project: Project) -> Path:
    return project.folder / "home"


def _command(project: Project) -> list[str]:
    host = f"{getpass.getuser()}@127.0.0.1"
    return [sys.executable, "-m", "studio.fetch", host, "--folder", str(project.disk)]


def _environment(project: Project) -> dict[str, str]:
    return project.environment() | {"MBSD_OUT": str(_home(project)), "RSYNC_RSH": os.environ["MBSD_TORTURE_RSH"]}
