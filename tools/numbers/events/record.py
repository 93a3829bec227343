"""A run by name, its record, and the file of all records."""

from __future__ import annotations

import itertools
import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import msgspec
import numpy as np

from mbsd import Mechanism, Solution
from mbsd.base.errors import MechanismError

# A run by name: its model, how it is simulated, and what is known of it.


TOLERANCE = 1e-10
"""So small that errors of a method stay below the bounds of most runs."""


@dataclass(frozen=True)
class Case:
    """A run that is recorded."""

    name: str
    build: Callable[[], Mechanism]
    duration: float
    """s, such that no output falls on an event."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """Arguments of ``simulate`` beside the duration."""
    steps: int = 10
    kink: str = ""
    """Why this run moves by more than rounding, if it does."""
    even: bool = False
    """True where symmetry makes things happen at one instant: then all masses are moved by one factor."""
    refused: tuple[str, ...] = ()
    """Words that the text of the error must have; empty where the run is not refused."""
    quick: bool = False
    """True if it is checked by the quick tests."""

    def simulate(self, m: Mechanism | None = None, **options: Any) -> Solution:
        """Return the simulation of a model, this one's if none is given; warnings are not shown."""
        with warnings.catch_warnings(action="ignore"):
            given = {"tolerance": TOLERANCE, "steps": self.steps, **self.options, **options}
            return (m or self.build()).simulate(self.duration, **given)

    def by(self, suffix: str, **options: Any) -> Case:
        """Return the same run under another name and with other options."""
        return replace(self, name=f"{self.name}, {suffix}", options={**self.options, **options}, quick=False)


# Records of runs, and the file of all.


FILE = Path(__file__).parent / "recorded.jsonl"
BETWEEN = 2
"""Times between events at which the motion is kept."""
NOISE = 1e-14
"""Part of a size below which a number is rounding, and kept as zero."""
BODIES, JOINTS = 20, 30
"""How many are kept of larger mechanisms."""
PAIRS = 4
"""Pairs of rows beside events that are kept."""


class Moment(msgspec.Struct):
    """Motion and forces at a time."""

    t: float
    """s"""
    q: list[float]
    """Numbers of each body, or of some of many: m, rad"""
    v: list[float]
    """m/s, rad/s"""
    forces: list[float]
    """Reactions of joints and contacts (3 each), and friction of joints (N, N m); none at the last time between."""


