"""scipy by hand: index-1 equations in numpy with projection.

The pendulum also as the one equation of its angle.
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import scipy
from scipy import integrate

from benchmarks.dynamics.cases import Case
from benchmarks.dynamics.equations import SingularPose, equations
from benchmarks.dynamics.pins import Record
from benchmarks.dynamics.settings import steps_of, tolerances

VERSION = scipy.__version__
MOST_STEPS = 20_000
Steps = list[tuple[float, np.ndarray]]


def ladders(case: Case) -> Iterator[list[dict[str, Any]]]:
    """Settings to try, each ladder from cheap to exact."""
    if case.name.startswith("A01"):
        for method in ("dop853", "dopri5", "lsoda", "odeint"):
            yield [{"model": "angle", "method": method, "tolerance": tol} for tol in tolerances(1e-3, 1e-11, 4)]
        return
    # Without projection the swings leave their branch; the smallest problem shows it.
    # LSODA, once it takes long chains for stiff, differences hundreds of columns at every step.
    small = len(case.model.pins) < 15
    for method in ("DOP853", "RK45"):
        for projections in (2, 1, 0) if small else (2, 1):
            yield [
                {"model": "pins", "method": method, "projections": projections, "tolerance": tol}
                for tol in tolerances(1e-2, 1e-10)
            ]
    for method in ("dop853", "dopri5", "lsoda") if small else ("dop853", "dopri5"):
        for within in (True, False) if small else (True,):
            yield [
                {"model": "pins", "method": method, "projected rates": within, "tolerance": tol}
                for tol in tolerances(1e-2, 1e-10)
            ]
    first = 300 if case.name.startswith("A02") else 200
    for projections in (1, 2):
        yield [
            {"model": "pins", "method": "RK4", "projections": projections, "steps": n}
            for n in steps_of(first, 10_000, 1.2)
        ]


def prepare(case: Case, settings: dict[str, Any]) -> tuple[Callable[[], Callable[[], Any]], Callable[[], Record]]:
    """Return ``fresh``, which makes a run ready to be timed, and ``record``, its motion step by step."""
    method = settings["method"]
    if settings["model"] == "angle":
        start, rates, unpack = angle(case)
        project = None
    else:
        written = equations(case.model)
        rates = written.projected_rates if settings.get("projected rates") else written.rates
        project = written.project
        start = np.concatenate([part.ravel() for part in case.model.start])

        def unpack(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            y = project(y) if settings.get("projected rates") else y
            return y[: written.size].reshape(-1, 3), y[written.size :].reshape(-1, 3)

    integrator = {"DOP853": _stepper, "RK45": _stepper, "RK4": _rk4, "odeint": _odeint}.get(method, _compiled)

    def fresh() -> Callable[[], Any]:
        return lambda: integrator(rates, project, start, case.duration, settings, None)

    def record() -> Record:
        steps: Steps = [(0.0, np.array(start, float))]
        with contextlib.suppress(SingularPose):  # the record ends before the time does
            integrator(rates, project, start, case.duration, settings, steps)
        states = [unpack(np.asarray(y)) for _, y in steps]
        return Record(
            np.array([t for t, _ in steps]), np.array([q for q, _ in states]), np.array([v for _, v in states])
        )

    return fresh, record


def angle(case: Case) -> tuple[np.ndarray, Callable, Callable]:
    """theta'' = -(g / l) cos(theta), theta from the x axis."""
    (solid,) = case.model.solids
    length = -case.model.pins[0].b[0]
    rate, cosine = -case.model.gravity / length, math.cos

    def rates(_t: float, y: np.ndarray) -> tuple[float, float]:
        theta, omega = y.tolist()
        return omega, rate * cosine(theta)

    def unpack(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        theta, omega = y
        c, s = length * math.cos(theta), length * math.sin(theta)
        return np.array([[c, s, theta]]), np.array([[-s * omega, c * omega, omega]])

    return np.array([solid.pose[2], 0.0]), rates, unpack


def _stepper(
    rates: Any, project: Any, start: np.ndarray, end: float, settings: dict[str, Any], steps: Steps | None
) -> None:
    """scipy's own classes, with projections after each accepted step."""
    tolerance = settings["tolerance"]
    solver = getattr(integrate, settings["method"])(rates, 0.0, start, end, rtol=tolerance, atol=tolerance)
    while solver.status == "running":
        solver.step()
        y = solver.y
        for _ in range(settings["projections"]):
            y = project(y)
        if settings["projections"]:
            solver.y, solver.f = y, rates(solver.t, y)
        if steps is not None:
            steps.append((solver.t, y))


def _rk4(
    rates: Any, project: Any, start: np.ndarray, end: float, settings: dict[str, Any], steps: Steps | None
) -> None:
    y, h = start, end / settings["steps"]
    for k in range(settings["steps"]):
        t = k * h
        first = rates(t, y)
        second = rates(t, y + h / 2 * first)
        third = rates(t, y + h / 2 * second)
        fourth = rates(t, y + h * third)
        y = y + h / 6 * (first + 2 * second + 2 * third + fourth)
        for _ in range(settings["projections"]):
            y = project(y)
        if steps is not None:
            steps.append((t + h, y))


def _compiled(
    rates: Any, project: Any, start: np.ndarray, end: float, settings: dict[str, Any], steps: Steps | None
) -> None:
    """scipy.integrate.ode: the loop is compiled, and leaves no room for a projection between its steps."""
    del project
    tolerance = settings["tolerance"]
    solver = integrate.ode(rates)
    solver.set_integrator(settings["method"], rtol=tolerance, atol=tolerance, nsteps=MOST_STEPS)
    if steps is not None and settings["method"] != "lsoda":
        solver.set_solout(lambda t, y: steps.append((t, y.copy())))
    solver.set_initial_value(start, 0.0)
    if steps is not None and settings["method"] == "lsoda":
        for t in np.linspace(0, end, 1001)[1:]:
            solver.integrate(t)
            steps.append((t, solver.y.copy()))
        return
    solver.integrate(end)


def _odeint(
    rates: Any, project: Any, start: np.ndarray, end: float, settings: dict[str, Any], steps: Steps | None
) -> None:
    """LSODA behind its oldest and shortest interface."""
    del project
    tolerance = settings["tolerance"]
    times = np.array([0.0, end]) if steps is None else np.linspace(0, end, 1001)
    solved = integrate.odeint(rates, start, times, tfirst=True, rtol=tolerance, atol=tolerance, mxstep=MOST_STEPS)
    if steps is not None:
        steps[:] = list(zip(times.tolist(), solved, strict=True))
