"""A mechanism ready for forward dynamics, put into independent coordinates where that can be done."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.base.codes import LAW_VALUE, LINEAR, POWER, TURN
from mbsd.base.running import Kept
from mbsd.dynamics.independent.arrays import LIMIT, SENSITIVITY, Embedding, EmbeddingScratch
from mbsd.dynamics.independent.block import KEPT_SIZE, block_arrays, block_work
from mbsd.dynamics.independent.coordinates import MOST, Choice, Coordinate, choices, coordinates_along, coordinates_of
from mbsd.dynamics.independent.equations import look
from mbsd.dynamics.independent.groups import KEPT
from mbsd.dynamics.prepare.prepared import UNKNOWN, PreparedDynamics
from mbsd.dynamics.state import Settings
from mbsd.kinematics.groups.carried import AVOID, BASE, COS, INERTIA, MASS, NEAR, SPEED, THETA, TURNS
from mbsd.kinematics.groups.cases import FLOOR
from mbsd.kinematics.groups.plan import Plan

GOOD = 3.0
"""A choice under which no body moves faster than this for one unit of a coordinate is taken at once."""
POOR = 20.0
"""A choice under which some body moves faster than this is not begun with, and left where it is the best."""
SMALLEST_STEP = 1e-6
"""Part of the longest step at which a run leaves its coordinates."""
ROUNDING = 5e-14
"""Rounding of a step's accelerations, in rad/s^2 by rad, times the cubed sine of the angle between a group's two
links: where it passes the tolerance the closed form gives way to poses beside."""
WIDEST = 0.1**2
"""Squared sine above which closed forms always stand."""
CLOSED, UNKNOWN_COST, PAIRED, BODY_COST, BESIDE = 0.04, 0.3, 0.03, 0.2, 0.3
"""Measured costs of one evaluation (us): of a closed group, of an unknown of a block and of each pair of unknowns; of a
body in reference coordinates and what comes beside."""
DOUBLED = 2.0
"""Another choice is looked for when some body moves this much faster than when the coordinates were chosen."""


@dataclass
class Embedded:
    """Arrays and coordinates of one choice."""

    arrays: Embedding
    coordinates: list[Coordinate]
    plan: Plan
    """The groups that place all bodies."""
    drivers: int
    sensitivity: float
    """The largest rate of a body for one unit of a coordinate, dimensionless, at the pose of the choice."""
    pays: bool = True
    """True if an evaluation costs less than in reference coordinates, as closed forms alone always do."""

    def copied(self, tolerance: float = math.inf) -> Embedding:
        """Arrays of one run, which changes branches, at a relative tolerance."""
        number = self.arrays.number.copy()
        if not self.arrays.block[KEPT_SIZE]:  # else there are no poses beside
            number[:, AVOID] = min(max((ROUNDING / tolerance) ** (2.0 / 3.0), FLOOR), WIDEST)
        return self.arrays._replace(number=number)

    def state(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return (2, 3 + f) of q, v (3 nb,)."""
        return coordinates_along(self.coordinates, q[None], v[None])[0]

    def settings(self, settings: Settings) -> Settings:
        """The same tolerances for the coordinates."""
        count = 3 + len(self.coordinates)
        absolute, growing = np.full((2, 2, count), settings.relative)
        absolute[:, 3:] = 1.0 / self.arrays.size * settings.relative
        growing[0, :3] = 0.0
        growing[0, 3:][[coordinate.slide is None for coordinate in self.coordinates]] = 0.0
        return settings._replace(absolute=absolute, growing=growing, smallest=SMALLEST_STEP * settings.longest)


NO_PLAN = (
    "it does not fall apart into driven bodies, gear trains, groups of one or two and blocks of a few, "
    "or its start is near a singular pose"
)


def can_embed(ready: PreparedDynamics) -> str | None:
    """Why a mechanism must stay in reference coordinates, or None."""
    packed, dynamics = ready.packed, ready.dynamics
    count = _freedoms(ready)
    if ready.following:
        return "a point is on a curve that crosses itself or its straight continuation"
    if ready.switches.contacts:
        return "it has contacts or limits"
    if ready.mobility.redundant_rows or ready.mobility.singular:
        return "joints are redundant, or the start is singular"
    if len(dynamics.loads.friction):
        return "friction of joints depends on their reactions"
    if not 0 < count <= MOST:
        states = f", {packed.states} of them states of forces" if packed.states else ""
        return f"it has {count} degrees of freedom beside its drivers{states}; 1 to {MOST} are possible"
    return None


def embedded_at_start(ready: PreparedDynamics) -> Embedded | None:
    """The mechanism in independent coordinates that suit its start, or None where there are none; found once."""
    if ready.independent is UNKNOWN:
        ready.independent = None if can_embed(ready) else _at_start(ready)
    return ready.independent


_CHOICES: Kept[Embedded | None] = Kept()
"""Choices at a start, by all numbers that they depend on."""


def _at_start(ready: PreparedDynamics) -> Embedded | None:
    packed, loads, initial = ready.packed, ready.dynamics.loads, ready.initial
    numbers = packed.numbers()
    if numbers is None or len(loads.user) or len(loads.interaction):
        return embed(ready, initial.q, initial.v, ready.start)
    parts = initial.q, initial.v, loads.element, loads.place, loads.term, loads.number, *ready.dynamics.laws

    def chosen() -> Embedded | None:
        return embed(ready, initial.q, initial.v, ready.start)

    key = *numbers, *[part.tobytes() for part in parts], ready.start, ready.mobility.dof
    made = _CHOICES.get(key, chosen)
    return None if made is None else replace(made, arrays=made.arrays._replace(**_of_dynamics(ready)))


