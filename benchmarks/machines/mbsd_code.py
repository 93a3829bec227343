"""mbsd: the machines as a user writes them; sweeps give all velocities and accelerations, too."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

import mbsd
from benchmarks import calls, machines
from benchmarks.dynamics.mbsd_code import started
from mbsd.dynamics.prepare.prepare import prepare_dynamics
from mbsd.dynamics.simulate import integrator_named
from mbsd.kinematics.march import kinematics_at
from mbsd.kinematics.prepared import prepare as prepared

VERSION = mbsd.__version__
TOLERANCE = 1e-7


def settings(problem: str) -> str:
    """In words."""
    return f"dop853, tolerance {TOLERANCE:g}" if problem == machines.CONTACT else "by parts, pos+vel+acc"


def planetary() -> mbsd.Mechanism:
    """One planet, which the sun and a ring of ground turn."""
    m = mbsd.Mechanism("planetary")
    sun, planet, carrier = m.body("sun"), m.body("planet"), m.bar("carrier", calls.CRANK)
    coupler, rocker = m.bar("coupler", calls.COUPLER), m.bar("rocker", calls.ROCKER)
    m.revolute("S", m.ground.at(0, 0), sun.origin)
    m.revolute("A", m.ground.at(0, 0), carrier.start)
    m.revolute("P", carrier.end, planet.origin)
    inner, outer = machines.SUN, machines.SUN + 2 * machines.PLANET
    m.gear_pair("sun planet", sun.origin, planet.origin, radius_i=inner, radius_j=machines.PLANET)
    m.gear_pair("ring", m.ground.at(0, 0), planet.origin, radius_i=outer, radius_j=machines.PLANET, internal=True)
    m.revolute("B", carrier.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(calls.GROUND, 0), rocker.start)
    m.drive_angle("motor", sun, mbsd.constant_rate(1.0))
    theta, swing = (math.degrees(x) for x in calls.START)
    m.start_near(sun=0, planet=0, carrier=0, coupler=theta, rocker=swing)
    return m


def geneva() -> mbsd.Mechanism:
    """Crank and wheel."""
    m = mbsd.Mechanism("geneva")
    crank, wheel = m.body("crank"), m.body("wheel")
    m.revolute("O", m.ground.at(0, 0), crank.origin)
    m.revolute("W", m.ground.at(machines.DISTANCE, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, machines.SLOTS, machines.RADIUS)
    m.drive_angle("motor", crank, mbsd.constant_rate(1.0))
    start = machines.exact(machines.GENEVA, np.array([-machines.INDEX]))
    m.start_near(crank=math.degrees(-machines.INDEX), wheel=math.degrees(start[0, 0]))
    return m


def cam() -> mbsd.Mechanism:
    """A round disc off its centre as the cam, its pitch curve a circle that the roller's centre stays on."""
    m = mbsd.Mechanism("cam")
    disc, arm = m.body("cam"), m.bar("arm", machines.ARM)
    m.revolute("O", m.ground.at(0, 0), disc.origin)
    m.revolute("P", m.ground.at(machines.PIVOT, 0), arm.start)
    turn = np.linspace(0.0, 2 * np.pi, 721)
    circle = np.stack([machines.ECCENTRIC + machines.DISC * np.cos(turn), machines.DISC * np.sin(turn)], axis=1)[:-1]
    m.point_on_curve("roller", disc.origin, arm.end, circle.tolist(), closed=True)
    m.drive_angle("motor", disc, mbsd.constant_rate(1.0))
    m.start_near(cam=0, arm=math.degrees(machines.exact(machines.CAM, np.zeros(1))[0, 0]))
    return m


def ball() -> mbsd.Mechanism:
    """Held upright, so that its height is all that is left to find."""
    m = mbsd.Mechanism("ball", gravity=(0.0, -machines.GRAVITY))
    disc = m.body("ball", 1.0, inertia=1.0)
    m.prismatic("guide", m.ground.at(0, 0, math.pi / 2), disc.at(0, 0, math.pi / 2))
    m.contact("floor", m.ground.origin, disc.origin, machines.STIFFNESS, exponent=1.0)
    m.start_near(ball=(0.0, machines.HEIGHT, 0.0))
    return m


SWEEPS = {machines.PLANETARY: planetary, machines.GENEVA: geneva, machines.CAM: cam}


def prepare(problem: str) -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    """``fresh`` gives a run, whose making is not timed; ``error`` looks at what it returned."""
    if problem == machines.CONTACT:
        return _falling()
    times = machines.angles(problem)
    ready = prepared(SWEEPS[problem](), float(times[0]), float(times[-1]))
    names = [ready.packed.body_names.index(name) for name in machines.WATCHED[problem]]

    def error(result: tuple[np.ndarray, ...]) -> float:
        return machines.worst(result[0][:, names, 2], machines.exact(problem, times))

    return lambda: lambda: kinematics_at(ready, times), error


def _falling() -> tuple[Callable[[], Callable[[], Any]], Callable[[Any], float]]:
    ready = prepare_dynamics(ball(), 0.0, machines.DURATION)
    method = integrator_named("ball", "dop853")
    ends = np.array([0.0, machines.DURATION])

    def fresh() -> Callable[[], Any]:
        to_end, out = started(ready, method, TOLERANCE, ends)
        return lambda: (to_end(), out)

    return fresh, lambda result: abs(float(result[1].y[-1, 0, 4]) - machines.height(machines.DURATION))
