"""mbsd: DOP853 in coordinates that the program chooses; the sweep with accelerations."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

import mbsd
from benchmarks import space
from mbsd.dynamics.integrators.dop853 import DOP853
from mbsd.kinematics.steps import Steps
from mbsd.measures import final
from mbsd.spatial import Mechanism, constant_rate
from mbsd.spatial.dynamics.simulate import Run
from mbsd.spatial.kinematics.prepared import prepare as swept
from mbsd.spatial.kinematics.sweep import march_along

VERSION = mbsd.__version__
TOLERANCES = dict(zip(space.PROBLEMS[:-1], (3.5e-6, 5e-5, 3e-7, 2e-5, 5e-4), strict=True))


def settings(problem: str) -> str:
    """Return the settings of a run in words."""
    if problem == space.SWEEP:
        return "pos+vel+acc"
    if problem == space.BATCH:
        return f"simulate_many, one thread, tolerance {TOLERANCES[space.TOP]:g}"
    return f"dop853, tolerance {TOLERANCES[problem]:g}"


def top() -> Mechanism:
    """Return the top; its centre of mass is watched."""
    m = Mechanism("top", gravity=(0, 0, -9.81))
    body = m.body("top", space.TOP_MASS, com=(0, 1, 0), inertia=space.TOP_MOMENTS)
    m.spherical("ball", m.ground, body, at=(0, 0, 0))
    m.start_moving({"top": space.SPIN})
    m.trace("watched", body, at=(0, 1, 0))
    return m


def bricard() -> Mechanism:
    """Return the loop of five rods and ground."""
    m = Mechanism("Bricard", gravity=(0, -9.81, 0))
    links = [m.ground]
    for k in range(1, 6):
        com = np.add(space.CORNERS[k - 1], space.CORNERS[k]) / 2
        links.append(m.body(f"rod {k}", 1.0, com=com, inertia=space.moments_of_rod(k)))
    for k in range(6):
        m.revolute(f"hinge {k}", links[k], links[(k + 1) % 6], at=space.CORNERS[k], axis=space.AXES[k])
    m.trace("watched", links[3], at=space.CORNERS[3])
    return m


def chain(count: int) -> Mechanism:
    """Return bars that hang on one another by universal joints."""
    m = Mechanism("chain", gravity=(0, 0, -9.81))
    before = m.ground
    for k in range(count):
        bar = m.body(f"bar {k}", space.LINK_MASS, com=(0.1 * k + 0.05, 0, 0), inertia=space.LINK_MOMENTS)
        m.universal(f"joint {k}", before, bar, at=(0.1 * k, 0, 0), first=(0, 1, 0), second=(0, 0, 1))
        before = bar
    m.start_moving({f"bar {k}": (0.0, 0.0, 3.0) for k in range(count)})
    m.trace("watched", before, at=(0.1 * count, 0, 0))
    return m


def slider_crank() -> Mechanism:
    """Return the slider-crank of Haug (1989)."""
    m = Mechanism("slider-crank")
    crank = m.body("crank", 0.12, com=(0, 0.1, 0.16), inertia=(1e-4, 1e-4, 1e-5))
    rod = m.rod("rod", space.PIN, space.EYE, mass=0.5, radius=0.01)
    slider = m.body("slider", 2.0, com=space.EYE, inertia=(1e-4, 1e-4, 1e-4))
    along = np.subtract(space.EYE, space.PIN)
    m.revolute("bearing", m.ground, crank, at=space.BEARING, axis=(1, 0, 0))
    m.spherical("ball", crank, rod, at=space.PIN)
    m.universal("cross", slider, rod, at=space.EYE, first=(0, 0, 1), second=np.cross((0, 0, 1), along))
    m.prismatic("rail", m.ground, slider, at=space.EYE, axis=(1, 0, 0))
    m.drive_turn("motor", "bearing", constant_rate(space.RATE))
    m.trace("watched", slider, at=space.EYE)
    return m


def mechanism(problem: str) -> Mechanism:
    """Return the mechanism of a problem."""
    return {space.TOP: top, space.BRICARD: bricard, space.SWEEP: slider_crank}.get(
        problem, lambda: chain(space.CHAINS[problem])
    )()


def prepare(problem: str) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    """``fresh`` gives a run, whose making is not timed; ``error`` makes one of its own."""
    if problem == space.SWEEP:
        m, times = slider_crank(), np.arange(1, space.STEPS + 1) / space.STEPS
        ready = swept(m, float(times[0]), float(times[-1]))
        same_fields: Any = ready.packed

        def error(_: Any) -> float:
            sol = m.sweep(times=times)
            return float(np.abs(sol.point("watched").x - space.slide(space.angles())).max())

        def sweep() -> Callable[[], Any]:
            ready.packed.ws.guess[:] = ready.turns
            return lambda: march_along(ready, Steps(same_fields, times), False, np.zeros(0))

        return sweep, error
    if problem == space.BATCH:
        return _prepare_batch()
    ends, tolerance = np.array([0.0, space.DURATION[problem]]), TOLERANCES[problem]
    run = Run(mechanism(problem), ends, tolerance)
    whole, scratch = run.settings(), run.scratch()

    def fresh() -> Callable[[], Any]:
        dyn, (state, out) = run.dynamics(), run.begun()
        return lambda: DOP853.advance(dyn, scratch, state, out, whole, float(ends[-1]), 10**9)

    def error_at_end(_: Any) -> float:
        sol = mechanism(problem).simulate(times=ends, tolerance=tolerance)
        return space.error_at_end(problem, sol.point("watched").place[-1])

    return fresh, error_at_end


def _prepare_batch() -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    m = top()
    measure = {axis: final(f"watched.{axis}") for axis in "xyz"}

    def fresh() -> Callable[[], Any]:
        return lambda: m.simulate_many(
            space.DURATION[space.TOP], moving={"top": space.spins()}, measure=measure,
            tolerance=TOLERANCES[space.TOP], threads=1,
        )  # fmt: skip

    return fresh, lambda many: space.error_at_end(space.TOP, np.array([many[axis][0] for axis in "xyz"]))
