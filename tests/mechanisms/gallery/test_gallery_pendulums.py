"""Pendulums of the gallery: period by the elliptic integral, energy, losses, modes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipk

from mechanisms.double_pendulum import mechanism as double_pendulum
from mechanisms.pendulum import mechanism as pendulum


@pytest.mark.parametrize("start", [pendulum.VARIANTS["small"]["start"], pendulum.Params().start, 175.0])
def test_period_of_a_pendulum_by_the_elliptic_integral(start: float) -> None:
    p = pendulum.Params(start=start)
    natural = math.sqrt(2 * p.length / (3 * p.gravity))  # of a uniform rod about its end
    period = 4 * natural * float(ellipk(math.sin(math.radians(start) / 2) ** 2))
    sol = pendulum.build(p).simulate(times=[0.0, period / 2, period, 3 * period], tolerance=1e-11)
    swing = np.degrees(sol.body("rod").theta) + 90.0
    np.testing.assert_allclose(swing, [start, -start, start, start], atol=1e-5)
    assert sol.audit is not None
    assert np.ptp(sol.audit) < 1e-9 * p.mass * p.gravity * p.length


def test_damping_takes_what_a_pendulum_loses() -> None:
    p = pendulum.Params(**pendulum.VARIANTS["damped"])
    sol = pendulum.build(p).simulate(pendulum.DURATION, 400, tolerance=1e-10)
    loss = np.gradient(sol.energy.total, sol.t, edge_order=2) + p.damping * sol.body("rod").omega ** 2
    assert np.abs(loss).max() < 0.02 * p.damping * (sol.body("rod").omega ** 2).max()
    assert sol.energy.total[-1] < sol.energy.total[0]


def test_double_pendulum_keeps_its_energy_and_swings_in_its_modes() -> None:
    p = double_pendulum.Params()
    m = double_pendulum.build(p)
    sol = m.simulate(double_pendulum.DURATION, 600, tolerance=1e-10)
    energy = sol.energy.total
    assert np.ptp(energy) < 1e-8 * np.ptp(sol.energy.kinetic)
    # Frequencies of small swings of two uniform rods, from det(K - w^2 M) = 0.
    (a, b), (m1, m2), g = p.lengths, p.masses, p.gravity
    mass = np.array([[m1 * a**2 / 3 + m2 * a**2, m2 * a * b / 2], [m2 * a * b / 2, m2 * b**2 / 3]])
    stiffness = np.diag([(m1 / 2 + m2) * g * a, m2 * g * b / 2])
    wanted = np.sort(np.sqrt(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)) / (2 * math.pi)
    m.start_near(upper=-90, lower=-90)
    np.testing.assert_allclose([mode.frequency for mode in m.modes()], wanted, rtol=1e-6)


def test_neighbouring_double_pendulums_part() -> None:
    ends = []
    for start in (double_pendulum.Params().start, double_pendulum.VARIANTS["beside"]["start"]):
        m = double_pendulum.build(double_pendulum.Params(start=start))
        point = m.simulate(double_pendulum.DURATION, 600, tolerance=1e-10).point("P")
        ends.append(np.stack([point.x, point.y], axis=1))
    apart = np.linalg.norm(ends[0] - ends[1], axis=1)
    assert apart[0] < 0.001
    assert apart.max() > 0.1