def embed(ready: PreparedDynamics, q: np.ndarray, v: np.ndarray, time: float) -> Embedded | None:
    """The best choice of coordinates at a consistent q, v (3 nb,), or None where there is none."""
    best = None
    for choice in choices(ready.packed, q, _freedoms(ready)):
        made = _embed_by(ready, choice, _freedoms(ready))
        made.sensitivity = _sensitivity(ready, made, q, v, time)
        if made.sensitivity < POOR and (best is None or made.sensitivity < best.sensitivity):
            best = made
        if best is not None and best.sensitivity <= GOOD:
            break
    return best


def _freedoms(ready: PreparedDynamics) -> int:
    return ready.mobility.dof - len(ready.packed.motions) + ready.packed.states


def embedding_scratch(ready: PreparedDynamics, made: Embedded, stages: int, q: np.ndarray) -> EmbeddingScratch:
    """Scratch for one run that begins at q (3 nb,), and predicts from there."""
    bodies, count = len(ready.packed.body_names), len(made.coordinates)
    columns = count + (made.drivers > 0)
    body = np.zeros((bodies, INERTIA + 1))
    body[0, COS] = 1.0
    body[:, MASS], body[:, INERTIA] = ready.packed.system.mass, ready.packed.system.inertia
    turns = np.zeros((bodies, 2))
    turns[:, 0] = 1.0
    base = np.zeros((bodies, TURNS + columns))
    base[:, THETA] = q[2::3]
    return EmbeddingScratch(
        cos_sin=turns,
        body=body,
        rate=np.zeros((bodies, 3 * columns + 3)),
        base=base,
        coordinate=np.zeros((columns + 1, 3)),
        q=np.zeros(3 * bodies),
        v=np.zeros(3 * bodies),
        mass=np.zeros((count, count)),
        sums=np.zeros(2),
        drive=np.zeros((made.drivers + 1, 3)),
        block_work=block_work(made.arrays.block, q),
        force=np.zeros(3 * bodies),
        watch=np.full(2, np.inf),
        before=np.zeros((3, 3 * bodies)),
        joined_body=np.zeros((3, bodies, KEPT)),
        joined_rate=np.zeros((3, bodies, 3 * columns + 3)),
        multipliers=np.zeros(0),
        state=np.zeros((2, 3 + count)),
        stages=np.zeros((stages, 2, 3 + count)),
        power=np.zeros(stages),
        dense=np.zeros((8, 2, 3 + count)),
        dense_work=np.zeros(7),
        report=np.zeros(4),
        spare_0=np.zeros(1),
        spare_1=np.zeros(1),
        spare_2=np.zeros(1),
    )


def begin_at(arrays: Embedding, scratch: EmbeddingScratch, state: np.ndarray, time: float, limit: float) -> None:
    """Let predictions begin at a state (2, 3 + f) and time (s)."""
    arrays.number[:, NEAR] = 1.0
    count = state.shape[1] - 3
    scratch.coordinate[:, SPEED] = 1.0
    scratch.coordinate[:count, BASE] = state[0, 3:]
    scratch.coordinate[count:, BASE] = time
    scratch.watch[LIMIT] = limit


def _embed_by(ready: PreparedDynamics, choice: Choice, count: int) -> Embedded:
    packed, loads = ready.packed, ready.dynamics.loads
    groups, size = choice.plan.groups(), packed.size
    coordinates = coordinates_of(choice.plan, count)
    columns = count + bool(packed.motions)
    block, block_number = block_arrays(choice.blocks, len(packed.body_names), columns)
    reading = [
        kind == TURN and any(loads.term[k, 0] in (LINEAR, POWER, LAW_VALUE) for k in range(first, end))
        for kind, _, _, first, end in loads.element
    ]
    functions = bool(len(loads.interaction) or len(loads.user))
    loaded = np.arange(1, len(packed.body_names)) if functions else np.unique(loads.element[:, 1:3])
    arrays = Embedding(
        **_of_dynamics(ready),
        group=groups.group,
        number=groups.row,
        block=block,
        block_number=block_number,
        size=np.array([1.0 if coordinate.slide is None else size for coordinate in coordinates]),
        loaded=loaded[loaded > 0],
        angles=functions or any(reading),
    )
    return Embedded(
        arrays, coordinates, choice.plan, len(packed.motions), math.inf, _pays(choice, len(packed.body_names) - 1)
    )


def _pays(choice: Choice, bodies: int) -> bool:
    if not choice.blocks:
        return True
    unknowns = [len(block.equations) for block in choice.blocks]
    cost = CLOSED * (len(choice.plan.taken) - len(unknowns)) + sum(UNKNOWN_COST * n + PAIRED * n * n for n in unknowns)
    return cost < BESIDE + BODY_COST * bodies


def _of_dynamics(ready: PreparedDynamics) -> dict[str, Any]:
    """Return the fields that an Embedding has in common with a Dynamics."""
    dynamics = ready.dynamics
    return {
        "laws": dynamics.laws,
        "loads": dynamics.loads,
        "inertia": dynamics.inertia,
        "weight": dynamics.weight,
        "numbers": dynamics.system.numbers,
        "gravity": dynamics.system.gravity,
        "per_size": dynamics.per_size,
    }


def _sensitivity(ready: PreparedDynamics, made: Embedded, q: np.ndarray, v: np.ndarray, time: float) -> float:
    arrays, scratch = made.copied(), embedding_scratch(ready, made, 1, q)
    state = made.state(q, v)
    begin_at(arrays, scratch, state, time, math.inf)
    power = look(arrays, scratch, time, state)
    ready.packed.specials.check()
    if math.isnan(power):
        return math.inf
    return float(scratch.watch[SENSITIVITY])
