"""The stop of a driven motion: the last moment at which the links close, with the motion up to there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd import AssemblyError, BranchError, LimitError, Mechanism, MechanismError, SingularPoseError, Solution
from mechanisms.stages.loading import loading
from shared.stage.errors import UserError

STEPS = 360
FEWEST = 3
"""Moments of a motion that can be shown."""
FINER = 20
"""Halvings after the grid: the angle is known to a millionth of a step."""
OPENS = (AssemblyError, BranchError, LimitError, SingularPoseError)


@dataclass(frozen=True)
class Stop:
    """Place and reason of a stop."""

    time: float
    """s"""
    drivers: dict[str, float]
    """Their values there: rad, or m."""
    text: str
    """Message of the solver."""


def until_it_stops(name: str, module: Any, m: Mechanism, solve: Callable[[], Solution]) -> tuple[Solution, Stop | None]:
    """Return the solution of ``solve``, or the motion up to the moment when the links open.

    Raises UserError as ``solve`` does where there is no motion at all, or the author solves it himself.
    """
    try:
        return solve(), None
    except UserError as error:
        if not isinstance(error.__cause__, OPENS) or hasattr(module, "motion") or not m.drivers:
            raise
        longest = _longest(m, loading.constant(name, module, "DURATION"))
        if longest is None:
            raise
        values = {driver: float(longest.driver(driver).value[-1]) for driver in m.drivers}
        return longest, Stop(float(longest.t[-1]), values, str(error))


def _longest(m: Mechanism, duration: Any) -> Solution | None:
    from mbsd.kinematics.sweep import sweep_times

    try:
        grid = sweep_times(m, duration, STEPS, None)
    except MechanismError:
        return None

    def swept(times: np.ndarray) -> Solution | None:
        try:
            return m.sweep(times=times)
        except MechanismError:
            return None

    good, bad = 0, len(grid) - 1
    while bad - good > 1:
        middle = (good + bad) // 2
        good, bad = (middle, bad) if swept(grid[: middle + 1]) else (good, middle)
    if good < FEWEST - 1:
        return None
    last, beyond = float(grid[good]), float(grid[bad])
    for _ in range(FINER):
        middle = (last + beyond) / 2
        last, beyond = (middle, beyond) if swept(np.append(grid[: good + 1], middle)) else (last, middle)
    times = np.append(grid[: good + 1], last) if last > grid[good] else grid[: good + 1]
    return swept(times)
