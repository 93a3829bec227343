"""Why a run hardly advances or cannot go on: a force that jumps or is stiff, a motion that grows without bound.

Forces are evaluated one by one along the motion through the state, y + s y' with s up to 10 and up to 1000 steps h to
both sides: a smooth force changes a hundred times more in the second, one that jumps does not. The stiffness of a force
is the rate (1/s) at which it would stop or swing bodies that no joints hold,

    lambda = max(|W^-1 dQ/dv|, sqrt |W^-1 dQ/dq|)

Steps of explicit methods that are no longer than a few 1 / lambda are short for stability's sake, not for accuracy's.

A motion may end in finite time, as under a force that grows with the cube of an angle. With V the size of all
velocities, T = V / (dV/dt) is the time in which they double or so. Growth that ends at a time t_e, V ~ (t_e - t)^-p,
has T = (t_e - t) / p: it falls along a straight line that tells t_e, while T of exponential growth stays and that of
usual motions is of the size of what is left. Steps follow it for ever, each a part of T.

Steps may also shorten without such growth, towards a pose that reference coordinates do not pass. Where the n-th step
is of the size n^-p, p > 1, all steps to come together last n h / (p - 1), however many they are.

Source: Hairer, Wanner, Solving ODEs II, IV.2.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from mbsd.arrays.directory import directory, slice_of
from mbsd.arrays.friction_along import REMEDY, friction_under, jam
from mbsd.arrays.loads import loads_along
from mbsd.base.errors import SimulationError
from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.prepare.inertia import LIFT
from mbsd.dynamics.runs.run import Run
from mbsd.dynamics.state import TIME, State
from mbsd.equations.joint_friction import FAILED, X

if TYPE_CHECKING:
    from collections.abc import Iterator

    from mbsd.dynamics.reference.arrays import Dynamics
    from mbsd.dynamics.runs.run import Run
    from mbsd.model.force import Force

NEAR, FAR = np.array([1.0, 3.0, 10.0]), np.array([30.0, 100.0, 300.0, 1000.0])
"""Steps ahead and back at which forces are evaluated."""
JUMP = 0.3
"""Part of a force's change over FAR that happens over NEAR already where it jumps."""
SLIGHT = 1e-6
"""Part of the largest load below which a change does not matter."""
STABILITY = 0.1, 30.0
"""h lambda of explicit methods whose steps are limited by stability."""
NEEDLESS = 1e-5
"""Part of the time in which bodies move by the mechanism's size: shorter steps are not what the motion needs."""
HOPELESS = 1e12
"""Steps of that sort, those taken times those left, that no one waits for: the longer they last, the less they pass."""
CREEPING = 1.2
"""Least power p by which steps that creep shorten."""
NEVER = 0.1
"""Part of the time left that steps which creep do not reach in all."""
DIFFERENCE = 1e-6
"""Differences of velocities and coordinates, in sizes and rad."""
MANY_BODIES = 100
"""Beyond, stiffness is looked for along the motion alone."""


class Stiffest(NamedTuple):
    """A force and its lambda (1/s)."""

    force: Force
    rate: float


class Look(NamedTuple):
    """How long steps were (s) after so many of them, since they became short."""

    steps: int
    length: float


def creeps_to(looks: list[Look], time: float, end: float) -> float | None:
    """Return the time (s), before ``end``, that no number of steps passes, or None where steps do not creep.

    The last three of ``looks`` tell, each at twice as many steps as the one before; ``time`` (s) is that of the last.
    """
    last = looks[-3:]
    if len(last) < 3 or not all(look.length > 0.0 for look in last):
        return None
    powers = [math.log(a.length / b.length) / math.log(b.steps / a.steps) for a, b in pairwise(last)]
    if min(powers) < CREEPING:
        return None
    ahead = looks[-1].steps * looks[-1].length / (min(powers) - 1.0)
    return time + ahead if ahead < NEVER * (end - time) else None


