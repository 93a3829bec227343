"""Steps of a mechanism, from its files to its film: the needs of each, and its command."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from studio.night.plan.options import Options


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
        return [asked.python, "-m", "mechanisms", step, name]
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
