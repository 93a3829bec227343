"""Insights into balance: how much of the bodies' inertia reaches the frame, in which orders, and what cancels."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from render.insights.insight import Insight
from render.insights.seen import Array, Seen, amount, body, insight
from render.magnitudes import couple_floor, floor_of, force_floor, shaking
from shared.contract import BodyMotion

CANCELS = 1e-3
"""Part of the bodies' own inertia forces below which their sum is nothing."""
MAIN = 0.75
"""Part of all orders that the largest has at least if it is called the main one."""


def balance(seen: Seen) -> Iterator[Insight]:
    """Yield all insights of this chapter."""
    yield from frame_force(seen)
    yield from couple(seen)
    yield from centre(seen)
    yield from roughness(seen)


def frame_force(seen: Seen) -> Iterator[Insight]:
    """Yield the force of inertia on the frame beside the sizes of the bodies' own."""
    shaken = shaking(seen.motion)
    size = np.hypot(shaken.fx, shaken.fy)
    own = np.sum(
        [body.mass * np.hypot(seen.centres[name].ax, seen.centres[name].ay) for name, body in _bodies(seen)], axis=0
    )
    if not np.any(own > force_floor(seen.motion)) or seen.input is None:
        if seen.input is not None and seen.input.turns and any(each.mass for each in seen.motion.bodies.values()):
            yield insight("balance", 0.0, "N", _whole(seen), 0.45, "balanced_at_rest")
        return
    share = float(size.max() / own.max())
    k = int(size.argmax())
    if share < CANCELS:
        yield insight(
            "balance", share, "", _whole(seen), 0.9, "balanced", own=amount(own.max(), "N")
        )  # fmt: skip
        return
    orders = main_order(seen, "shaking force")
    values: dict[str, Any] = {
        "most": amount(size[k], "N"),
        "own": amount(own.max(), "N"),
        "share": amount(share, "share"),
    }
    moves = len([name for name, each in _bodies(seen) if each.mass and np.ptp(seen.centres[name].x) > 1e-9])
    if orders is None:
        return
    order, part, first = orders
    template = "shakes_often" if part > MAIN else "shakes"
    if order > 1.5 and first < 1e-3:
        template = "first_cancels"
    values |= {"order": amount(order, "count") if order == round(order) else amount(order, "", 3)}
    strength = 0.3 + 0.5 * (1 - share) * (moves > 1) + 0.3 * (template == "first_cancels")
    yield insight(
        "balance", size[k], "N", seen.at(k), strength, template, times=_times(order), **values
    )  # fmt: skip


def _bodies(seen: Seen) -> list[tuple[str, BodyMotion]]:
    return list(seen.motion.bodies.items())


def _whole(seen: Seen) -> tuple[float, float]:
    return float(seen.time[0]), float(seen.time[-1])


def _times(order: float) -> str:
    """Return how often in a turn of the crank, as a key of words."""
    return {1: "once a turn", 2: "twice a turn"}.get(int(order), "often a turn") if order == int(order) else "odd turns"


def main_order(seen: Seen, name: str) -> tuple[float, float, float] | None:
    """Return the largest order of a quantity, its part of all, and the part of the first; None where it is rounding."""
    vibration = seen.motion.vibration
    if vibration is None or name not in vibration.harmonics:
        return None
    each = vibration.harmonics[name]
    size: Array = np.array(each.forward) + np.array(each.backward)
    if size.max(initial=0.0) <= floor_of(seen.motion, name, each.unit):
        return None
    order = np.array(vibration.order)
    k, total = int(size.argmax()), float(np.sqrt(np.sum(size**2)))
    first = float(size[np.isclose(order, 1.0)].sum())
    return float(order[k]), float(size[k]) / total, first / float(size[k])


def couple(seen: Seen) -> Iterator[Insight]:
    """Yield the couple that rocks the frame, of bodies in several planes."""
    shaken = shaking(seen.motion)
    if shaken.mx is None or shaken.my is None:
        return
    size = np.hypot(shaken.mx, shaken.my)
    if size.max() <= couple_floor(seen.motion):
        yield insight("couple", 0.0, "N m", _whole(seen), 0.6, "no_couple")
        return
    k = int(size.argmax())
    orders = main_order(seen, "shaking couple")
    if orders is None:
        return
    order, _, first = orders
    template = "couple_second" if order > 1.5 and first < 1e-3 else "couple"
    yield insight(
        "couple", size[k], "N m", seen.at(k), 0.55, template, most=amount(size[k], "N m"),
        times=_times(order),
    )  # fmt: skip


def centre(seen: Seen) -> Iterator[Insight]:
    """Yield what the common centre of mass does if nothing outside pushes it one way, or at all."""
    bodies = [(name, each) for name, each in _bodies(seen) if each.mass]
    total = sum(each.mass for _, each in bodies)
    if len(bodies) < 2 or not total or seen.motion.analysis != "simulation":
        return
    x = sum(each.mass * seen.centres[name].x for name, each in bodies) / total
    y = sum(each.mass * seen.centres[name].y for name, each in bodies) / total
    own = max(float(np.ptp(seen.centres[name].x)) for name, _ in bodies)
    sides, heights = float(np.ptp(x)), float(np.ptp(y))
    if own < 1e-6 or sides > 1e-6 * own:
        return
    if heights < 1e-6 * own:
        yield insight("centre", sides, "m", _whole(seen), 0.8, "centre_rests", bodies=tuple(name for name, _ in bodies))
        return
    yield insight(
        "centre", heights, "m", _whole(seen), 0.9, "centre_upright", bodies=tuple(name for name, _ in bodies),
        high=amount(heights, "m"), wide=amount(own, "m"),
    )  # fmt: skip


def roughness(seen: Seen) -> Iterator[Insight]:
    """Yield how much the speed of a crank fluctuates in its last turn, of one that forces turn."""
    crank = seen.input
    if crank is None or crank.turns < 2 or crank.name in seen.motion.drivers:
        return
    last = crank.value >= crank.value[-1] - 2 * np.pi
    spins, time = np.abs(crank.rate[last]), seen.time[last]
    mean = float(np.trapezoid(spins, time) / np.ptp(time))
    part = float(np.ptp(spins)) / mean
    if part > 1e-3:
        yield insight(
            "roughness", part, "", (float(time[0]), float(time[-1])), 0.6, bodies=(crank.body,), body=body(crank.body),
            part=amount(part, "share"), mean=amount(mean * 30 / np.pi, "rpm"),
        )  # fmt: skip
