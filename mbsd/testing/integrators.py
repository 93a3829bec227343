"""Checks of an integrator: its order on a pendulum, and closed constraints on a four-bar.

sin(phi / 2) = k sn(K(k) - w t, k),   k = sin(phi_0 / 2),   w^2 = g / l
"""

from __future__ import annotations

import math

import numpy as np
from scipy.special import ellipj, ellipk

from mbsd.dynamics.integrators.kind import Integrator
from mbsd.mechanism import Mechanism

GRAVITY, AMPLITUDE, OUTPUTS = 9.81, math.radians(100), 10
ROUNDING = 1e-11
"""Errors below this (rad) say nothing about an order."""


def check_integrator(method: Integrator) -> None:
    """Measure the order of a method, and the residuals of its outputs on and between steps.

    Methods of fixed step must show their ``order`` to a quarter when the step is halved. Others must show it to one,
    since their steps are not equal, and their error must fall with the tolerance. Raises AssertionError.
    """
    steps, errors = errors_of(method, pendulum, "rod", exact_pendulum)
    order = order_of(steps, errors)
    lowest = method.order - (0.25 if method.fixed_step else 1.0)
    if method.order and not order > lowest:
        raise AssertionError(f"{method.name}: the measured order is {order:.2f}; it must be above {lowest:g}")
    largest = 1e-3 if method.fixed_step else 1e-6 if method.order else 1e-4
    if not errors[-1] < min(largest, 0.1 * errors[0]):
        raise AssertionError(
            f"{method.name}: the pendulum's errors are {', '.join(f'{error:.2g}' for error in errors)} rad with "
            f"finer and finer {'steps' if method.fixed_step else 'tolerances'}; the last must be below "
            f"{min(largest, 0.1 * errors[0]):.2g}"
        )
    sol = four_bar().simulate(times=[0.0, 0.1, 0.1234, 0.35, 0.5], method=method.name, step=2e-3)
    residuals = {"position": (sol.stats.position_residual, 1e-6), "velocity": (sol.stats.velocity_residual, 1e-4)}
    for name, (residual, bound) in residuals.items():
        if not residual < bound:
            raise AssertionError(
                f"{method.name}: {name} residuals of a four-bar's outputs reach {residual:.2g}; project() after each "
                f"step keeps them below {bound:g}"
            )


def measured_order(method: Integrator) -> float:
    """The order that a method has on the pendulum."""
    return order_of(*errors_of(method, pendulum, "rod", exact_pendulum))


def errors_of(method: Integrator, make, body: str, exact, durations=(1.0, 10.0)) -> tuple[np.ndarray, np.ndarray]:
    """Return steps and errors (rad, rms of outputs) of finer and finer runs, above rounding.

    ``make`` builds the mechanism, and ``exact`` gives the angle of a body at times (s). Fixed steps run over the first
    duration (s), tolerances over the second, so that their steps are not bound by it.
    """
    duration = durations[0 if method.fixed_step else 1]
    expected = exact(np.linspace(0.0, duration, OUTPUTS + 1))
    steps, errors = [], []
    for k in range(5):
        setting = {"step": 0.02 / 2**k} if method.fixed_step else {"tolerance": 10.0 ** (-4 - k)}
        sol = make().simulate(duration, steps=OUTPUTS, method=method.name, **setting)
        error = float(np.sqrt(np.mean((sol.body(body).theta - expected) ** 2)))
        if error > ROUNDING:
            steps.append(sol.stats.steps)
            errors.append(error)
    return np.array(steps, float), np.array(errors)


def order_of(steps: np.ndarray, errors: np.ndarray) -> float:
    """The slope of log error over log steps; the coarsest run is left out."""
    return float(-np.polyfit(np.log(steps[1:]), np.log(errors[1:]), 1)[0])


def pendulum() -> Mechanism:
    """A rod of 1.5 m, which swings as a mass on a string of 1 m, from 100 degrees beside the vertical."""
    m = Mechanism("pendulum", gravity=(0.0, -GRAVITY))
    rod = m.bar("rod", 1.5, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=math.degrees(AMPLITUDE) - 90.0)
    return m


def exact_pendulum(t: np.ndarray | float) -> np.ndarray:
    """Angle of that rod from the x axis (rad) at times (s), in elliptic functions."""
    k = math.sin(AMPLITUDE / 2)
    sn = ellipj(ellipk(k * k) - math.sqrt(GRAVITY) * np.asarray(t), k * k)[0]
    return 2 * np.arcsin(k * sn) - math.pi / 2


def four_bar() -> Mechanism:
    """A closed chain that falls."""
    m = Mechanism("four-bar", gravity=(0.0, -GRAVITY))
    crank, coupler, rocker = m.bar("crank", 0.3, 1.0), m.bar("coupler", 0.9, 0.5), m.bar("rocker", 0.7, 2.0)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(0.8, 0), rocker.start)
    m.start_near(crank=50, coupler=20, rocker=80)
    return m
