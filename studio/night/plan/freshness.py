"""Steps with nothing to do: all mechanisms asked in one process, which loads nothing heavy.

``python -m studio.night fresh`` is that process, because mechanism.py is run for its parameters and may do anything. It
tells a mechanism a line; what it does not tell is asked by the stages themselves.
"""

from __future__ import annotations

import json
import subprocess
import sys
import threading
from collections.abc import Callable, Iterable

from render.presets import Preset
from shared.stage.errors import UserError
from shared.stage.memory import remembered
from shared.stage.paths import ROOT
from studio.night.plan.options import Options
from studio.night.plan.steps import STEPS

SILENCE = 60.0
"""Seconds that a mechanism may take to be asked."""


def fresh_steps(asked: Options) -> dict[str, list[str]]:
    """Return the steps with nothing to do, by mechanism."""
    words = [sys.executable, "-m", "studio.night", "fresh", "--preset", asked.preset.name]
    words += [f"--show={asked.show}", f"--sound={asked.sound}", f"--spectra={asked.spectra}", "--", *asked.names]
    fresh: dict[str, list[str]] = {}
    with subprocess.Popen(
        words, cwd=ROOT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL
    ) as process:
        assert process.stdout is not None
        watch = _Watch(process)
        try:
            for line in process.stdout:
                watch.again()
                try:
                    name, steps = json.loads(line)
                except ValueError:
                    continue  # a word of an author's own
                fresh[name] = steps
        finally:
            watch.over()
            process.kill()
    return fresh


class _Watch:
    """Timer that kills the process when it prints nothing for too long."""

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        self.process = process
        self.again()

    def again(self) -> None:
        self.over()
        self.timer = threading.Timer(SILENCE, self.process.kill)
        self.timer.daemon = True
        self.timer.start()

    def over(self) -> None:
        timer = getattr(self, "timer", None)
        if timer is not None:
            timer.cancel()


def tell(names: Iterable[str], preset: Preset, show: str, spectra: str, sound: str = "") -> None:
    """Print a line of JSON for every mechanism: its name, and the steps that have nothing to do."""
    with remembered():
        for name in names:
            print(json.dumps([name, fresh_of(name, preset, show, spectra, sound)]), flush=True)


def fresh_of(name: str, preset: Preset, show: str, spectra: str, sound: str = "") -> list[str]:
    """Return the steps of one mechanism with nothing to do, if those that they need have none either."""
    asking = _questions(name, preset, show, spectra, sound)
    fresh: list[str] = []
    for step in STEPS:
        if set(step.needs) <= set(fresh) and _is_fresh(asking[step.name]):
            fresh.append(step.name)
    return fresh


def _is_fresh(question: Callable[[], bool]) -> bool:
    try:
        return question()
    except (UserError, OSError):
        return False  # the stage tells why


def _questions(name: str, preset: Preset, show: str, spectra: str, sound: str) -> dict[str, Callable[[], bool]]:
    """Return for each step the question whether it has nothing to do."""
    from mechanisms.stages import shot as shot
    from mechanisms.stages.clearance import stage as clearance
    from mechanisms.stages.parts import stage as parts
    from mechanisms.stages.solve import stage as solve
    from render import glb, plots, report
    from render.frames import film, still

    return {
        "parts": lambda: parts.are_current(name),
        "solve": lambda: solve.is_fresh(name),
        "shot": lambda: shot.is_fresh(name),
        "clearance": lambda: clearance.is_fresh(name),
        "report": lambda: report.is_fresh(name),
        "plots": lambda: plots.is_fresh(name, spectra, bool(spectra)),
        "glb": lambda: glb.is_fresh(name),
        "poster": lambda: still.is_fresh_poster(name, preset, show),
        "film": lambda: film.is_fresh(name, preset, show, sound),
    }
