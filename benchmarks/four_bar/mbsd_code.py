"""mbsd: the general solver, positions, velocities and accelerations of all bodies."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

import mbsd
from benchmarks.four_bar import ANGLES, COUPLER, CRANK, GROUND, ROCKER, exact, worst
from mbsd.kinematics import prepared as ready_to_solve
from mbsd.kinematics.march import kinematics_at

VERSION = mbsd.__version__
SETTINGS = "closed form of its groups, found by the program, pos+vel+acc"


def model() -> mbsd.Mechanism:
    """The linkage, driven at 1 rad/s."""
    m = mbsd.Mechanism("four_bar")
    crank, coupler, rocker = m.bar("crank", CRANK), m.bar("coupler", COUPLER), m.bar("rocker", ROCKER)
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.end)
    m.revolute("D", m.ground.at(GROUND, 0), rocker.start)
    m.drive_angle("motor", crank, mbsd.constant_rate(1.0))
    theta, swing = exact(np.zeros(1))
    m.start_near(crank=0, coupler=math.degrees(theta[0]), rocker=math.degrees(swing[0]))
    return m


def prepare() -> tuple[Any, Any]:
    """``solve`` and ``error`` for measure.py."""
    ready = ready_to_solve.prepare(model())

    def error(result: tuple[np.ndarray, ...]) -> float:
        coupler, rocker = exact(ANGLES)
        return max(worst(result[0][:, 2, 2], coupler), worst(result[0][:, 3, 2], rocker))

    return lambda: kinematics_at(ready, ANGLES), error
