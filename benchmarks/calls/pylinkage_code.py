"""pylinkage: its compiled dyad solver, with velocities and accelerations of the joints, without forces."""

from __future__ import annotations

import itertools
import math
import warnings
from collections.abc import Callable
from importlib import metadata
from typing import Any

import numpy as np

from benchmarks import calls
from benchmarks.harness import Fresh

warnings.filterwarnings("ignore")
from pylinkage.actuators import Crank  # noqa: E402
from pylinkage.components import Ground  # noqa: E402
from pylinkage.dyads import RRRDyad  # noqa: E402
from pylinkage.simulation import Linkage  # noqa: E402

VERSION = metadata.version("pylinkage")
SETTINGS = "step_fast_with_kinematics, pos+vel+acc of joints"


def run(problem: str) -> tuple[str, Fresh, Callable[[Any], float]]:
    """Return settings, a fresh run and the error of its result; a change is of the crank's velocity."""
    steps = len(calls.ANGLES) if problem == calls.FOUR_BAR else calls.STEPS
    swing = calls.START[1]
    end = calls.GROUND + calls.ROCKER * math.cos(swing), calls.ROCKER * math.sin(swing)
    left, right = Ground(0, 0), Ground(calls.GROUND, 0)
    crank = Crank(left, calls.CRANK, 2 * math.pi / steps)
    linkage = Linkage([left, right, crank, RRRDyad(crank.output, right, calls.COUPLER, calls.ROCKER, *end)])
    linkage.set_input_velocity(crank, 1.0)
    speeds = itertools.count()

    def call() -> Any:
        if problem == calls.CHANGED:
            linkage.set_input_velocity(crank, 1.0 + 1e-3 * next(speeds))
        linkage.set_coords([(0, 0), (calls.GROUND, 0), (calls.CRANK, 0), end])
        return linkage.step_fast_with_kinematics(iterations=steps)

    def error(result: Any) -> float:
        tip, place = np.asarray(result[0])[:, 2], np.asarray(result[0])[:, 3]
        rocker = np.arctan2(place[:, 1], place[:, 0] - calls.GROUND)
        return calls.rocker_error(np.arctan2(tip[:, 1], tip[:, 0]), rocker)

    return "set_input_velocity, " * (problem == calls.CHANGED) + SETTINGS, lambda: call, error
