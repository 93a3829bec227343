"""What makes the frame vibrate, as data.json has it: only of motions that repeat with a crank."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from shared import contract

if TYPE_CHECKING:
    from mbsd import Solution

HIGHEST = 8
"""The highest order."""
WHOLE = 1e-6
"""Turns: what misses a whole number by less is one."""


def vibration(solution: Solution) -> contract.Vibration | None:
    """None where nothing has mass, or the motion does not repeat after whole turns of something on ground."""
    m = solution.mechanism
    if solution.period is None or not any(body.mass > 0 for body in m.bodies.values()):
        return None
    crank = _crank(solution)
    if crank is None:
        return None
    turned = abs(float(np.ptp(solution.body(crank).theta[[0, -1]]))) / math.tau
    turns = round(turned)
    if abs(turned - turns) > WHOLE:
        return None
    axis = _axis(solution, crank)
    about = solution.shaking(axis, z=solution.planes.middle if solution.planes else 0.0)
    quantities: dict[str, tuple[str, np.ndarray]] = {
        "shaking force": ("N", about.force),
        "shaking moment": ("N m", about.moment),
    }
    if solution.planes is not None and not solution.planes.is_one:
        quantities["shaking couple"] = ("N m", about.couple)
    for name, driver in m.drivers.items():
        quantities[name] = ("N m" if driver.kind.angular else "N", solution.driver(name).effort)
    for name, joint in m.joints.items():
        if "ground" in joint.bodies and name not in quantities:
            quantities[name] = ("N", solution.joint(name).reaction)
    harmonics = {name: _harmonics(solution, crank, turns, *quantity) for name, quantity in quantities.items()}
    centre = solution.centre_of_mass()
    return contract.Vibration(
        about=axis,
        fx=about.fx.tolist(),
        fy=about.fy.tolist(),
        moment=about.moment.tolist(),
        x=centre.x.tolist(),
        y=centre.y.tolist(),
        crank=crank,
        turns=turns,
        order=[k / turns for k in range(1, HIGHEST * turns + 1)],
        harmonics={name: orders for name, orders in harmonics.items() if orders is not None},
    )


def _crank(solution: Solution) -> str | None:
    """By whose angle orders count; None where nothing on a pin of ground turns one way by a whole turn."""
    from mbsd import ModelError

    try:
        return solution.orders(solution.t).crank
    except ModelError:
        return None


def _axis(solution: Solution, crank: str) -> tuple[float, float]:
    for joint in solution.mechanism.joints.values():
        if joint.kind.pair == "pin" and set(joint.bodies) == {"ground", crank}:
            end = joint.i if joint.i.body.name == "ground" else joint.j
            return end.x, end.y
    return 0.0, 0.0


def _harmonics(solution: Solution, crank: str, turns: int, unit: str, values: np.ndarray) -> contract.Harmonics | None:
    """None of what has too few rows for the orders."""
    orders = solution.orders(values, crank, turns)
    count = HIGHEST * turns
    if len(orders.order) < count:
        return None
    amplitude, phase = (series[:count].reshape(count, -1).T for series in (orders.amplitude, orders.phase))
    return contract.Harmonics(
        unit=unit,
        mean=np.atleast_1d(orders.mean).tolist(),
        amplitude=amplitude.tolist(),
        phase=phase.tolist(),
        forward=np.abs(orders.forward[:count]).tolist(),
        backward=np.abs(orders.backward[:count]).tolist(),
    )
