"""A project of one tiny film in a folder of its own, with this project's Makefile and scripts, on a small disk."""

from __future__ import annotations

import os
import shutil
import signal
import stat
import subprocess
import sys
from dataclasses import dataclass, field
from pathlib import Path

from render.frames.store import FrameStore
from shared.contract.shot import Shot
from shared.stage.paths import ROOT, Out
from tools.torture.processes import Process, processes

NAME = "four_bar"
SHOT = Shot(turns=2, seconds_per_turn=0.2)
"""Six pictures, shown twice."""
DISK = 300
"""Megabytes of the disk in memory: a film is refused below 200."""
PATIENCE = 12.0
"""Seconds of a picture in which Blender may be silent; 30 for its start."""
STAND_IN = """#!/bin/sh
# Stands for .venv/bin/python where make calls `python -m mechanisms|render STAGE NAME ...`.
case "$2 $3" in
"studio.night "*) exec '{python}' "$@" ;;
*parts) stage=inputs ;;
*film) stage=film ;;
*) exit 0 ;;
esac
exec '{python}' -m tools.torture.stage $stage "$4" '{folder}'
"""


@dataclass
class Project:
    """Its folder, and the make that runs in it."""

    folder: Path
    mounted: bool = False
    runs: list[subprocess.Popen[bytes]] = field(default_factory=list)

    @property
    def disk(self) -> Path:
        """The small disk, which holds the results alone."""
        return self.folder / "disk"

    @property
    def out(self) -> Out:
        """The results."""
        return Out(NAME)

    @property
    def store(self) -> FrameStore:
        """The pictures."""
        return FrameStore(self.out.frames("draft"))

    @property
    def film(self) -> Path:
        """The finished film."""
        return self.out.film("draft")

    def build(self) -> None:
        """Write everything, and mount the disk where that is allowed."""
        from tests.render import film_fixture

        os.environ["MBSD_OUT"] = str(self.disk / "out")
        self.disk.mkdir(parents=True)
        mount = ["mount", "-t", "tmpfs", "-o", f"size={DISK}m", "none", str(self.disk)]
        self.mounted = shutil.which("mount") is not None and not subprocess.run(mount, capture_output=True).returncode
        for name in ("Makefile", "requirements.lock"):
            shutil.copy(ROOT / name, self.folder)
        shutil.copytree(
            ROOT / "tools", self.folder / "tools", ignore=lambda _, names: {n for n in names if n[-3:] != ".sh"}
        )
        (self.folder / ".venv").symlink_to(ROOT / ".venv")
        script = self.folder / "python"
        script.write_text(STAND_IN.format(python=sys.executable, folder=self.folder))
        script.chmod(script.stat().st_mode | stat.S_IXUSR)
        film_fixture.write(SHOT, NAME)
        shutil.move(self.out.folder, self.folder / "inputs")

    def forget(self) -> None:
        """Remove all results, so that the next round does not suffer from this one."""
        shutil.rmtree(self.disk / "out", ignore_errors=True)

    def remove(self) -> None:
        """Leave nothing behind."""
        self.kill()
        if self.mounted:
            subprocess.run(["umount", "-l", str(self.disk)], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)

    def start(self) -> subprocess.Popen[bytes]:
        """Start ``make run-all PRESET=draft`` as a user does; what it says goes to said.txt."""
        inherited = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MBSD_MAKE", "COLUMNS")
        environment = {key: value for key, value in os.environ.items() if key not in inherited}
        environment |= {
            "MBSD_OUT": str(self.disk / "out"),
            "MBSD_PATIENCE": str(PATIENCE),
            "PYTHONPATH": str(ROOT),
            "PYTHONSAFEPATH": "1",
        }
        with (self.folder / "said.txt").open("ab") as said:
            run = subprocess.Popen(
                ["make", "-o", "install", "run-all", "PRESET=draft", f"ONLY={NAME}", f"PYTHON={self.folder}/python"],
                cwd=self.folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
                start_new_session=True,
                preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL) and None,
            )
        self.runs.append(run)
        return run

    def said(self) -> str:
        """What make and its stages said since :meth:`hush`."""
        path = self.folder / "said.txt"
        return path.read_text(errors="replace") if path.exists() else ""

    def hush(self) -> None:
        """Forget what was said."""
        (self.folder / "said.txt").unlink(missing_ok=True)

    def alive(self) -> list[Process]:
        """Every process of the runs, also those that lost their parent."""
        groups = {run.pid for run in self.runs}
        return [p for p in processes() if p.group in groups or str(self.folder) in p.arguments]

    def kill(self) -> None:
        """End every process of the runs."""
        for process in self.alive():
            process.send(signal.SIGKILL)
        for run in self.runs:
            run.wait()
        self.runs.clear()
