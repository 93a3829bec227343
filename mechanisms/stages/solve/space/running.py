"""The run of a mechanism in space: swept by its drivers or simulated, and the masses that its parts give.

Rows lie so close together that no body turns by more than :data:`LARGEST_TURN` from one to the next: the film goes on
between them by quintics, whose error falls with the sixth power of the step.
"""

from __future__ import annotations

import math
import sys
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from shared.contract.quantity import written
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from mbsd.spatial.mechanism import Mechanism
    from mbsd.spatial.results.solution import Solution
    from shared.contract import BodyParts

SWEEP_STEPS = 360
"""Steps of a sweep whose mechanism.py has no STEPS."""
FEWEST, MOST, RATE = 360, 14_400, 120.0
"""Steps of a simulation without STEPS: so many a second, within these."""
LARGEST_TURN = 0.35
"""Turn of a body from row to row (rad)."""
ROUNDS = 3


def is_in_space(thing: object) -> bool:
    """Return True for a mechanism or solution of mbsd.spatial, which is not imported for that."""
    known = (("mbsd.spatial.mechanism", "Mechanism"), ("mbsd.spatial.results.solution", "Solution"))
    kinds = tuple(getattr(sys.modules[module], name) for module, name in known if module in sys.modules)
    return isinstance(thing, kinds)


def natural_run(m: Mechanism, duration: float | None, steps: int | None, file: str) -> Solution:
    """Return the sweep or simulation that the model asks for. Raises UserError for a simulation without duration."""
    free = m.mobility().dof - len(m.drivers)
    if free <= 0:
        return m.sweep(duration, steps) if steps else _closer(lambda count: m.sweep(duration, count), SWEEP_STEPS)
    if duration is None:
        raise UserError(
            f"{m.name}: {free} of its degrees of freedom are not driven, so the motion is simulated, but its duration "
            f"is missing. Write DURATION = 2.0 (seconds) beside build() in {file}, or add a driver, such as "
            "m.drive_turn(...)"
        )
    if steps:
        return m.simulate(duration, steps)
    count = min(max(FEWEST, math.ceil(RATE * duration)), MOST)
    return _closer(lambda count: m.simulate(duration, count), count)


def _closer(run: Any, steps: int) -> Solution:
    """Return a run in ``steps`` equal steps, or in as many more as keep turns between rows small."""
    solution = run(steps)
    for _ in range(ROUNDS):
        far = _largest_turn(solution)
        if far <= LARGEST_TURN or steps >= MOST:
            break
        steps = min(math.ceil(steps * far / LARGEST_TURN), MOST)
        solution = run(steps)
    return solution


def _largest_turn(solution: Solution) -> float:
    """Return the largest turn of a body from one row to the next (rad), by its rates at both."""
    rates = np.stack([solution.body(name).w for name in solution.packed.body_names[1:]])
    speed = np.linalg.norm(rates, axis=2)
    return float((np.maximum(speed[:, 1:], speed[:, :-1]) * np.diff(solution.t)).max())


def give_masses_of_parts(
    m: Mechanism, solids: Mapping[str, BodyParts]
) -> tuple[dict[str, Literal["mechanism", "parts"]], list[str]]:
    """Give bodies without mass and inertia those of their solids; return where each mass is from, and sentences."""
    source: dict[str, Literal["mechanism", "parts"]] = {}
    without: list[str] = []
    for name, body in m.bodies.items():
        if name == "ground":
            continue
        source[name] = "mechanism"
        if not lacks_mass(body):
            continue
        if name not in solids:
            without.append(name)
            continue
        mass = solids[name].mass
        if mass.z is None or mass.tensor is None:
            raise UserError(
                f"{m.name}: the parts of '{name}' have no inertia in space; give their bodies made.space = True in "
                "parts.py, or the body mass= and inertia= in mechanism.py"
            )
        m.set_mass(name, mass.mass, (*mass.com, mass.z), mass.tensor)
        source[name] = "parts"
    if not without:
        return source, []
    return source, [f"bodies without mass, until there are parts: {', '.join(without)}"]


def lacks_mass(body: Any) -> bool:
    """Return True if mechanism.py gives a body in space neither mass nor inertia."""
    return body.mass == 0.0 and not np.any(body.inertia)


def summary(solution: Solution) -> list[str]:
    """Return what a run found, in words."""
    efforts = {name: solution.driver(name) for name in solution.mechanism.drivers}
    forces = [float(solution.joint(name).magnitude.max()) for name in solution.mechanism.joints]
    rounding = 1e-9 * max(forces, default=0.0)
    said = []
    for name, driver in efforts.items():
        peak, size = float(np.abs(driver.effort).max()), solution.packed.size if driver.angular else 1.0
        said.append(
            f"{name} up to {written(peak if peak > rounding * size else 0.0, 'N m' if driver.angular else 'N')}"
        )
    if solution.energy is not None and solution.work is not None and not efforts:
        total = solution.energy.total
        said.append(f"energy within {written(float(np.ptp(total)), 'J')} of {written(float(total[0]), 'J')}")
    return said
