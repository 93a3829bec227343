"""Events that last a moment: a tip that passes close by a point, found by simulations and search."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize_scalar

from mbsd import Mechanism, constant_rate, curve, distance_reaches, harmonic
from mbsd.model.body import Body
from mbsd.results.solution import Solution
from tools.models.assur_models import MODELS
from tools.random_mechanisms.linkages import linkage
from tools.random_mechanisms.machines import solid
from tools.random_mechanisms.subject import TOLERANCE, Subject, family

# Simulated mechanisms: chains, loops, friction, redundant joints, drivers beside freedoms; forces of all kinds.


def chain(m: Mechanism, rng: np.random.Generator, count: int, cart: bool) -> list[Body]:
    """Bars in a row, from ground or from a cart, some without mass between others."""
    at, bodies = m.ground.at(0.1, 0.2), []
    if cart:
        slope = float(rng.uniform(-0.5, 0.5))
        first = solid(m, "cart", rng, 0.2)
        m.prismatic("rail", m.ground.at(0.0, 0.0, slope), first.at(0, 0, float(rng.uniform(-1, 1))))
        m.start_moving(cart=(0.5 * math.cos(slope), 0.5 * math.sin(slope), 0.0))
        at = first.at(0.1, -0.1)
        bodies.append(first)
    for k in range(count):
        length, mass = float(rng.uniform(0.15, 1.0)), float(rng.uniform(0.2, 2.0))
        bar = m.bar(f"bar{k}", length, mass, (0.5 * length, float(rng.normal(scale=0.05))))
        m.revolute(f"pin{k}", at, bar.start)
        m.start_near(**{bar.name: float(rng.uniform(-180, 0))})
        m.start_moving(**{bar.name: float(rng.uniform(-3, 3))})
        at = bar.end
        bodies.append(bar)
    return bodies


def some_force(m: Mechanism, rng: np.random.Generator, name: str, bodies: list[Body]) -> None:
    """Add a force of a random kind on one of ``bodies`` but the first, which is ground.

    Its size fits 1 kg and 1 m.
    """
    second = bodies[int(rng.integers(1, len(bodies)))]
    first = [body for body in bodies if body is not second][int(rng.integers(len(bodies) - 1))]
    i, j = (body.at(*(float(x) for x in rng.normal(scale=0.3, size=2))) for body in (first, second))
    kind = str(rng.choice(_KINDS))
    if kind == "spring":
        m.spring(name, i, j, float(rng.uniform(5, 100)), float(rng.uniform(0, 3)), float(rng.uniform(0.1, 0.6)))
    elif kind == "spring in time":
        m.spring(name, i, j, harmonic(10.0, 5.0, 0.0, 40.0), 1.0, 0.3)
    elif kind == "torsion":
        m.torsion_spring(name, first, second, float(rng.uniform(0.5, 8)), float(rng.uniform(0, 0.3)), 0.4)
    elif kind == "bushing":
        m.bushing(name, i, j, (20.0, 35.0, 1.0), (0.5, 0.4, 0.02), float(rng.uniform(-1, 1)))
    elif kind == "actuator":
        m.actuator(name, i, j, harmonic(4.0, 6.0), along_axis=bool(rng.random() < 0.5))
    elif kind == "curve":
        m.curve_of_length(name, i, j, curve([0.0, 0.5, 1.0, 2.0], [5.0, 1.0, -2.0, -6.0], "spline"))
    elif kind == "angle curve":
        m.curve_of_angle(name, first, second, curve([-3, -1, 1, 3], [3.0, 1.0, -1.0, -3.0], "spline"))
    elif kind == "torque":
        m.torque(name, second, harmonic(1.5, 4.0), against=first)
    elif kind == "force":
        m.force(name, j, 3.0, float(rng.uniform(-3, 3)), frame=second if rng.random() < 0.5 else None)
    elif kind == "drag":
        m.drag(name, j, 0.3, 0.02, (float(rng.normal()), float(rng.normal())))
    elif kind == "rotating frame":
        m.rotating_frame(name, float(rng.uniform(-2, 2)), (0.3, -0.2))
    elif kind == "gravitation":
        m.gravitation(name, m.ground.at(6.0, 5.0), j, -20.0)
    elif kind == "user":
        m.user_force(name, pull_home, second)


_KINDS = (
    "spring",
    "spring in time",
    "torsion",
    "bushing",
    "actuator",
    "curve",
    "angle curve",
    "torque",
    "force",
    "drag",
    "rotating frame",
    "gravitation",
    "user",
)


def pull_home(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
    """A soft spring to the world's origin, with a damper: a user's function."""
    return -3.0 * q[0] - 0.2 * v[0], -3.0 * q[1] - 0.2 * v[1], -0.1 * v[2] + 0.2 * math.sin(3.0 * t)


@family("chain with forces", 2.0)
def chain_with_forces(rng: np.random.Generator) -> Subject:
    """One to four bars and up to three forces of any kind."""
    m = Mechanism("chain")
    bodies = [m.ground, *chain(m, rng, int(rng.integers(1, 5)), bool(rng.random() < 0.3))]
    for k in range(int(rng.integers(0, 4))):
        some_force(m, rng, f"force{k}", bodies)
    return Subject(m, float(rng.uniform(0.2, 0.8)), False)


@family("closed linkage, free", 2.0)
def free_linkage(rng: np.random.Generator) -> Subject:
    """Loops with springs and dampers, thrown."""
    made = linkage(int(rng.integers(10**9)), int(rng.integers(1, 4)), damping=bool(rng.random() < 0.5))
    speeds = {bar.name: float(rng.uniform(-2, 2)) for host, bar in made.cranks if host.name == "ground"}
    made.m.start_moving(**speeds)
    return Subject(made.m, float(rng.uniform(0.1, 0.5)), False)


@family("model of each group, freed", 1.5)
def freed_group(rng: np.random.Generator) -> Subject:
    """Without its driver, or with a pendulum beside it."""
    m = MODELS[str(rng.choice(list(MODELS)))]()
    m.gravity = (0.5, -9.81)
    if rng.random() < 0.5:
        m.drivers.clear()
    else:
        bob = m.bar("bob", 0.2, 0.5)
        m.revolute("hang", list(m.bodies.values())[-2].at(0.05, 0.02), bob.start)
        m.start_near(bob=-60)
    return Subject(m, float(rng.uniform(0.1, 0.5)), False)


@family("friction of joints")
def with_friction(rng: np.random.Generator) -> Subject:
    """A chain or slider-crank whose joints have friction, smooth or by events."""
    sticks = bool(rng.random() < 0.4)
    m = Mechanism("friction")
    chain(m, rng, int(rng.integers(1, 3)), cart=bool(rng.random() < 0.5))
    for k, (name, joint) in enumerate(list(m.joints.items())):
        own = {"radius": 0.02} if joint.kind.name == "revolute" else {}
        m.friction(
            f"friction{k}",
            name,
            float(rng.uniform(0.05, 0.4)),
            preload=float(rng.uniform(0, 3)),
            slip_speed=None if sticks else 0.02,
            sticks=sticks,
            **own,
        )
    traits = {"sticks", "contacts"} if sticks else {"stiff"}
    return Subject(m, float(rng.uniform(0.1, 0.4)), False, traits=frozenset(traits))


@family("four-bars in a row, free")
def four_bars_in_a_row(rng: np.random.Generator) -> Subject:
    """Return one to five parallelograms of equal bars that swing as one pendulum.

    They pass through the poses where all lie flat.

    With n of them, w the angle of the n + 1 rods:  ((n + 1) / 3 + n) w'' = -g ((n + 1) / 2 + n) cos(w).
    """
    count, length = int(rng.integers(1, 6)), float(rng.uniform(0.3, 1.5))
    m, start, speed = Mechanism("row", (0.0, -9.81)), float(rng.uniform(0.5, 2.6)), float(rng.uniform(-2, 2))
    for k in range(count + 1):
        bar = m.bar(f"rod{k}", length, 1.0)
        m.revolute(f"foot{k}", m.ground.at(k * length, 0), bar.start)
        m.start_near(**{bar.name: math.degrees(start)})
        m.start_moving(**{bar.name: speed})
        if k:
            deck = m.bar(f"deck{k}", length, 1.0)
            m.revolute(f"left{k}", m.bodies[f"rod{k - 1}"].end, deck.start)
            m.revolute(f"right{k}", deck.end, bar.end)
            m.start_near(**{deck.name: 0.0})
    pull = 9.81 * ((count + 1) / 2 + count) / (((count + 1) / 3 + count) * length)

    def judge(sol: Solution) -> list[str]:
        exact = solve_ivp(
            lambda t, y: (y[1], -pull * np.cos(y[0])),
            (0.0, sol.t[-1]),
            (start, speed),
            method="DOP853",
            t_eval=sol.t,
            rtol=1e-13,
            atol=1e-13,
        )
        off = np.abs(sol.body(f"rod{count}").theta - exact.y[0])
        k = int(np.argmax(off))
        return [] if off[k] < 1e-6 else [f"the last rod is {off[k]:.3g} rad off at t = {sol.t[k]:.6g} s"]

    return Subject(m, float(rng.uniform(0.5, 2.0)), False, truth=judge, traits=frozenset({"bifurcates"}))


@family("redundant joints, free")
def redundant(rng: np.random.Generator) -> Subject:
    """A parallelogram of three cranks let swing, or a slider guided twice."""
    m = Mechanism("redundant")
    if rng.random() < 0.5:
        coupler = solid(m, "coupler", rng, 0.4)
        start = float(rng.uniform(-2.4, -0.7))
        for k, x in enumerate((0.0, 0.2, 0.5)):
            bar = m.bar(f"bar{k}", 0.4, float(rng.uniform(0.2, 1.0)))
            m.revolute(f"foot{k}", m.ground.at(x, 0.1 * k), bar.start)
            m.revolute(f"head{k}", coupler.at(x, 0.1 * k), bar.end)
            m.start_near(**{bar.name: math.degrees(start)})
        m.start_near(coupler=(0.4 * math.cos(start), 0.4 * math.sin(start), 0))
        m.start_moving(bar0=float(rng.uniform(-2, 2)))
    else:
        block, bar = solid(m, "block", rng), m.bar("bar", 0.5, 1.0)
        m.prismatic("guide", m.ground.at(0, 0, 0.2), block.origin)
        m.prismatic("second guide", m.ground.at(0.1, 0.1 * math.tan(0.2), 0.2), block.at(0.3, 0.0))
        m.revolute("pin", block.origin, bar.start)
        m.start_near(block=(0, 0, math.degrees(0.2)), bar=float(rng.uniform(-150, -30)))
        m.start_moving(bar=float(rng.uniform(-3, 3)))
    m.spring("spring", m.ground.at(1.0, 1.0), list(m.bodies.values())[-1].at(0.1, 0.1), 20.0, 0.5, 0.3)
    return Subject(m, float(rng.uniform(0.2, 0.6)), False)


@family("massless bodies, free")
def massless(rng: np.random.Generator) -> Subject:
    """Return a mechanism with a massless coupler or rods, or a point mass without inertia."""
    m = Mechanism("massless")
    if rng.random() < 0.5:
        crank, coupler, rocker = m.bar("crank", 0.2, 1.0), m.bar("coupler", 0.6), m.bar("rocker", 0.5, 1.5)
        m.revolute("A", m.ground.origin, crank.start)
        m.revolute("B", crank.end, coupler.start)
        m.revolute("C", coupler.end, rocker.end)
        m.revolute("D", m.ground.at(0.6, 0.0), rocker.start)
        m.start_near(crank=float(rng.uniform(20, 160)), coupler=20, rocker=80)
        m.start_moving(crank=float(rng.uniform(-4, 4)))
    else:
        bob = m.body("bob", float(rng.uniform(0.3, 2.0)))
        m.revolute("A", m.ground.origin, bob.at(0.1, float(rng.uniform(0.3, 1.0))))
        m.start_near(bob=float(rng.uniform(-90, 90)))
        m.start_moving(bob=float(rng.uniform(-3, 3)))
    return Subject(m, float(rng.uniform(0.2, 0.6)), False)


@family("drivers beside freedoms")
def partly_driven(rng: np.random.Generator) -> Subject:
    """A driven carriage or crank with a chain hung on it."""
    m = Mechanism("partly driven")
    if rng.random() < 0.5:
        base = solid(m, "cart", rng, 0.2)
        m.prismatic("rail", m.ground.origin, base.origin)
        m.drive_coordinate("push", m.ground.origin, base.origin, harmonic(0.2, float(rng.uniform(2, 8))))
        m.start_near(cart=(0, 0, 0))
        hook = base.at(0.05, -0.1)
    else:
        base = m.bar("crank", 0.2, 1.0)
        m.revolute("O", m.ground.origin, base.start)
        m.drive_angle("motor", base, constant_rate(float(rng.uniform(-6, 6)), 0.3))
        hook = base.end
    for k in range(int(rng.integers(1, 3))):
        bar = m.bar(f"bar{k}", 0.4, 1.0)
        m.revolute(f"pin{k}", hook, bar.start)
        m.start_near(**{bar.name: float(rng.uniform(-150, -30))})
        hook = bar.end
    return Subject(m, float(rng.uniform(0.2, 0.6)), False)


# Numbers far apart: masses of connected bodies, and forces of the user that overflow beside the motion.


STEPS = 2000
"""More are looked at: usual are 20 to 200."""
COARSER = 100.0
"""Times the tolerance with which such a motion is simulated again."""
GROW = 2.5
"""Steps against those of that motion above which rounding asks for them: a method of order 8 takes the eighth root of
COARSER, 1.8 times as many (measured: 1.7), and one solution of the equations of motion too few 47 times and more."""


@family("masses far apart")
def heavy(rng: np.random.Generator) -> Subject:
    """A chain or a closed linkage of which some bodies are up to 1e11 times as heavy."""
    if rng.random() < 0.6:
        m = Mechanism("heavy")
        chain(m, rng, int(rng.integers(2, 5)), bool(rng.random() < 0.3))
    else:
        m = linkage(int(rng.integers(10**9)), 1, damping=False).m
        m.start_moving(**{next(name for name in m.bodies if name != "ground"): float(rng.uniform(-2, 2))})
    times = float(10 ** rng.uniform(5, 11))
    bodies = [name for name, body in m.bodies.items() if name != "ground" and body.mass > 0]
    for name in rng.choice(bodies, max(1, len(bodies) // 3), replace=False):
        body = m.bodies[str(name)]
        m.change(body.name, mass=body.mass * times, inertia=body.inertia * times)
    return Subject(m, float(rng.uniform(0.2, 0.6)), False, truth=_few_steps)


def _few_steps(sol: Solution) -> list[str]:
    """Steps that rounding asks for.

    Light bodies that a heavy one pulls straight swing and snap within microseconds, which takes thousands of steps in
    any coordinates. Those grow with the tolerance as the method's order says.
    """
    if sol.stats.steps <= STEPS:
        return []
    coarser = sol.mechanism.simulate(times=sol.t, tolerance=COARSER * TOLERANCE).stats.steps
    if sol.stats.steps <= GROW * coarser:
        return []
    return [f"{sol.stats.steps} steps, {coarser} with {COARSER:g} times the tolerance"]


@family("stiff forces of the user")
def stiff(rng: np.random.Generator) -> Subject:
    """Return a body that is braked by a power or an exponential of its speed.

    That overflows in trial states.
    """
    m, power = Mechanism("braked"), int(rng.choice([0, 3, 5, 9]))
    size, scale = float(10 ** rng.uniform(0, 4)), float(rng.uniform(10, 40))
    free = rng.random() < 0.5
    body = m.body("body", 1.0, inertia=0.1) if free else m.bar("body", 0.5, 1.0)
    if not free:
        m.revolute("pin", m.ground.origin, body.start)  # pyright: ignore[reportAttributeAccessIssue]
        m.start_near(body=-40)

    def brake(speed: float) -> float:
        return -size * speed**power if power else -math.exp(scale * speed) + math.exp(-scale * speed)

    def function(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, float, float]:
        return (brake(v[0]), 0.0, 0.0) if free else (0.0, 0.0, 0.05 * brake(v[2]))

    m.user_force("brake", function, body)
    fast = float(rng.uniform(0.2, 1.0)) * (1.0 if power == 0 else 3.0)
    m.start_moving(body=(fast, 0.0, 0.0) if free else fast)
    return Subject(m, float(rng.uniform(0.05, 0.3)), False, traits=frozenset({"stiff"}))


LOOKS = 4000
CLEAR = 2e-2
"""Part of a distance within which a passage counts as grazing, and is not judged."""


@family("events that last a moment")
def passing(rng: np.random.Generator) -> Subject:
    """One or two bars, and a point beside the path of their end."""
    m = Mechanism("passing")
    end = chain(m, rng, int(rng.integers(1, 3)), False)[-1].end
    duration = float(rng.uniform(0.3, 1.0))
    m.trace("tip", end)
    dense = m.simulate(duration, steps=LOOKS, tolerance=1e-11)
    at = int(rng.integers(LOOKS // 10, LOOKS))
    tip = dense.point("tip")
    place, speed = np.stack([tip.x, tip.y]), np.stack([tip.vx, tip.vy])
    near = float(10 ** rng.uniform(-5, -1))
    across = np.array([-speed[1, at], speed[0, at]]) / np.hypot(*speed[:, at])
    x, y = (place[:, at] + float(rng.uniform(-1.5, 1.5)) * near * across).tolist()
    m.event("near", distance_reaches(m.ground.at(x, y), end, near))
    away = CubicHermiteSpline(dense.t, place.T - [x, y], speed.T)
    passages = _passages(away, dense.t, near)
    return Subject(m, duration, False, truth=_meets(passages), traits=frozenset({"events"}))


def _passages(away: CubicHermiteSpline, t: np.ndarray, near: float) -> list[float] | None:
    """Return times of the closest places nearer than ``near`` (m).

    None where one grazes or the ends are near.
    """

    def distance(time: float) -> float:
        return float(np.hypot(*away(time)))

    apart = np.hypot(*away(t).T)
    if min(apart[0], apart[-1]) < 3 * near:
        return None
    out = []
    for k in np.flatnonzero((apart[1:-1] <= apart[:-2]) & (apart[1:-1] <= apart[2:])) + 1:
        nearest: Any = minimize_scalar(
            distance, bounds=(t[k - 1], t[k + 1]), method="bounded", options={"xatol": 1e-13}
        )
        if abs(nearest.fun - near) < CLEAR * near + 1e-7:
            return None
        if nearest.fun < near:
            farthest = np.hypot(*away(np.linspace(out[-1], nearest.x, LOOKS)).T).max() if out else np.inf
            if abs(farthest - near) < CLEAR * near + 1e-7:
                return None
            if farthest > near:  # else it has not left since
                out.append(float(nearest.x))
    return out


def _meets(passages: list[float] | None) -> Callable[[Solution], list[str]]:
    def problems(sol: Solution) -> list[str]:
        if passages is None:
            return []
        times = [event.time for event in sol.events]
        between = [a < passed < b for a, passed, b in zip(times[::2], passages, times[1::2], strict=False)]
        if len(times) == 2 * len(passages) and all(between):
            return []
        return [f"events at {times} s, but the tip passes at {passages} s"]

    return problems
