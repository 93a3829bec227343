"""The problems as models of mbsd, as plain data for the other codes, and what their results are held against.

A01   a point mass of 1 kg on a rod of 1 m falls from the horizontal, 10 s; largest change of energy
A02   N four-bars in a row, rods of 1 m and 1 kg, pushed with 1 m/s out of the upright pose, 10 s; largest change of
      energy, and the angle at the end against the equivalent pendulum
A03   Andrews' squeezing mechanism, 0.03 s; largest angle error against the reference of the IVP test set

Sources: IFToMM library of multibody benchmarks, A01 to A03; Bari test set for IVP solvers (andrews).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from mbsd import Mechanism
from mbsd.dynamics.prepare import PreparedDynamics, prepare_dynamics
from mbsd.packing import Packed

G = 9.81


@dataclass(frozen=True)
class Plain:
    """A mechanism of pins in centre-of-mass coordinates (SI)."""

    mass: np.ndarray
    """(nb,) without ground."""
    inertia: np.ndarray
    q: np.ndarray
    """(nb, 3)"""
    v: np.ndarray
    pins: list[tuple[int, float, float, int, float, float]]
    """Body, arm x, y, body, arm x, y; -1 is ground."""
    gravity: float
    torque: tuple[int, float] | None
    spring: tuple[int, float, float, int, float, float, float, float] | None
    """Ends as of a pin, stiffness, free length."""


@dataclass(frozen=True)
class Problem:
    """One problem, and the limits of a valid result."""

    name: str
    duration: float
    largest_drift: float
    """J; infinite where energy is not asked for."""
    largest_error: float
    """rad."""

    @property
    def loops(self) -> int:
        """N of A02."""
        return int(self.name.partition("N=")[2] or 0)

    def mechanism(self) -> Mechanism:
        """As a model of mbsd."""
        if self.name == "A01":
            return pendulum()
        return squeezer() if self.name == "A03" else four_bars(self.loops)

    @cached_property
    def ready(self) -> PreparedDynamics:
        """Ready to integrate."""
        return prepare_dynamics(self.mechanism(), 0.0, self.duration)

    @cached_property
    def plain(self) -> Plain:
        """As plain data."""
        return _plain(self.ready)

    def errors(self, q: np.ndarray, v: np.ndarray) -> tuple[float, float]:
        """(energy change (J), angle error (rad)) of poses and velocities (T, nb, 3)."""
        p = self.plain
        energy = 0.5 * (p.mass * (v[..., 0] ** 2 + v[..., 1] ** 2) + p.inertia * v[..., 2] ** 2)
        energy = (energy + p.mass * p.gravity * q[..., 1]).sum(axis=1)
        drift = float(np.abs(energy - energy[0]).max())
        if self.name == "A01":
            return drift, 0.0
        if self.name == "A03":
            gap = q[-1, :, 2] - REFERENCE
            return 0.0, float(np.abs(gap - 2 * math.pi * np.round(gap / (2 * math.pi))).max())
        return drift, abs(float(q[-1, 0, 2]) - equivalent_pendulum(self.loops, self.duration))

    def valid(self, drift: float, error: float) -> bool:
        """Whether both limits hold."""
        return drift <= self.largest_drift and error <= self.largest_error


def problem(name: str) -> Problem:
    """By name: A01, A02 N=10, A03."""
    if name == "A01":
        return Problem(name, 10.0, 5e-5, math.inf)
    if name == "A03":
        return Problem(name, 0.03, math.inf, 1e-5)
    return Problem(name, 10.0, 0.1, 1e-3)


def pendulum() -> Mechanism:
    """A01."""
    m = Mechanism("A01", gravity=(0.0, -G))
    bob = m.body("bob", 1.0)
    m.revolute("pin", m.ground.at(0, 0), bob.at(1.0, 0))
    m.start_near(bob=0.0)
    return m


def four_bars(loops: int) -> Mechanism:
    """A02."""
    m = Mechanism("A02", gravity=(0.0, -G))
    before = None
    for k in range(loops + 1):
        rod = m.bar(f"rod{k}", 1.0, 1.0)
        m.revolute(f"A{k}", m.ground.at(k, 0), rod.start)
        m.start_near(**{f"rod{k}": 90.0})
        if before is not None:
            coupler = m.bar(f"coupler{k}", 1.0, 1.0)
            m.start_near(**{f"coupler{k}": 0.0})
            m.revolute(f"B{k}", before.end, coupler.start)
            m.revolute(f"C{k}", coupler.end, rod.end)
        before = rod
    m.start_moving(rod0=-1.0)
    return m


def equivalent_pendulum(loops: int, time: float) -> float:
    """Angle (rad) of the rods: the loops move as one pendulum."""
    from scipy.integrate import solve_ivp

    inertia, weight = (loops + 1) / 3 + loops, G * ((loops + 1) / 2 + loops)
    exact = solve_ivp(
        lambda t, y: (y[1], -weight * math.cos(y[0]) / inertia),
        (0.0, time), (math.pi / 2, -1.0), method="DOP853", rtol=1e-13, atol=1e-14,
    )  # fmt: skip
    return float(exact.y[0, -1])


MASS = (0.04325, 0.00365, 0.02373, 0.00706, 0.0705, 0.00706, 0.05498)
INERTIA = (2.194e-6, 4.41e-7, 5.255e-6, 5.667e-7, 1.169e-5, 5.667e-7, 1.912e-5)
START = (-0.06171389001427650, 0.0, 0.455279819163070380, 0.222668390165885884, 0.487364979543842550,
         -0.222668390165885884, 1.23054744454982119)  # fmt: skip
AT_THE_END = (15.8107711962990, -15.7563710598430, 0.0408222401307310, -0.534730116322695, 0.524409965880531,
              0.534730116322695, 1.04808074104226)  # fmt: skip


def _angles(q: tuple[float, ...]) -> np.ndarray:
    """Absolute angles of the bodies from the seven variables of the reference."""
    beta, theta, gamma, phi, delta, omega, epsilon = q
    return np.array([beta, beta + theta, gamma, phi + delta, delta, omega + epsilon, epsilon])


REFERENCE = _angles(AT_THE_END)


def squeezer() -> Mechanism:
    """A03: frames at the centres of mass, turned by the angles of the reference."""
    d, da, e, ea, rr, ra = 0.028, 0.0115, 0.02, 0.01421, 0.007, 0.00092
    ss, sa, sb, sc, sd = 0.035, 0.01874, 0.01043, 0.018, 0.02
    ta, tb, u, ua, ub, zf, zt, fa = 0.02308, 0.00916, 0.04, 0.01228, 0.00449, 0.02, 0.04, 0.01421
    m = Mechanism("A03", gravity=None)
    k = [
        m.body(f"K{n + 1}", mass, inertia=inertia) for n, (mass, inertia) in enumerate(zip(MASS, INERTIA, strict=True))
    ]
    a, b, c = m.ground.at(-0.06934, -0.00227), m.ground.at(-0.03635, 0.03273), m.ground.at(0.014, 0.072)
    m.revolute("O", m.ground.at(0, 0), k[0].at(-ra, 0))
    m.revolute("F", k[0].at(rr - ra, 0), k[1].at(da, 0))
    point = k[1].at(da - d, 0)
    m.revolute("E3", point, k[2].at(-sb, sa - ss))
    m.revolute("B", b, k[2].at(-sb, sa))
    m.revolute("E4", point, k[3].at(0, -ea))
    m.revolute("G", k[3].at(0, e - ea), k[4].at(zt - ta, -tb))
    m.revolute("A5", a, k[4].at(-ta, -tb))
    m.revolute("E6", point, k[5].at(fa, 0))
    m.revolute("H", k[5].at(fa - zf, 0), k[6].at(ub, ua - u))
    m.revolute("A7", a, k[6].at(ub, ua))
    m.torque("motor", k[0], 0.033)
    m.spring("spring", c, k[2].at(sd - sb, sa - sc), 4530.0, free_length=0.07785)
    m.start_near(**{body.name: math.degrees(angle) for body, angle in zip(k, _angles(START), strict=True)})
    return m


def _plain(ready: PreparedDynamics) -> Plain:
    packed: Packed = ready.packed
    system = packed.system

    def end(marker: int) -> tuple[int, float, float]:
        x, y = system.marker_arm[marker]
        return int(system.marker_body[marker]) - 1, float(x), float(y)

    pins = [(*end(i), *end(j)) for i, j in packed.markers]
    torque = spring = None
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.name == "torque":
            torque = end(j)[0], float(force.params["torque"])
        else:
            spring = (*end(i), *end(j), force.params["stiffness"], force.params["free_length"])
    shape = (-1, 3)
    return Plain(
        system.mass[1:], system.inertia[1:], ready.initial.q.reshape(shape)[1:], ready.initial.v.reshape(shape)[1:],
        pins, float(-system.gravity[1]), torque, spring,
    )  # fmt: skip
