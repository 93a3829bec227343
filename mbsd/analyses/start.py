"""Whether the links close at the start, said as a finding instead of an error."""

from __future__ import annotations

from collections.abc import Iterator

from mbsd.analyses.finding import Finding
from mbsd.base.errors import MechanismError
from mbsd.dynamics.mobility import mobility
from mbsd.model.mechanism import Model

REMEDY = "Look at lengths and places of what it names; m.draw() shows the rough start"


def start_problems(m: Model) -> Iterator[Finding]:
    """What keeps ``m`` from being assembled: links that cannot close, gears apart, a rack on the other side."""
    try:
        mobility(m)
    except MechanismError as error:
        problem, _, remedy = str(error).removeprefix(f"{m.name}: ").partition(". ")
        yield Finding("start", problem.rstrip("."), remedy.rstrip(".") or REMEDY)
