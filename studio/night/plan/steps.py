"""Steps of a mechanism from its files to its film, and the board of all: complete or ready to start."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from studio.night.plan.options import Options

# Steps of a mechanism, from its files to its film: the needs of each, and its command.


@dataclass(frozen=True)
class Step:
    """One stage of every mechanism."""

    name: str
    needs: tuple[str, ...] = ()
    """Steps of the same mechanism that have to be done before."""
    renders: bool = False
    """True if it takes the one place of the render; the others run beside it."""
    rank: int = 0
    """Among the steps that could run beside the render the lowest rank comes first."""


STEPS = (
    Step("parts"),
    Step("solve", ("parts",)),
    Step("clearance", ("solve",), rank=1),
    Step("shot", ("solve",)),
    Step("report", ("clearance",), rank=2),
    Step("plots", ("solve",), rank=2),
    Step("glb", ("shot",), rank=2),
    Step("poster", ("shot",), renders=True),
    Step("film", ("poster", "clearance"), renders=True, rank=1),
)
"""In the order in which ``make run-<name>`` makes them. The poster is a frame of the film, and probes its time."""
PROBE, FILM = "poster", "film"
AUTHORS = ("parts", "solve", "shot", "clearance")
"""Stages of ``python -m mechanisms``; the others are commands of ``python -m render``."""


def command(step: str, name: str, asked: Options) -> list[str]:
    """Return the command line of a step, as in the Makefile."""
    if step in AUTHORS:
        words = [asked.python, "-m", "mechanisms", step, name]
        return [*words, "--or-warn"] if step == "clearance" else words
    words = [asked.python, "-m", "render", step, name]
    if step == "plots" and asked.spectra:
        words += [f"--spectra={asked.spectra}", "--every"]
    if step in (PROBE, FILM):
        words += ["--preset", asked.preset.name]
        words += [f"--show={asked.show}"] if asked.show else []
    if step == FILM and asked.sound:
        words.append(f"--sound={asked.sound}")
    return words


def followers(step: str, steps: Sequence[Step] = STEPS) -> list[str]:
    """Return the steps that need this one, directly or through others."""
    after = {step}
    for other in steps:  # each stands behind those that it needs
        if after & set(other.needs):
            after.add(other.name)
    return [other.name for other in steps if other.name in after - {step}]


# Board of all steps: which are done, and which may start next, without processes or files.


State = Literal["waiting", "running", "fresh", "done", "failed", "blocked"]
"""``fresh``: there was nothing to do; ``blocked``: a step that it needs has failed."""
OVER: tuple[State, ...] = ("fresh", "done", "failed", "blocked")
GOOD: tuple[State, ...] = ("fresh", "done")


class Board:
    """States of all steps of all mechanisms."""

    def __init__(
        self, names: Sequence[str], fresh: Mapping[str, Collection[str]] | None = None, steps: Sequence[Step] = STEPS
    ) -> None:
        self.names, self.steps = list(names), {step.name: step for step in steps}
        self.away: set[str] = set()
        """Mechanisms that another process has; films of the others do not wait for their probes."""
        known = fresh or {}
        self._states: dict[tuple[str, str], State] = {}
        for name in names:
            for step in steps:
                # What follows a step that has something to do may have something to do, too.
                good = step.name in known.get(name, ()) and all(self._states[name, n] == "fresh" for n in step.needs)
                self._states[name, step.name] = "fresh" if good else "waiting"

    def state(self, name: str, step: str) -> State:
        """Return the state of a step."""
        return self._states[name, step]

    def steps_of(self, name: str) -> dict[str, State]:
        """Return the steps of one mechanism in order."""
        return {step: self._states[name, step] for step in self.steps}

    def start(self, name: str, step: str) -> None:
        """Record that a step runs."""
        self._states[name, step] = "running"

    def wait(self, name: str, step: str) -> None:
        """Record that a step that ran has to run once more."""
        self._states[name, step] = "waiting"

    def finish(self, name: str, step: str) -> None:
        """Record that a step has ended well."""
        self._states[name, step] = "done"

    def fail(self, name: str, step: str) -> None:
        """Record that a step has failed; steps that need it are blocked, running ones go on."""
        self._states[name, step] = "failed"
        for other in followers(step, list(self.steps.values())):
            if self._states[name, other] == "waiting":
                self._states[name, other] = "blocked"

    def is_over(self) -> bool:
        """Return True if nothing runs or could run."""
        return all(state in OVER for state in self._states.values())

    def is_measured(self) -> bool:
        """Return True if the probe of every film that this run can render now is over."""
        here = [name for name in self.names if name not in self.away] if PROBE in self.steps else []
        return all(self._states[name, PROBE] in OVER for name in here)

    def ready(self, renders: bool) -> Iterator[tuple[str, str]]:
        """Yield mechanism and step that may start now, the most urgent first.

        ``renders`` selects renders, or steps beside the render.

        Every probe comes before the first film, so that the forecast stands when the night begins.
        """
        waiting_steps = [
            (step.rank, place, name, step.name)
            for place, name in enumerate(self.names)
            for step in self.steps.values()
            if step.renders == renders
            and self._states[name, step.name] == "waiting"
            and all(self._states[name, need] in GOOD for need in step.needs)
            and (step.name != FILM or self.is_measured())
        ]
        for _, _, name, step in sorted(waiting_steps):
            yield name, step

    def outcome(self, name: str) -> Literal["waiting", "at work", "done", "failed"]:
        """Return the state of a whole mechanism."""
        states = set(self.steps_of(name).values())
        if states <= set(GOOD):
            return "done"
        if states <= set(OVER):
            return "failed"
        return "at work" if "running" in states else "waiting"
