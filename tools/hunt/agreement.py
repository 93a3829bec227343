"""Agreement of two solutions of one mechanism in different words, and its bounds.

Compared are numbers that do not depend on the description: places, velocities and accelerations of centres of mass and
angles of bodies, carried back into the first description; forces and moments that joints and drivers give; energies.
Reactions are left out where joints are redundant, since they are not unique there; efforts are still differences of
them, so that their size counts.

Driven motions. Newton-Raphson ends below 1e-12 of the mechanism's size, closed forms at rounding. Either is a
residual, which the Jacobian's inverse turns into an error of the pose of about the residual times 1 / margin, margin
the ratio of its least to its largest singular value. Velocities solve with the same Jacobian at that pose and lose
1 / margin again, accelerations, reactions and efforts twice. So with e = DRIVEN / margin the bounds are e, e / margin
and e / margin^2 of the largest value of their kind. Instants where that is above USELESS are not compared. Where joints
are redundant, the rows that are solved are only some of all, worse conditioned than the margin of all tells: there e
is DRIVEN_REDUNDANT / margin. A law known by its values alone has derivatives that err (:func:`of_law`): the error of f'
over margin adds to velocities, that of f'' over margin to accelerations, which also go with the square of velocities;
forces have the part of accelerations, over margin again.

Free motions. A tolerance bounds the error of a step, and the motion carries it on. How much is measured: the same
mechanism is simulated with its velocities and its gravity changed by NUDGE = 1e-6, and what comes of it divided by
NUDGE is the growth of errors. The bound is SLACK tolerance (growth + largest value), for each kind of number by
itself; the tolerance is the sum of both solutions'. SLACK = 1000 is the sum over a few hundred steps, each of which
may err by the tolerance. Chaotic motions have a growth that makes the bound useless after some time; instants where it
is more than USELESS = 1e-3 of the largest value are not compared.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbsd import Mechanism
from mbsd.model.joint import Joint
from mbsd.model.laws import Motion
from mbsd.model.laws.fitting.fit import fit
from mbsd.model.laws.fitting.leaves import BEND_OF_LAST, ROUNDING, given_cuts
from mbsd.model.laws.fitting.sampling import Sampled, look_times
from mbsd.model.laws.function import Function
from mbsd.model.laws.splines import Table
from mbsd.results.solution import Solution
from tools.random_mechanisms.described import BASE, NOWHERE, Pose, Raised

# How exactly derivatives of a driver's law are known of which values alone are given.
#
# Those of a Python function come from a fit.
#
# Of a piece of the fit, w wide, the last Chebyshev coefficients are below c, and rounding hides r of f
# (mbsd/model/laws/fitting/leaves.py: both are in its Leaves). T_8' = 64 and T_8'' = 1344 at the ends of -1 .. 1, so
#
#     |error of f''| <= 1344 (2 / w)^2 max(c, r),      |error of f'| <= 64 (2 / w) max(c, r)
#
# Fits over other spans err otherwise, so two solutions differ by the sum of both. A table of values at times h apart is
# a spline of degree 5. Each value is rounded by eps |f| / 2; at its ends, where derivatives are those of the polynomial
# through six values, their weights add up to 21 / h and 53 / h^2. What that makes of the motion follows below.


SLOPE_OF_LAST = 64.0
"""T_8' at the ends."""
SLOPE_OF_SIX, BEND_OF_SIX = 21.0, 53.0
"""Sums of the weights, without their signs, of six values at even times in the derivatives at the first."""


@dataclass(frozen=True)
class LawError:
    """Errors of all drivers together, lengths in sizes of the mechanism."""

    slope: float = 0.0
    """Error of f' (1/s)."""
    bend: float = 0.0
    """Error of f'' (1/s^2)."""

    def __add__(self, other: LawError) -> LawError:
        return LawError(self.slope + other.slope, self.bend + other.bend)


def law_error(sol: Solution) -> LawError:
    """Error of the laws of a solution, over its span."""
    out, first, last = LawError(), float(sol.t[0]), float(sol.t[-1])
    if not last > first:
        last = first + 1.0  # as the solver does
    for driver in sol.mechanism.drivers.values():
        assert driver.motion is not None
        error = of_law(driver.motion, first, last)
        scale = 1.0 if "angle" in driver.kind.name else sol.packed.size
        out += LawError(error.slope / scale, error.bend / scale)
    return out


