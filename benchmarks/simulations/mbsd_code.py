"""The doors by mbsd: m.simulate_many, and the study that makes each by itself."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

import mbsd
from benchmarks.simulations import DURATION, LENGTH, MASS, OUTPUTS
from mbsd.dynamics.measures.kinds import Measure
from mbsd.measures import final, first


def build(stiffness: float, damping: float, preload: float) -> mbsd.Mechanism:
    """One door, seen from above."""
    m = mbsd.Mechanism("door", gravity=None)
    door = m.bar("door", LENGTH, mass=MASS)
    m.revolute("hinge", m.ground.at(0, 0), door.start)
    m.torsion_spring("closer", m.ground, door, stiffness, damping, free_angle=-preload / stiffness)
    m.start_near(door=90)
    return m


def measure(m: mbsd.Mechanism) -> dict[str, float]:
    """When it is shut, and how fast it is then, as docs/study.md has it."""
    sol = m.simulate(DURATION, steps=OUTPUTS)
    door = sol.body("door")
    shut = np.flatnonzero(door.theta < math.radians(1.0))
    if not len(shut):
        raise ValueError(f"it is still open by {math.degrees(door.theta[-1]):.0f} degrees")
    return {"time": float(sol.t[shut[0]]), "speed": float(-door.omega[shut[0]])}


def study(values: np.ndarray) -> None:
    """Each built, simulated and measured by Python."""
    points = [dict(zip(("stiffness", "damping", "preload"), row, strict=True)) for row in values.tolist()]
    mbsd.study(build, points, measure, folder=None, processes=1, progress=False)


SHUT = math.radians(1.0)
WHEN = {"time": first("door.theta", below=SHUT), "speed": first("door.theta", below=SHUT, give="door.omega")}
END = {"angle": final("door.theta")}


def study_in_loop(values: np.ndarray, processes: int = 1) -> Any:
    """Each built by Python, all simulated in the loop up to the output at which they are shut."""
    points = [dict(zip(("stiffness", "damping", "preload"), row, strict=True)) for row in values.tolist()]
    measured = mbsd.simulated(WHEN, DURATION, steps=OUTPUTS)
    return mbsd.study(build, points, measured, folder=None, processes=processes, progress=False)


def many(values: np.ndarray, measures: Mapping[str, Measure], tolerance: float = 1e-7, threads: int = 1) -> Any:
    """All in the loop: measures from as many outputs as in the study, or the final angle alone."""
    stiffness, damping, preload = values.T
    return build(5.0, 10.0, 2.0).simulate_many(
        DURATION,
        vary={"closer": {"stiffness": stiffness, "damping": damping, "free_angle": -preload / stiffness}},
        measure=measures,
        steps=1 if measures is END else OUTPUTS,
        tolerance=tolerance,
        threads=threads,
    )