class Sizes(msgspec.Struct):
    """Scales by which differences are divided."""

    time: float
    length: float
    angle: float
    speed: float
    turning: float
    impulse: float
    energy: float
    force: float

    def of_bodies(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Return those of x, y and angle of a body, and of their rates."""
        return (self.length, self.length, self.angle), (self.speed, self.speed, self.turning)


class Outcome(msgspec.Struct, omit_defaults=True):
    """Outcome of a run; a refused one has only ``error`` and ``text``."""

    happened: list[tuple[float, str, str, float, float]] = []
    """Time (s), name, what, impulse (N s, N m s) and change of kinetic energy (J)."""
    outputs: int = 0
    held: list[tuple[int, str]] = []
    """Rows that hold, 0 or 1 each, from this output on."""
    end: Moment | None = None
    work: float = 0.0
    """J, at the end."""
    between: list[Moment] = []
    rows: list[list[float]] = []
    """v before and after, at pairs of rows beside events."""
    sizes: Sizes | None = None
    error: str = ""
    """Class of the error."""
    text: str = ""


class Record(msgspec.Struct, omit_defaults=True):
    """A run, how much of it may differ, and why."""

    name: str
    same_as: str = ""
    """The run whose outcome it has, if that is recorded already."""
    outcome: Outcome | None = None
    within: float = 1e-9
    """How far the motion may be, in parts of its sizes."""
    forces_within: float = 1e-9
    moved: float = 0.0
    """How far the motion went when numbers were moved by 1e-13 and the tolerance by a tenth."""
    reason: str = ""


def run(case: Case, times: list[float] | None = None, model: Any = None, **options: Any) -> Outcome:
    """Simulate a case; ``times`` (s): those between events at which to look, None to choose them."""
    try:
        sol = case.simulate(model, **options)
        return _outcome(sol, times)
    except MechanismError as error:
        return Outcome(error=type(error).__name__, text=str(error))


def _outcome(sol: Solution, times: list[float] | None) -> Outcome:
    happened = [(e.time, e.name, e.what, e.impulse, e.energy) for e in sol.events]
    times = _between(sol) if times is None else times
    same = np.flatnonzero(np.diff(sol.t) == 0.0)[:PAIRS]
    sizes = _sizes(sol)
    return Outcome(
        happened=happened,
        outputs=len(sol.t),
        held=_held(sol),
        end=_without_noise(_moment(sol, -1), sizes),
        work=0.0 if sol.work is None else float(sol.work[-1]),
        between=[_without_noise(_moment(sol.at([time]), 0, k == 0), sizes) for k, time in enumerate(times)],
        rows=[_plain(sol.v[k : k + 2]) for k in same],
        sizes=sizes,
    )


def _between(sol: Solution) -> list[float]:
    """Middles of the longest times without events, rounded."""
    ends = np.unique([float(sol.t[0]), *(e.time for e in sol.events), float(sol.t[-1])])
    gaps = sorted(itertools.pairwise(ends.tolist()), key=lambda pair: pair[0] - pair[1])[:BETWEEN]
    return sorted(float(f"{a + 0.47 * (b - a):.6g}") for a, b in gaps if b - a > 1e-4)


def _moment(sol: Solution, k: int, with_forces: bool = True) -> Moment:
    q, v = (_spread(part[k], BODIES) for part in (sol.q, sol.v))
    if not with_forces:
        return Moment(float(sol.t[k]), _plain(q), _plain(v), [])
    names = [name for name, force in sol.mechanism.forces.items() if force.kind.name == "friction"]
    friction = [float(sol.friction(name).force[k]) for name in names]
    return Moment(float(sol.t[k]), _plain(q), _plain(v), _plain(_spread(sol.wrench[k], JOINTS)) + friction)


def _without_noise(moment: Moment, sizes: Sizes) -> Moment:
    """The same with zeros for what is rounding."""
    q, v = ([NOISE * size for size in part] for part in sizes.of_bodies())
    parts = (moment.q, itertools.cycle(q)), (moment.v, itertools.cycle(v)), (
        moment.forces, itertools.repeat(NOISE * sizes.force)
    )  # fmt: skip
    return Moment(
        moment.t, *([x if abs(x) > least else 0.0 for x, least in zip(*part, strict=False)] for part in parts)
    )


def _spread(rows: np.ndarray, most: int) -> np.ndarray:
    """All rows, or so many of them from the first to the last."""
    return rows[np.unique(np.linspace(0, len(rows) - 1, most).astype(int))] if len(rows) > most else rows


def _held(sol: Solution) -> list[tuple[int, str]]:
    out: list[tuple[int, str]] = []
    for k, row in enumerate(np.asarray(sol.held, bool)):
        bits = "".join("1" if holds else "0" for holds in row)
        if not out or out[-1][1] != bits:
            out.append((k, bits))
    return out


def _plain(values: Any) -> list[float]:
    return [float(value) + 0.0 for value in np.ravel(values)]


def _sizes(sol: Solution) -> Sizes:
    q, v, span = sol.q, sol.v, float(sol.t[-1] - sol.t[0])
    length = max(_most(q[..., :2]), *(body.length or 0.0 for body in sol.mechanism.bodies.values()), 1e-3)
    turning, speed = _most(v[..., 2]), _most(v[..., :2])
    speed, turning = max(speed, length * turning, length / span), max(turning, speed / length, 1.0 / span)
    kinetic = _most(sol.energy.kinetic)
    energy = max(kinetic, *(abs(e.energy) for e in sol.events), 0.0 if sol.work is None else _most(sol.work), 1e-9)
    impulse = max((abs(e.impulse) for e in sol.events), default=0.0) or 1.0
    force = max(_most(sol.wrench), 1e-3 * energy / length)
    sized = (span, length, max(1.0, _most(q[..., 2])), speed, turning, impulse, energy, force)
    return Sizes(*(float(f"{size:.3g}") for size in sized))


def _most(values: Any) -> float:
    return float(np.abs(values).max(initial=0.0))


def read() -> dict[str, Record]:
    """Return all records by name."""
    lines = FILE.read_bytes().splitlines()
    return {record.name: record for record in (msgspec.json.decode(line, type=Record) for line in lines)}


def write(records: list[Record]) -> None:
    """Write the file, a record a line."""
    FILE.write_bytes(b"".join(msgspec.json.encode(record) + b"\n" for record in records))
