"""Numbers of insights once more, from data.json by other formulas: what a caption says, and what it should say."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from render.insights import Insight
from render.insights.insight import Amount
from shared.contract import Motion

FINE = 20_001
Pairs = list[tuple[float, float]]
"""Numbers that are said, and the same by another formula."""


def said(each: Insight, name: str) -> float:
    """Return an amount of a sentence in SI."""
    value = each.values[name]
    assert isinstance(value, Amount)
    return value.value


def finely(motion: Motion, values: np.ndarray) -> np.ndarray:
    """Return a series at many equal steps."""
    return np.interp(np.linspace(motion.time[0], motion.time[-1], FINE), motion.time, values)


def middles(motion: Motion, name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Return x, y of a body's centre of mass and their rates."""
    body = motion.bodies[name]
    arm = (body.com[0] + 1j * body.com[1]) * np.exp(1j * np.asarray(body.theta))
    at = np.asarray(body.x) + 1j * np.asarray(body.y) + arm
    rate = np.asarray(body.vx) + 1j * np.asarray(body.vy) + 1j * np.asarray(body.omega) * arm
    return at.real, at.imag, rate.real, rate.imag


def coordinate(motion: Motion, name: str) -> tuple[np.ndarray, np.ndarray]:
    """Return the angle of a body that turns, else its way along its main direction; and the rate."""
    body = motion.bodies[name]
    if np.ptp(body.theta) > 1e-6:
        return np.asarray(body.theta), np.asarray(body.omega)
    x, y, vx, vy = middles(motion, name)
    far = int(np.hypot(x - x[0], y - y[0]).argmax())
    along = np.array([x[far] - x[0], y[far] - y[0]])
    along = along / np.hypot(*along)
    return along[0] * x + along[1] * y, along[0] * vx + along[1] * vy


def braked(motion: Motion, name: str) -> float:
    """Return the part of the time in which a driver or force takes power; what is rounding counts as none."""
    load = motion.drivers.get(name) or motion.forces[name]
    power = finely(motion, np.asarray(load.power, float))
    return float(np.mean(power < -1e-6 * np.abs(power).max()))


def carried(motion: Motion, name: str) -> float:
    """Return the largest force of a joint (N)."""
    joint = motion.joints[name]
    return float(np.hypot(joint.fx, joint.fy).max())


def shaken(motion: Motion) -> float:
    """Return the largest force of inertia of all bodies (N)."""
    total = np.zeros(len(motion.time), complex)
    for body in motion.bodies.values():
        arm = (body.com[0] + 1j * body.com[1]) * np.exp(1j * np.asarray(body.theta))
        turned = 1j * np.asarray(body.alpha) - np.asarray(body.omega) ** 2
        total += body.mass * (np.asarray(body.ax) + 1j * np.asarray(body.ay) + turned * arm)
    return float(np.abs(total).max())


def effort(motion: Motion, each: Insight) -> Pairs:
    load = motion.drivers.get(each.joints[0]) or motion.forces[each.joints[0]]
    values, power = np.asarray(load.effort, float), np.asarray(load.power, float)
    at = float(np.interp(each.start, motion.time, power)) / float(np.abs(power).max())
    assert (at < -1e-3, at > 1e-3) == ("brakes" in each.template, "drives" in each.template)
    there = float(np.interp(each.start, motion.time, values))
    return [(each.number, there), (abs(each.number), float(np.abs(values).max()))]


def weight(motion: Motion, each: Insight) -> Pairs:
    pull = math.hypot(*motion.gravity) * sum(body.mass for body in motion.bodies.values())
    return [(each.number, carried(motion, each.joints[0]) / pull)]


def bend(motion: Motion, each: Insight) -> Pairs:
    first, second = (
        np.asarray(motion.bodies[name].theta) if name in motion.bodies else np.zeros(len(motion.time))
        for name in motion.joints[each.joints[0]].bodies
    )
    return [(each.number, float(np.ptp(second - first)))]


def quick_return(motion: Motion, each: Insight) -> Pairs:
    body, crank = each.bodies
    out = float(np.mean(finely(motion, coordinate(motion, body)[1]) > 0))
    turn = abs(float(np.ptp(motion.bodies[crank].theta)))
    turn /= max(1, round(turn / math.tau))
    return [(said(each, "slow"), max(out, 1 - out) * turn), (each.number, max(out, 1 - out) / min(out, 1 - out))]