def diagnosis(run: Run, state: State, h: float, taken: int, left: float, ends: float | None = None) -> str | None:
    """Return the cause of steps of h (s), with the remedy, or None if the run may go on.

    ``taken`` steps were as short and ``left`` remain, or any number where they creep towards ``ends`` (s).
    """
    cause = jump(run, state, h)
    slope = slope_at(run, state)
    if cause is not None or slope is None:
        return cause
    if h > NEEDLESS * _own_time(run, state, slope):
        return None
    stiff = _stiffest(run, float(state.clock[TIME]), state.y, slope)
    if stiff is None or not STABILITY[0] < h * stiff.rate < STABILITY[1]:
        if ends is not None:
            return (
                f"steps shorten towards t = {ends:.6g} s, and no force jumps or is stiff there. Look for a pose that "
                "is singular, or loosen the tolerance."
            )
        if taken * left < HOPELESS:
            return None
        return "no force jumps or is stiff there. Look for a pose that is singular, or loosen the tolerance."
    joint = stiff.force.params.get("joint")
    where = f" of joint '{joint}'" if joint else ""
    return (
        f"force '{stiff.force.name}'{where} is stiff, it acts within {1.0 / stiff.rate:.1e} s, and about {left:.1e} "
        "steps would follow. Take method='radau', or lower its damping, friction or stiffness."
    )


def jump(run: Run, state: State, h: float) -> str | None:
    """The force that jumps within some steps of h (s), with the remedy, or None."""
    slope = slope_at(run, state)
    cause = None if slope is None else _jumping(run, float(state.clock[TIME]), state.y, slope, h)
    if cause is None:
        return None
    force, size = cause
    return (
        f"force '{force.name}' jumps there, by {size:.3g} (N or N m). Make it smooth, say with "
        "tanh(speed / slip_speed) in place of sign(speed), or take friction of a joint with sticks=True."
    )


def slope_at(run: Run, state: State) -> np.ndarray | None:
    """(2, 3 nb) d(state)/dt, or None where it is not finite."""
    slope, time = np.zeros_like(state.y), float(state.clock[TIME])
    derivative(run.ready.dynamics, run.scratch, time, state.y, slope, np.zeros_like(state.lam))
    return slope if np.isfinite(slope).all() else None


def _own_time(run: Run, state: State, slope: np.ndarray) -> float:
    """Time (s) in which bodies move by the mechanism's size or turn by 1 rad."""
    dynamics, packed = run.ready.dynamics, run.ready.packed
    speed = float(np.abs(state.y[1] * dynamics.per_size)[3:].max())
    bend = float(np.abs(slope[1] * dynamics.per_size)[3:].max())
    fall = float(np.hypot(*packed.system.gravity)) / packed.size
    return 1.0 / max(speed, math.sqrt(bend), math.sqrt(fall), 1.0 / (run.ready.end - run.ready.start))


def _jumping(run: Run, time: float, y: np.ndarray, slope: np.ndarray, h: float) -> tuple[Force, float] | None:
    """The force that jumps most, and by how much."""
    ahead = h * np.concatenate([-FAR[::-1], -NEAR[::-1], [0.0], NEAR, FAR])
    states = y + ahead[:, None, None] * slope
    times = np.full(len(ahead), time)
    close = slice(len(FAR), -len(FAR))
    inverse = _inverse(run.ready.dynamics)
    largest = max(float(np.abs(run.ready.dynamics.weight * inverse).max()), 1e-300)
    best: tuple[Force, float] | None = None
    worst = 0.0
    for force, loads in loads_by_force(run, times, states):
        effect = loads * inverse
        largest = max(largest, float(np.abs(effect).max()))
        wide, near = np.ptp(effect, axis=0), np.ptp(effect[close], axis=0)
        column = int(np.argmax(near))
        if near[column] > JUMP * wide[column] and near[column] > max(worst, SLIGHT * largest):
            worst, best = near[column], (force, float(np.ptp(loads[close, column])))
    return best


def _inverse(dynamics: Dynamics) -> np.ndarray:
    """(3 nb,) of inertias, where there is none of what joints lend."""
    return np.where(dynamics.inertia > 0.0, dynamics.inverse, LIFT * dynamics.inverse)


