"""The curves of the strip under a story: one to three quantities over the motion, as numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.story.reason import Reason
from render.magnitudes import NOISE, effort_floor, force_scale, without_noise
from shared.contract import Motion
from shared.contract.signals import SIGNALS

Array = NDArray[np.float64]
MOST = 3
FLAT = 1e-6
"""Curves that change by less than this part of their largest are not worth a strip."""


@dataclass(frozen=True)
class Curve:
    """One curve."""

    name: str
    unit: str
    colour: str
    """``#rrggbb`` on dark paper."""
    time: Array
    """(T,) s"""
    values: Array
    """(T,) in its unit."""


def curve_of(motion: Motion, name: str) -> Curve | None:
    """The curve of a joint (its reaction), a driver or force (its effort) or a point (its speed); None of no such."""
    time = np.asarray(motion.time)
    if name in motion.joints:
        joint = motion.joints[name]
        size = np.hypot(joint.fx, joint.fy)
        return Curve(name, "N", SIGNALS["reactions"].dark, time, without_noise(size, NOISE * force_scale(motion)))
    if name in motion.contacts:
        contact = motion.contacts[name]
        values = np.asarray(contact.normal, float)
        return Curve(name, contact.effort_unit, SIGNALS["reactions"].dark, time, values)
    load = motion.drivers.get(name) or motion.forces.get(name)
    if load is not None and load.effort is not None:
        colour = SIGNALS["forces" if load.effort_unit == "N" else "torques"].dark
        floor = effort_floor(motion, load.effort_unit == "N")
        return Curve(name, load.effort_unit, colour, time, without_noise(np.asarray(load.effort, float), floor))
    if name in motion.points:
        point = motion.points[name]
        return Curve(name, "m/s", SIGNALS["velocities"].dark, time, np.hypot(point.vx, point.vy))
    if name in motion.bodies:
        body = motion.bodies[name]
        slides = np.ptp(body.theta) < 1e-9
        values = np.hypot(body.vx, body.vy) if slides else np.asarray(body.omega, float)
        return Curve(name, "m/s" if slides else "rad/s", SIGNALS["velocities"].dark, time, values)
    return None


def curves_of(motion: Motion, wished: Sequence[str] | None, reasons: Sequence[Reason]) -> list[Curve]:
    """Those of ``wished`` names; without a wish what the first reason is about, what drives, and what is fastest."""
    if wished is not None:
        return [curve for name in wished if (curve := curve_of(motion, name)) is not None]
    first = [reasons[0].name, reasons[0].joint] if reasons else []
    fast = [reason.name for reason in reasons if reason.kind == "speed"]
    names = dict.fromkeys([*first, *motion.drivers, *fast, *motion.points, *motion.bodies])
    curves = [curve for name in names if name and (curve := curve_of(motion, name)) is not None]
    lively = [curve for curve in curves if _is_lively(curve)]
    by_unit: dict[str, Curve] = {}
    for curve in lively:  # a curve of each unit says more than three of one
        by_unit.setdefault(curve.unit, curve)
    return list(by_unit.values())[:MOST]


def _is_lively(curve: Curve) -> bool:
    top = float(np.abs(curve.values).max(initial=0.0))
    return bool(np.isfinite(curve.values).all()) and float(np.ptp(curve.values)) > FLAT * top > 0.0