def dwell(motion: Motion, each: Insight) -> Pairs:
    rate = np.abs(finely(motion, coordinate(motion, each.bodies[0])[1]))
    return [(each.number, float(np.mean(rate < 1e-6 * rate.max())))]


def ratio(motion: Motion, each: Insight) -> Pairs:
    first, second = (float(np.ptp(coordinate(motion, name)[0])) for name in each.bodies[:2])
    if each.unit == "m":
        return [(each.number, second / first * math.tau)]
    number = abs(each.number)
    return [(number, min(second / first, first / second, key=lambda other: abs(number - other)))]


def ripple(motion: Motion, each: Insight) -> Pairs:
    values = np.asarray((motion.drivers.get(each.joints[0]) or motion.forces[each.joints[0]]).effort, float)
    return [(each.number, float(np.abs(values).max()) / abs(float(finely(motion, values).mean())))]


def level(motion: Motion, each: Insight) -> Pairs:
    assert np.ptp(motion.bodies[each.bodies[0]].theta) < 1e-6
    x, y, _, _ = middles(motion, each.bodies[0])
    return [(each.number, math.hypot(float(np.ptp(x)), float(np.ptp(y))))]


def dead_point(motion: Motion, each: Insight) -> Pairs:
    rate = coordinate(motion, each.bodies[1 if each.template.endswith("all") else -1])[1]
    return [(abs(float(np.interp(each.start, motion.time, rate))) / float(np.abs(rate).max()), 0.0)]


def centre(motion: Motion, each: Insight) -> Pairs:
    mass = sum(body.mass for body in motion.bodies.values())
    x, y = (sum(motion.bodies[n].mass * middles(motion, n)[k] for n in motion.bodies) / mass for k in (0, 1))
    return [(each.number, max(float(np.ptp(x)), float(np.ptp(y))))]


def rolls(motion: Motion, each: Insight) -> Pairs:
    _, _, vx, vy = middles(motion, each.bodies[0])
    way, turned = np.hypot(vx, vy), np.abs(motion.bodies[each.bodies[0]].omega)
    return [(each.number, float(finely(motion, way).sum() / finely(motion, turned).sum()) * math.tau)]


RECOMPUTED: dict[str, Callable[[Motion, Insight], Pairs]] = {
    "reaction": lambda motion, each: [(each.number, carried(motion, each.joints[0]))],
    "peak_cause": lambda motion, each: [(each.number, carried(motion, each.joints[0]))],
    "cable": lambda motion, each: [(each.number, carried(motion, each.joints[0]))],
    "peak_weight": weight,
    "effort_peak": effort,
    "ripple": ripple,
    "power_sign": lambda motion, each: [(each.number, braked(motion, each.joints[0]))],
    "balance": lambda motion, each: [(each.number, shaken(motion))] if each.unit == "N" else [],
    "bend": bend,
    "quick_return": quick_return,
    "dwell": dwell,
    "speed_ratio": ratio,
    "mirror": ratio,
    "level": level,
    "cosine": lambda motion, each: [(2 * each.number, float(np.ptp(coordinate(motion, each.bodies[0])[0])))],
    "dead_point": dead_point,
    "centre": centre,
    "rolls": rolls,
}
"""By the kind of insight."""
ELSEWHERE = {
    *("straight_line", "step", "transmission", "pressure_angle", "losses", "swing", "work_share", "firing", "climbs"),
    *("changing_ratio", "difference", "speed_peak", "impact", "event", "orbit", "gas", "isolation", "toggle", "scale"),
    *("ellipse", "couple", "decay", "sticking", "roughness", "change_point", "whirl", "cusp", "crossing", "speed"),
    *(
        "no_effort",
        "energy_kept",
        "stroke",
        "period",
        "even_return",
        "rhythm",
        "returns",
        "slide",
        "halves",
        "reach",
        "limit",
    ),
}
"""Kinds whose numbers test_closed_forms.py and test_recomputed.py hold to closed forms."""