def of_law(law: Motion, first: float, last: float) -> LawError:
    """Error of one law between two times (s), in its own unit; none of laws that know their derivatives."""
    raised_by = 0.0
    while isinstance(law, Raised):
        law, raised_by = law.law, raised_by + abs(law.by)
    if isinstance(law, Table):
        shortest, largest = float(np.diff(law.times).min()), float(np.abs(law.values).max()) + raised_by
        rounding = float(np.finfo(float).eps) * largest
        return LawError(SLOPE_OF_SIX / 2 * rounding / shortest, BEND_OF_SIX / 2 * rounding / shortest**2)
    if not isinstance(law, Function) or law.df is not None:
        return LawError()
    looks, f = look_times(first, last, law.shortest), law.f
    sampled = Sampled(lambda times: np.array([float(f(t)) for t in times]))
    leaves = fit(sampled, first, last, given_cuts(law.breaks, first, last), looks, False).leaves
    off = np.maximum(leaves.last, leaves.rounding + ROUNDING * raised_by)
    halves = 2.0 / leaves.width
    return LawError(float((SLOPE_OF_LAST * halves * off).max()), float((BEND_OF_LAST * halves**2 * off).max()))


DRIVEN, DRIVEN_REDUNDANT = 1e-11, 1e-9
VALVED = 300.0
"""Times the bounds where ports open and close: the flow of gas bends sharply there, in a stiff motion."""
SLACK = 1000.0
NUDGE = 1e-6
USELESS = 1e-3

Numbers = dict[str, np.ndarray]


@dataclass
class Words:
    """The difference of a description from the first one.

    Frames of bodies and ground as in ``seen_from``; efforts with the other sign; joints whose bodies are exchanged show
    by their names; a mirror image; other units.
    """

    frames: Mapping[str, Pose] = field(default_factory=dict)
    turned_round: frozenset[str] = frozenset()
    """Drivers whose value and effort have the other sign."""
    mirrored: bool = False
    """True if it is the mirror image about the x axis."""
    length: float = 1.0
    mass: float = 1.0
    """How many times as large numbers of length and mass are."""

    @property
    def sense(self) -> float:
        """-1 where angles and moments have the other sign."""
        return -1.0 if self.mirrored else 1.0

    def vector(self, array: Any, unit: float) -> Any:
        """Complex places or forces in the first description; ``unit`` of their numbers."""
        return np.conj(array / unit) if self.mirrored else array / unit


SAME = Words()


def turned_drivers(first: Mechanism, other: Mechanism) -> frozenset[str]:
    """Drivers of relative angles whose bodies changed places."""
    return frozenset(
        name
        for name, driver in other.drivers.items()
        if driver.kind.name == "drive_relative_angle" and driver.i.body.name != first.drivers[name].i.body.name
    )


def numbers(sol: Solution, first: Solution, words: Words, rows: np.ndarray, first_rows: np.ndarray) -> Numbers:
    """(T, ...) arrays of a solution at some of its times, in the words of ``first``."""
    ground = words.frames.get("ground", NOWHERE)
    turn = ground[2]
    back_to_first = np.exp(1j * turn)
    places, rates, bends = [], [], []
    for name in first.packed.body_names[1:]:
        b = sol.packed.body_names.index(name)
        own = words.frames.get(name, NOWHERE)[2] - turn
        at, velocity, acceleration = (array[rows, b] for array in (sol.q, sol.v, sol.a))
        far = words.vector((at[:, 0] + 1j * at[:, 1]) * back_to_first + complex(ground[0], ground[1]), words.length)
        places += [far.real, far.imag, words.sense * (at[:, 2] - own)]
        for array, out in ((velocity, rates), (acceleration, bends)):
            carried = words.vector((array[:, 0] + 1j * array[:, 1]) * back_to_first, words.length)
            out += [carried.real, carried.imag, words.sense * array[:, 2]]
    out = {"q": np.stack(places, 1), "v": np.stack(rates, 1), "a": np.stack(bends, 1)}
    if not first.mobility.redundant_rows and not sol.mobility.redundant_rows:
        forces = []
        for name, joint in first.mechanism.joints.items():
            view, other = sol.joint(name), first.joint(name)
            second = sol.mechanism.joints[name].j.body.name
            sign = 1.0 if joint.j.body.name in (second, "ground" if second == BASE else second) else -1.0
            force = sign * words.vector((view.fx + 1j * view.fy)[rows] * back_to_first, words.mass * words.length)
            at = (view.x + 1j * view.y)[rows] * back_to_first + complex(ground[0], ground[1])
            arm = words.vector(at, words.length) - (other.x + 1j * other.y)[first_rows]
            turning = words.sense * view.torque[rows] / (words.mass * words.length**2)
            moment = sign * turning + (np.conj(arm) * force).imag
            forces += [force.real, force.imag, moment]
        if forces:
            out["reactions"] = np.stack(forces, 1)
    efforts = [
        sol.driver(name).effort[rows] * (-1.0 if name in words.turned_round else 1.0) / _unit_of_effort(driver, words)
        for name, driver in first.mechanism.drivers.items()
    ]
    if efforts:
        out["efforts"] = np.stack(efforts, 1)
    energy = sol.energy
    potential = energy.potential - energy.potential[0]
    out["energies"] = np.stack([energy.kinetic[rows], potential[rows]], 1) / (words.mass * words.length**2)
    return out


