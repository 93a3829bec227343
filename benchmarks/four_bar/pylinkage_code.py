"""pylinkage: its compiled dyad solver, positions, velocities and accelerations of the joints."""

from __future__ import annotations

import math
import warnings
from importlib import metadata
from typing import Any

import numpy as np

from benchmarks.four_bar import ANGLES, COUPLER, CRANK, GROUND, ROCKER, STEPS, exact, worst

warnings.filterwarnings("ignore")
from pylinkage.actuators import Crank  # noqa: E402
from pylinkage.components import Ground  # noqa: E402
from pylinkage.dyads import RRRDyad  # noqa: E402
from pylinkage.simulation import Linkage  # noqa: E402

VERSION = metadata.version("pylinkage")
SETTINGS = "step_fast_with_kinematics, pos+vel+acc of joints"


def prepare() -> tuple[Any, Any]:
    """``solve`` and ``error`` for measure.py."""
    swing = float(exact(np.zeros(1))[1][0])
    c = GROUND + ROCKER * math.cos(swing), ROCKER * math.sin(swing)
    left, right = Ground(0, 0), Ground(GROUND, 0)
    crank = Crank(left, CRANK, 2 * math.pi / STEPS)
    rocker = RRRDyad(crank.output, right, COUPLER, ROCKER, *c)
    linkage = Linkage([left, right, crank, rocker])

    def solve() -> Any:
        linkage.set_coords([(0, 0), (GROUND, 0), (CRANK, 0), c])
        return linkage.step_fast_with_kinematics(iterations=STEPS)

    def error(result: Any) -> float:
        place = np.asarray(result[0])[:, -1]
        angle = np.arctan2(place[:, 1], place[:, 0] - GROUND)
        wanted = exact(ANGLES)[1]
        return min(worst(np.roll(angle, shift), wanted) for shift in (0, 1))  # its first row is after one step

    return solve, error
