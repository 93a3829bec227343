"""A project of tiny films in a folder of its own, with this project's Makefile and scripts, on a small disk."""

from __future__ import annotations

import os
import shutil
import signal
import stat
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

from render.frames.store import FrameStore
from shared.contract.shot import Camera, Shot
from shared.stage.paths import ROOT, Out
from shared.stage.signals import end_with_parent
from studio.night import runs
from tests.studio.night.torture.stage import RENDERED
from tests.studio.night.torture.workers import Workers

SHOTS = {
    "four_bar": Shot(turns=2, seconds_per_turn=0.2),
    "pendulum": Shot(turns=1, seconds_per_turn=0.14, camera=Camera(azimuth=30.0)),
}
"""Two films: six pictures shown twice, and four."""
COORDINATOR = "studio.night run"
DISK = 300
"""Megabytes of the disk in memory: a film is refused below 200."""
PATIENCE = 12.0
"""Seconds of a picture in which Blender may be silent; 30 for its start."""
STAND_IN = """#!/bin/sh
# Stands for .venv/bin/python where make calls `python -m mechanisms|render STAGE NAME ...`.
case "$2 $3" in
"studio.command "*|"studio.night "*) exec '{python}' "$@" ;;
*parts) stage=inputs ;;
*film) stage=film ;;
*) exit 0 ;;
esac
exec '{python}' -m tests.studio.night.torture.stage $stage "$4" '{folder}'
"""


@dataclass
class Project:
    """Folder of the project, and the make that runs in it."""

    folder: Path
    mounted: bool = False
    workers: Workers | None = None
    """The cluster for rounds that have one."""
    clustered: bool = False
    """True if it renders the pictures now."""
    runs: list[subprocess.Popen[bytes]] = field(default_factory=list)

    @property
    def disk(self) -> Path:
        """The small disk, which holds the results alone."""
        return self.folder / "disk"

    @property
    def outs(self) -> list[Out]:
        """The results."""
        return [Out(name) for name in SHOTS]

    @property
    def stores(self) -> list[FrameStore]:
        """The pictures."""
        return [FrameStore(out.frames("draft")) for out in self.outs]

    @property
    def films(self) -> list[Path]:
        """Return the finished films."""
        return [out.film("draft") for out in self.outs]

    def pictures(self) -> list[Path]:
        """Return the existing pictures."""
        return [path for store in self.stores for path in store.folder.glob("[!.]*.png")]

    def rendered(self) -> list[str]:
        """Keys of the pictures that were rendered since :meth:`clear_logs`, each as often as it was."""
        path = self.folder / RENDERED
        return path.read_text().split() if path.exists() else []

    def build(self) -> None:
        """Write everything, and mount the disk where that is allowed."""
        from tools.fixtures import film_fixture

        os.environ["MBSD_OUT"] = str(self.disk / "out")
        self.disk.mkdir(parents=True)
        (self.folder / "inputs").mkdir()
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
        for out, shot in zip(self.outs, SHOTS.values(), strict=True):
            film_fixture.write(shot, out.name)
            shutil.move(out.folder, self.folder / "inputs" / out.name)

    def forget(self) -> None:
        """Remove all results, so that the next round does not suffer from this one."""
        shutil.rmtree(self.disk / "out", ignore_errors=True)

    def remove(self) -> None:
        """Leave nothing behind."""
        self.kill()
        if self.mounted:
            subprocess.run(["umount", "-l", str(self.disk)], check=False)
        shutil.rmtree(self.folder, ignore_errors=True)

    def environment(self) -> dict[str, str]:
        """Variables of every command of the user."""
        inherited = ("MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MBSD_MAKE", "COLUMNS", "TMUX", "TMUX_PANE")
        environment = {key: value for key, value in os.environ.items() if key not in inherited}
        return environment | {
            "MBSD_OUT": str(self.disk / "out"),
            "MBSD_PATIENCE": str(PATIENCE),
            "PYTHONPATH": str(ROOT),
            "PYTHONSAFEPATH": "1",
            "TMUX_TMPDIR": str(self.folder),
            "CLUSTER": self.workers.address if self.workers and self.clustered else "",
        }

    def start(self, target: str = "run-all") -> subprocess.Popen[bytes]:
        """Start ``make run-all PRESET=draft`` or another target as a user does; what it says goes to said.txt."""
        words = [f"PYTHON={self.folder}/python"]
        if target in ("run-all", "overnight"):
            words += ["PRESET=draft", f"ONLY={','.join(SHOTS)}"]
        return self.call(["make", "-o", "install", target, *words], self.environment())

    def call(self, command: list[str], environment: dict[str, str]) -> subprocess.Popen[bytes]:
        """Start a command that is ended with the others, and with this process."""
        with (self.folder / "said.txt").open("ab") as said:
            run = subprocess.Popen(
                command,
                cwd=self.folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
                start_new_session=True,
                preexec_fn=_of_a_user,
            )
        self.runs.append(run)
        return run

    def is_over(self) -> bool:
        """Return True if every command and every night of one has ended."""
        ended = all(run.poll() is not None for run in self.runs)
        return ended and not any(COORDINATOR in process.arguments for process in self.alive())

    def code(self) -> int:
        """The exit code of the first command; of ``make overnight`` what became of the night that it started."""
        first = self.runs[0]
        if "overnight" not in str(first.args) or first.returncode:
            return first.returncode
        recorded = runs.read(runs.Run(1))
        return 0 if recorded is not None and recorded.ended == "done" else 1

    def said(self) -> str:
        """Return the output of make, stages and background nights since :meth:`clear_logs`."""
        paths = [self.folder / "said.txt", runs.log_file()]
        return "\n".join(path.read_text(errors="replace") for path in paths if path.exists())

    def clear_logs(self) -> None:
        """Forget what was said and rendered."""
        for path in (self.folder / "said.txt", self.folder / RENDERED, runs.log_file()):
            path.unlink(missing_ok=True)

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


def _of_a_user() -> None:
    """In the process of a command: it takes Ctrl-C, as in a terminal, and ends with the process that started it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    end_with_parent(signal.SIGTERM)


# Processes as ps lists them, on Linux and on a Mac.


@dataclass(frozen=True)
class Process:
    """One process."""

    number: int
    group: int
    state: str
    arguments: str

    def send(self, what: signal.Signals) -> None:
        """Send a signal, if the process is still there."""
        with suppress(ProcessLookupError):
            os.kill(self.number, what)


def processes() -> list[Process]:
    """All that run now; those that have ended and were not yet collected do not count."""
    command = ["ps", "-axwwo", "pid=,pgid=,stat=,args="]
    listing = subprocess.run(command, capture_output=True, text=True, errors="replace", check=True).stdout
    alive = []
    for line in listing.splitlines():
        fields = line.split(maxsplit=3)
        if len(fields) == 4 and not fields[2].startswith("Z"):
            alive.append(Process(int(fields[0]), int(fields[1]), fields[2], fields[3]))
    return alive