def _unit_of_effort(driver: Joint, words: Words) -> float:
    """Return a torque or a force of 1 in other units."""
    angular = "angle" in driver.kind.name
    return words.sense * words.mass * words.length**2 if angular else words.mass * words.length


def common(first: Solution, other: Solution) -> tuple[np.ndarray, np.ndarray]:
    """Rows of both at the times they share."""
    close = 1e-11 * max(1e-300, float(np.ptp(first.t)))
    k = np.clip(np.searchsorted(first.t, other.t - close), 0, len(first.t) - 1)
    rows = np.flatnonzero(np.abs(first.t[k] - other.t) <= close)
    return k[rows], rows


def sizes(values: Numbers, size: float, first: Solution) -> dict[str, float]:
    """Largest value of each kind, at least what rounding of the mechanism's size makes of it.

    Of efforts it is that of the usual forces of the ``first`` solution: a motor may hold up a small difference of large
    ones, and what its power gains or loses is their error.
    """
    largest = {key: float(np.abs(array[np.isfinite(array)]).max(initial=0.0)) for key, array in values.items()}
    out = dict(largest)
    out["q"] = max(size, 1.0)
    out["v"] = max(largest["v"], 1e-9)
    turning = float(np.abs(values["v"][:, 2::3]).max(initial=0.0))
    out["a"] = max(largest["a"], turning**2, 1e-9)  # where bodies turn evenly, accelerations cancel
    force = max(largest.get("reactions", 0.0), largest.get("efforts", 0.0), 1e-9)
    if "reactions" not in largest:
        usual = float(np.median(np.abs(first.wrench).max(axis=(1, 2), initial=0.0)))
        force = max(force, usual if np.isfinite(usual) else 0.0)
    for key in ("reactions", "efforts"):
        if key in out:
            out[key] = force
    out["energies"] = max(largest["energies"], 1e-9)
    return out


POWERS = {"q": 0, "v": 1, "a": 2, "reactions": 2, "efforts": 2, "energies": 2}
"""Powers of 1 / margin in the bounds of driven motions."""


@dataclass
class Verdict:
    """Outcome of a comparison."""

    compared: int
    """Instants."""
    worst: float
    """Largest difference over its bound."""
    words: str = ""

    @property
    def agrees(self) -> bool:
        """True if all is within bounds."""
        return self.worst <= 1.0


def judge(first: Solution, there: Numbers, here: Numbers, limits: dict[str, np.ndarray], t: np.ndarray) -> Verdict:
    """Both in the same words at the same times; limits (T,) of each kind, infinite where not compared."""
    worst, said, compared = 0.0, "", 0
    for key, limit in limits.items():
        gap = np.abs(there[key] - here[key])
        finite = np.isfinite(limit)
        compared = max(compared, int(finite.sum()))
        if not finite.any() or not gap.size:
            continue
        share = gap / limit[:, None]
        share[~finite] = 0.0
        share[np.isnan(share)] = np.inf
        k, column = np.unravel_index(int(np.argmax(share)), share.shape)
        if share[k, column] > worst:
            worst = float(share[k, column])
            said = (
                f"{key} of {_whose(first, key, int(column))} at t = {t[k]:.9g} s is {there[key][k, column]:.12g}, was "
                f"{here[key][k, column]:.12g}: {gap[k, column]:.3g} apart, bound {limit[k]:.3g}"
            )
    return Verdict(compared, worst, said)