def _stiffest(run: Run, time: float, y: np.ndarray, slope: np.ndarray) -> Stiffest | None:
    dynamics = run.ready.dynamics
    per_size, inverse = dynamics.per_size, _inverse(dynamics)
    n3 = y.shape[1]
    if n3 <= 3 * MANY_BODIES:
        ways = np.concatenate(
            [np.stack([np.eye(n3) * 0.0, np.eye(n3)], 1), np.stack([np.eye(n3), np.eye(n3) * 0.0], 1)]
        )
        ways = ways[np.r_[3:n3, n3 + 3 : 2 * n3]]
    else:
        ways = np.stack([np.stack([0.0 * y[1], slope[1]]), np.stack([y[1], 0.0 * y[1]])])
        ways /= np.maximum(np.abs(ways * per_size).max(axis=(1, 2), keepdims=True), 1e-300)
    ways = ways * (DIFFERENCE / np.where(per_size > 0.0, per_size, 1.0))
    states = np.concatenate([y + ways, y - ways])
    times = np.full(len(states), time)
    best = None
    for force, loads in loads_by_force(run, times, states):
        change = 0.5 * (loads[: len(ways)] - loads[len(ways) :]) * inverse * per_size / DIFFERENCE
        rates = np.abs(change).max(axis=1)
        half = len(ways) // 2
        rate = max(float(rates[:half].max()), math.sqrt(float(rates[half:].max())))
        if best is None or rate > best.rate:
            best = Stiffest(force, rate)
    return best


def loads_by_force(run: Run, times: np.ndarray, states: np.ndarray) -> Iterator[tuple[Force, np.ndarray]]:
    """Each force and its loads (T, 3 nb) at times (T,) and states (T, 2, 3 nb).

    Friction of joints is that under the last normal forces.
    """
    packed, own = run.ready.packed, run.ready.dynamics.loads
    q, v = np.ascontiguousarray(states[:, 0]), np.ascontiguousarray(states[:, 1])
    for rows in directory(packed).values():
        loads = rows.alone(own)
        if rows.friction:
            normal = np.tile(own.normal[X, slice_of(rows.friction)], (len(q), 1))
            yield rows.force, friction_under(packed, loads, q, v, normal)
        else:
            yield rows.force, loads_along(packed, loads, run.ready.dynamics.laws, times, q, v)


BEYOND = 1e6
"""Velocities so many times those of the start, of a fall by the size, and of going by the size in the whole run."""
STRAIGHT = 0.05
"""How fast T falls at least: p of 20."""
SOON = 1e-3
"""Part of the time left within which growth ends."""
SHARE = 0.5
"""Part of the power of all inertia that the force which is named has at least."""


class Growth(NamedTuple):
    """Velocities at a time (s), in sizes/s and rad/s."""

    time: float
    size: float
    within: float
    """T (s)"""


def growth_of(run: Run, state: State) -> Growth | None:
    """How velocities grow where they are far beyond usual ones, else None."""
    dynamics, packed, ready = run.ready.dynamics, run.ready.packed, run.ready
    size = float(np.linalg.norm(state.y[1] * dynamics.per_size))
    fall = float(np.hypot(*packed.system.gravity)) / packed.size
    usual = max(float(np.linalg.norm(ready.initial.v * dynamics.per_size)), fall**0.5, 1.0 / (ready.end - ready.start))
    if not BEYOND * usual < size < np.inf:
        return None
    report = run.scratch.report.copy()
    slope = slope_at(run, state)
    run.scratch.report[...] = report
    if slope is None:
        return None
    rise = float(state.y[1] * dynamics.per_size @ (slope[1] * dynamics.per_size)) / size
    return Growth(float(state.clock[TIME]), size, size / rise) if rise > 0.0 else None


def runaway(run: Run, state: State, before: Growth | None, now: Growth | None) -> str | None:
    """Return words on what grows without bound, when and under which force; None where nothing does."""
    if before is None or now is None or not (now.time > before.time and now.size > 2.0 * before.size):
        return None
    falling = (before.within - now.within) / (now.time - before.time)
    if not falling > STRAIGHT or now.within / falling > SOON * (run.ready.end - now.time):
        return None
    return _words(run, state, now, now.time + now.within / falling, _driving(run, state))


