"""``mbsd overnight``: a run that outlives its terminal, in a tmux session or by itself."""

from __future__ import annotations

import getpass
import hashlib
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from shared.stage.console import say, warn
from shared.stage.errors import UserError
from shared.stage.face import to_run
from shared.stage.files import refusal
from shared.stage.paths import ROOT, out_root, refuse_links
from shared.stage.signals import VARIABLE
from shared.system import missing
from studio.night import runs
from studio.night.forecast import refuse_before_start
from studio.night.plan.options import Options
from studio.night.runs import Run

# Logout: whether the system ends processes that a user has left running, and the remedy.
#
# systemd does so where KillUserProcesses is set in logind.conf: a run then has to be in a scope of the user's manager,
# and that manager has to linger.


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


BEGIN = 30.0
"""Seconds that a run has to appear."""
LOOK = 0.2
OF_MAKE = (VARIABLE, "MAKEFLAGS", "MAKELEVEL", "MFLAGS", "MAKEOVERRIDES", "MAKE_TERMOUT", "MAKE_TERMERR")
"""Variables that bind a stage to the make above it; the night has none."""


def start(asked: Options) -> int:
    """Start the run, print how to attach and its cost.

    On a terminal wait for its forecast, which Ctrl-C ends.

    Where a run is at work already it is named, and the new one joins it: it takes what the other has not. Raises
    UserError where the results cannot be written, the disk is surely too small, or the run does not begin.
    """
    for run in runs.alive():
        recorded = runs.read(run)
        who = f" (process {recorded.process} on {recorded.host}, since {recorded.started})" if recorded else ""
        warn("night", f"run {run.number} is running already{who}; this run takes what that run does not work on")
    refuse_before_start(asked, asked.names)
    before = {run.number for run in runs.alive()}
    environment = {key: value for key, value in os.environ.items() if key not in OF_MAKE}
    attach = _launch(_command(asked), environment)
    night = _begun(before)
    say("night", f"started as run {night.number}; it continues after you log out")
    if attach:
        say("night", f"attach to it: {attach} (Ctrl-B D leaves it running)")
    else:
        say("night", f"tmux is not needed; follow the run with: tail -f {runs.log_file()}")
    status, stop = to_run("status"), to_run("stop")
    say("night", f"{status} shows its progress, {stop} ends it after the current frame; {runs.log_file()}")
    warn_if_it_ends_all(warn)
    if sys.stdout.isatty():
        _tell_forecast(night)
    else:
        say("night", f"the forecast follows in {to_run('status')} when a frame of every film is measured")
    return 0


def _command(asked: Options) -> list[str]:
    words = [sys.executable, "-m", "studio.night", "run", "--preset", asked.preset.name]
    words += [f"--only={','.join(asked.names)}"] if not asked.whole else []
    words += [f"--show={asked.show}", f"--sound={asked.sound}", f"--spectra={asked.spectra}"]
    words += [f"--watts={asked.watts:g}"] if asked.watts is not None else []
    words += ["--anyway=1"] if asked.anyway else []
    return [*words, f"--python={asked.python}"]


def _launch(command: list[str], environment: dict[str, str]) -> str:
    """Start the run in the background; return how to attach to it, empty without tmux."""
    refuse_links(runs.folder())
    try:
        runs.folder().mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise UserError(refusal(runs.folder(), error)) from error
    survive = scope()
    tmux = missing.program("tmux")
    if tmux is not None:
        # A server of its own has the environment of this command; that of the user's server may be of another day.
        socket = f"night-{_tree()}"
        session = _free_session(tmux, socket)
        launched = subprocess.run(
            [*survive, tmux, "-L", socket, "new-session", "-d", "-s", session, "-c", str(ROOT), *command],
            env={key: value for key, value in environment.items() if key not in ("TMUX", "TMUX_PANE")},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
        )
        if launched.returncode == 0:
            return f"tmux -L {socket} attach -t {session}"
        warn("night", f"tmux could not start a session ({launched.stderr.strip()}); it goes on without")
    else:
        warn("night", f"tmux is not installed ({missing.remedy(['tmux'])}), so you cannot attach to the run")
    subprocess.Popen(
        [*survive, "nohup", *command],
        cwd=ROOT,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    return ""


def _tree() -> str:
    """Return a word for this project and its results, unlike another copy's: ``mbsd-1a2b3c``."""
    mark = hashlib.sha256(f"{ROOT}\0{Path(os.path.abspath(out_root()))}".encode()).hexdigest()[:6]
    return f"{re.sub(r'[^A-Za-z0-9]+', '-', ROOT.name).strip('-') or 'tree'}-{mark}"


def _free_session(tmux: str, socket: str) -> str:
    """Return ``night``, or with a number if sessions of other runs exist."""
    listing = subprocess.run([tmux, "-L", socket, "list-sessions", "-F", "#S"], capture_output=True, text=True)
    taken = set(listing.stdout.split())
    names = ["night", *(f"night-{number}" for number in range(2, 2 + len(taken)))]
    return next(name for name in names if name not in taken)


def _begun(before: set[int]) -> Run:
    """Return the run that has just begun. Raises UserError if none appears."""
    new: list[Run] = []

    def appeared() -> bool:
        new[:] = [run for run in runs.alive() if run.number not in before]
        return bool(new)

    if not _wait(appeared, BEGIN):
        raise UserError(
            f"the run did not begin within {BEGIN:.0f} s, or was over at once; {runs.log_file()} tells what it said, "
            f"{to_run('all')} does the same in this terminal"
        )
    return new[0]


def _tell_forecast(night: Run) -> None:
    """Wait until the forecast is known or the run is over, and print it."""
    say("night", "a frame of every film is measured for the forecast; Ctrl-C ends the waiting, not the night")
    try:
        _wait(lambda: not night.is_alive() or bool((recorded := runs.read(night)) and recorded.forecast))
    except KeyboardInterrupt:
        print()
        return
    recorded = runs.read(night)
    if recorded is not None and recorded.forecast:
        say("night", f"forecast: {recorded.forecast}")


def _wait(ready: Callable[[], bool], seconds: float = float("inf")) -> bool:
    end = time.monotonic() + seconds
    while not ready():
        if time.monotonic() > end:
            return False
        time.sleep(LOOK)
    return True