def _whose(first: Solution, key: str, column: int) -> str:
    if key in ("q", "v", "a"):
        return first.packed.body_names[1 + column // 3] + " " + ("x", "y", "theta")[column % 3]
    if key == "reactions":
        return list(first.mechanism.joints)[column // 3] + " " + ("fx", "fy", "moment")[column % 3]
    return list(first.mechanism.drivers)[column] if key == "efforts" else ("kinetic", "potential")[column]


def valves(sol: Solution) -> float:
    """Return times the usual bounds that hold for a mechanism with or without valves of gas."""
    return VALVED if any(force.kind.valved for force in sol.mechanism.forces.values()) else 1.0


def driven_limits(
    first: Solution, rows: np.ndarray, size: dict[str, float], loosened: float, laws: LawError
) -> dict[str, np.ndarray]:
    """Bounds of a driven motion; ``loosened`` is added to DRIVEN, as the tolerance of an integrator."""
    margin = np.clip(first.singularity_margin[rows], 1e-12, None)
    e = ((DRIVEN_REDUNDANT if first.mobility.redundant_rows else DRIVEN * valves(first)) + loosened) / margin
    rate, bend = laws.slope * size["q"] / size["v"] / margin, laws.bend * size["q"] / size["a"] / margin
    by_laws = {"v": rate, "energies": 2 * rate, "a": bend + 2 * rate}
    by_laws["reactions"] = by_laws["efforts"] = by_laws["a"] / margin
    out = {}
    for key, largest in size.items():
        limit = e / margin ** POWERS[key] + by_laws.get(key, 0.0)
        out[key] = np.where(limit < USELESS, limit * largest + 1e-13, np.inf)
    return out


def compare_driven(first: Solution, other: Solution, words: Words = SAME, loosened: float = 0.0) -> Verdict:
    """See the top."""
    first_rows, rows = common(first, other)
    if not len(rows):
        return Verdict(0, 0.0)
    here = numbers(first, first, SAME, first_rows, first_rows)
    there = numbers(other, first, words, rows, first_rows)
    shared = {key: here[key] for key in here if key in there}
    size = sizes(shared, _extent(first, other, words), first)
    laws = law_error(first) + law_error(other)
    return judge(first, there, shared, driven_limits(first, first_rows, size, loosened, laws), first.t[first_rows])


def _extent(first: Solution, other: Solution, words: Words) -> float:
    """Size with the way the world was moved (m): rounding goes with it."""
    reached = [float(np.abs(sol.q[..., :2]).max()) / unit for sol, unit in ((first, 1.0), (other, words.length))]
    return max(first.packed.size, *reached)


@dataclass
class Growth:
    """Growth of a nudge of NUDGE, over NUDGE: the largest so far at each output of the first solution."""

    of: dict[str, np.ndarray]

    @staticmethod
    def between(first: Solution, nudged: Solution) -> Growth:
        """From the same times."""
        rows = np.arange(len(first.t))
        here, there = (numbers(sol, first, SAME, rows, rows) for sol in (first, nudged))
        return Growth(
            {
                key: np.maximum.accumulate(np.abs(there[key] - here[key]).max(axis=1, initial=0.0)) / NUDGE
                for key in here
                if key in there
            }
        )

    def larger(self, other: Growth) -> Growth:
        """The larger of two nudges."""
        return Growth({key: np.maximum(values, other.of[key]) for key, values in self.of.items()})


def compare_free(
    first: Solution, other: Solution, growth: Growth, tolerance: float, words: Words = SAME, slack: float = SLACK
) -> Verdict:
    """See the top; ``tolerance`` is the sum of both solutions'."""
    first_rows, rows = common(first, other)
    if not len(rows):
        return Verdict(0, 0.0)
    here = numbers(first, first, SAME, first_rows, first_rows)
    there = numbers(other, first, words, rows, first_rows)
    shared = {key: here[key] for key in here if key in there and key in growth.of}
    size = sizes(shared, _extent(first, other, words), first)
    limits = {}
    for key, largest in size.items():
        grown = growth.of[key][first_rows]
        limit = slack * tolerance * (grown + largest) + 1e-12 * largest
        limits[key] = np.where(limit < USELESS * max(largest, 1e-6), limit, np.inf)
    return judge(first, there, shared, limits, first.t[first_rows])