def runaway_at(run: Run, state: State) -> str | None:
    """The same of one state: what a force drives so fast that it would be beyond all bounds within no time."""
    now = growth_of(run, state)
    if now is None or now.within > SOON * (run.ready.end - now.time):
        return None
    driving = _driving(run, state)
    return None if driving is None else _words(run, state, now, now.time + now.within, driving)


def _words(run: Run, state: State, now: Growth, ends: float, driving: tuple[str, float] | None) -> str:
    packed = run.ready.packed
    speeds = np.abs(state.y[1] * run.ready.dynamics.per_size).reshape(-1, 3)[1 : len(packed.body_names) - packed.states]
    fastest = packed.body_names[1 + int(np.argmax(speeds.max(axis=1)))]
    what = f"force '{driving[0]}'" if driving is not None else "what drives it"
    under = f"under force '{driving[0]}', which gives {driving[1]:.2g} W, " if driving is not None else ""
    return (
        f"'{fastest}' moves without bound: {under}its speed doubles within some {now.within:.1e} s, in ever shorter "
        f"times, which ends at t = {ends:.6g} s. Limit {what}, add "
        "damping that grows as well, or end the simulation before."
    )


def _driving(run: Run, state: State) -> tuple[str, float] | None:
    """The force that gives most of the power (W) of all inertia, and its power."""
    slope = slope_at(run, state)
    if slope is None:
        return None
    whole = float(run.ready.dynamics.inertia * slope[1] @ state.y[1])
    times = np.array([state.clock[TIME]])
    powers = [(float(loads[0] @ state.y[1]), force.name) for force, loads in loads_by_force(run, times, state.y[None])]
    power, name = max(powers, default=(0.0, ""))
    return (name, power) if power > SHARE * whole > 0.0 else None


JUMP_STEP = 1e-9
"""Part of the longest step within which a force that jumps is looked for where steps shrink to nothing."""


def refusal(run: Run, status: int, state: run_state.State) -> SimulationError:
    """The error of a run whose step ended with ``status`` in ``state``: where, why, and what helps."""
    packed, method = run.ready.packed, run.method
    bodies = len(packed.body_names) - packed.states
    time, speeds = state.clock[run_state.TIME], np.abs(state.y[1].reshape(-1, 3)[1:bodies])
    run.ready.following.wheels.refuse_met(float(time), state.y[0])
    fastest = packed.body_names[1 + int(np.argmax((speeds / [packed.size, packed.size, 1]).max(1)))]
    where = f"{packed.name}: {method.name} stops at t = {time:.6g} s, where '{fastest}' is fastest"
    if status == run_state.NO_CONVERGENCE:
        own = ", or method='dop853'; stiff springs and dampers ask for method='radau'" if method.fixed_step else ""
        return SimulationError(
            f"{where}: the equations of a step of {run.settings.step:.3g} s have no solution near the last one. "
            f"Take a smaller step{own}, or look for a force or law that jumps."
        )
    loads = run.ready.dynamics.loads
    if loads.iteration[FAILED]:
        return SimulationError(f"{where}: {jam(packed, loads.normal[X])}. {REMEDY}, or raise slip_speed.")
    if method.fixed_step:
        return SimulationError(
            f"{where}: numbers are no longer finite after a step of {run.settings.step:.3g} s. "
            "Take a smaller step, or method='dop853'; stiff springs and dampers ask for method='radau'."
        )
    short = f"steps below {state.clock[run_state.STEP]:.1e} s do not meet the tolerance {run.tolerance:g}"
    growing = runaway_at(run, state)
    if growing is not None:
        return SimulationError(f"{where}: {short}; {growing}")
    jumping = jump(run, state, JUMP_STEP * run.settings.longest)
    if jumping is not None:
        return SimulationError(f"{where}: {short}; {jumping}")
    return SimulationError(
        f"{where}: {short}. "
        "The pose is singular here, or a force jumps or grows without bound; change the lengths, smooth the force, "
        "or loosen the tolerance."
    )
