"""pylinkage: its compiled dyad solver with positions, velocities and accelerations; no forces."""

from __future__ import annotations

import itertools
import math
import warnings
from importlib import metadata
from typing import Any

import numpy as np

from benchmarks.calls import CHANGED, STEPS, SWEEP, Call, rocker_error
from benchmarks.four_bar import COUPLER, CRANK, GROUND, ROCKER, exact

warnings.filterwarnings("ignore")
from pylinkage.actuators import Crank  # noqa: E402
from pylinkage.components import Ground  # noqa: E402
from pylinkage.dyads import RRRDyad  # noqa: E402
from pylinkage.simulation import Linkage  # noqa: E402

VERSION = metadata.version("pylinkage")
SETTINGS = "step_fast_with_kinematics, pos+vel+acc of joints"


def calls() -> list[Call]:
    """By problem; of a simulation it has none."""
    swing = float(exact(np.zeros(1))[1][0])
    start = [(0, 0), (GROUND, 0), (CRANK, 0), (GROUND + ROCKER * math.cos(swing), ROCKER * math.sin(swing))]
    left, right = Ground(0, 0), Ground(GROUND, 0)
    crank = Crank(left, CRANK, 2 * math.pi / STEPS)
    linkage = Linkage([left, right, crank, RRRDyad(crank.output, right, COUPLER, ROCKER, *start[3])])
    linkage.set_input_velocity(crank, 1.0)
    speeds = itertools.count()

    def again() -> Any:
        linkage.set_coords(start)
        return linkage.step_fast_with_kinematics(iterations=STEPS)

    def changed() -> Any:
        linkage.set_input_velocity(crank, 1.0 + 1e-3 * next(speeds))
        return again()

    def error(result: Any) -> float:
        tip, place = np.asarray(result[0])[:, 2], np.asarray(result[0])[:, 3]
        return rocker_error(np.arctan2(tip[:, 1], tip[:, 0]), np.arctan2(place[:, 1], place[:, 0] - GROUND))

    return [Call(SWEEP, SETTINGS, again, error), Call(CHANGED, f"set_input_velocity, {SETTINGS}", changed, error)]
