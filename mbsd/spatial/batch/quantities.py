"""Quantities of a motion in space by name, for measures: components of frames, joints, drivers, forces and energy.

    top.x   P.vz   top.wx   hinge.turn   hinge.turn_rate   A.fx   motor.effort   spring.value   kinetic

Where names meet, a traced point comes before a body, a body before a joint. Quantities of frames, turns and slides are
found of many simulations at once; the others are those of single solutions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.base.names import no_such

FRAME = {
    f"{sign}{axis}": (what, k)
    for sign, what in {"": "place", "v": "velocity", "w": "w", "a": "acceleration", "alpha": "alpha"}.items()
    for k, axis in enumerate("xyz")
}
MEASURED = {
    f"{what}{end}": (what, k) for what in ("turn", "slide") for k, end in enumerate(("", "_rate", "_acceleration"))
}
WRENCH = {
    f"{sign}{axis}": (what, k) for sign, what in {"f": "force", "m": "moment"}.items() for k, axis in enumerate("xyz")
}
OTHERS = ("value", "rate", "effort", "power")
ENERGY = ("kinetic", "potential", "total")


@dataclass(frozen=True)
class Quantity:
    """One quantity by name."""

    name: str
    of_solution: Callable[[Any], np.ndarray]
    """(T,) of a solution; (T, R) of R motions behind one another, where ``many``."""
    many: bool = False


def quantity_named(m: Any, name: str) -> Quantity:
    """Return the quantity of this name. Raises ModelError for an unknown name."""
    whole, _, part = name.rpartition(".")
    if name == "t":
        return Quantity(name, lambda sol: sol.t)
    if name in ENERGY:
        return Quantity(name, lambda sol: getattr(sol.energy, name))
    if whole in m.traces and part in FRAME:
        return Quantity(name, lambda sol: _component(sol.point(whole), *FRAME[part]), True)
    if whole in m.bodies and part in FRAME:
        return Quantity(name, lambda sol: _component(sol.body(whole), *FRAME[part]), True)
    joint = m.joints.get(whole)
    if joint is not None and part in MEASURED and getattr(joint.kind, f"{MEASURED[part][0]}s"):
        what, order = MEASURED[part]
        return Quantity(name, lambda sol: sol.measured(sol.mechanism.joints[whole], what)[order], True)
    if joint is not None and part in WRENCH:
        return Quantity(name, lambda sol: _component(sol.joint(whole), *WRENCH[part]))
    if whole in m.drivers and part in OTHERS:
        return Quantity(name, lambda sol: getattr(sol.driver(whole), part))
    if whole in m.forces and part in OTHERS:
        return Quantity(name, lambda sol: getattr(sol.force(whole), part))
    parts = {**dict.fromkeys((*m.traces, *m.bodies), FRAME), **dict.fromkeys((*m.drivers, *m.forces), OTHERS)}
    known = [f"{thing}.{key}" for thing, keys in parts.items() for key in keys]
    known += [f"{joint}.{key}" for joint in m.joints for key in (*MEASURED, *WRENCH)]
    raise ModelError(f"{m.name}: measure: {no_such('quantity', name, ['t', *known, *ENERGY])}")


def _component(view: Any, what: str, axis: int) -> np.ndarray:
    return getattr(view, what)[..., axis]
