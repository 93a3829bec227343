"""Insights into forces: drivers that brake, peaks and their causes, levers, muscles and gas."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from render.insights.causes import parts_of
from render.insights.insight import Insight
from render.insights.seen import TURN, Array, Seen, amount, body, insight, joint, load
from render.magnitudes import effort_floor, force_scale
from shared.contract import DriverMotion, ForceMotion

LEVEL = 0.02
"""A quantity that changes by less than this part of its largest has no peak."""
CLOSES = 0.02
"""Part by which the work of a driver and what comes back may differ, of which nothing is left."""
ALL = 0.99
"""Part of the time from which on something is called all the time."""
FINE = 20_001
"""Steps of a motion in which the sign of a power is looked at."""
GIVEN_BACK = 0.02
"""Part of a driver's work that has to come back before it is said to brake."""
MAIN, ALONE = 0.7, 0.97
"""Parts of a peak from which on one cause is its main one, and its only one; of a smaller one two are named."""
RELIEVED = 0.03
"""Part of a peak that another cause takes off if that is said."""


def loads(seen: Seen) -> Iterator[Insight]:
    """Yield all insights of this chapter."""
    yield from drivers(seen)
    yield from joint_peaks(seen)
    yield from muscles(seen)
    yield from gas(seen)
    yield from firing(seen)


def first_peak(values: Array) -> int:
    """Return where the largest value is; the first of several that are as large but for rounding."""
    return int(np.argmax(values >= values.max() - 1e-9 * abs(values.max())))


def drivers(seen: Seen) -> Iterator[Insight]:
    """Yield of each driver or motor its peak with the sign of its power there, and how long it brakes."""
    forces = {name: force for name, force in seen.motion.forces.items() if force.drives and len(force.actions) == 2}
    names: dict[str, DriverMotion | ForceMotion] = {**seen.motion.drivers, **forces}
    works = {name: float(np.trapezoid(np.abs(each.power), seen.time)) for name, each in names.items()}
    most = max(works.values(), default=0.0)
    for name, each in names.items():
        if each.effort is None or not _moves(each):
            continue
        effort, power = np.asarray(each.effort, float), np.asarray(each.power, float)
        floor = effort_floor(seen.motion, each.effort_unit == "N")
        if np.abs(effort).max() <= floor:
            if name in seen.motion.drivers and not any(np.any(f.power) for f in seen.motion.forces.values()):
                yield from _free(seen, name)
            continue
        counts = works[name] / most if most else 1.0
        for insight_ in (*_peak(seen, name, each, effort, power), *_braking(seen, name, each, effort, power)):
            yield replace(insight_, strength=insight_.strength * (0.4 + 0.6 * counts))
        if counts == 1.0:
            yield from _ripple(seen, name, each, effort)


def _moves(each: DriverMotion | ForceMotion) -> bool:
    return each.value is None or float(np.ptp(each.value)) > 1e-9


def _free(seen: Seen, name: str) -> Iterator[Insight]:
    """Yield that an evenly driven mechanism without loads needs no effort at all."""
    yield insight(
        "no_effort", 0.0, "N m", (float(seen.time[0]), float(seen.time[-1])), 0.5, joints=(name,), load=load(name)
    )


def _peak(seen: Seen, name: str, each: DriverMotion | ForceMotion, effort: Array, power: Array) -> Iterator[Insight]:
    size = np.abs(effort)
    if np.ptp(size) <= LEVEL * size.max():
        return
    k = first_peak(size)
    tiny = 1e-3 * float(np.abs(power).max())
    template = "peak_drives" if power[k] > tiny else "peak_brakes" if power[k] < -tiny else "peak_holds"
    at = float(seen.time[k])
    yield insight(
        "effort_peak", effort[k], each.effort_unit, (at, at), 0.35 + 0.25 * (template == "peak_brakes"), template,
        joints=(name,), load=load(name), amount=amount(size[k], each.effort_unit), at=seen.moment(at),
        power=amount(abs(power[k]), "W"),
    )  # fmt: skip


def _braking(seen: Seen, name: str, each: DriverMotion | ForceMotion, effort: Array, power: Array) -> Iterator[Insight]:
    """Yield how long the mechanism drives the driver, and how much of its work comes back."""
    given, back = (float(np.trapezoid(np.maximum(sign * power, 0), seen.time)) for sign in (1, -1))
    if back <= GIVEN_BACK * given or not back:
        return
    floor = 1e-6 * float(np.abs(power).max())
    brakes = power < -floor
    if not brakes.any():
        return
    start, end = next(seen.stretches(brakes))
    most = float(np.abs(effort[brakes]).max())
    share = float(np.mean(np.interp(np.linspace(seen.time[0], seen.time[-1], FINE), seen.time, power) < -floor))
    is_closed = abs(given - back) < CLOSES * given and seen.repeats
    template = "all_back" if is_closed else "is_driven" if back > given else "brakes"
    template = "is_driven_always" if template == "is_driven" and share > ALL else template
    strength = 0.55 if is_closed or template.startswith("is_driven") else 0.5 + 0.5 * back / given
    yield insight(
        "power_sign", share, "", (start, end), strength, template,
        joints=(name,), load=load(name), share=amount(share, "share"), most=amount(most, each.effort_unit),
        given=amount(given, "J"), back=amount(back, "J"), time=seen.span_words,
    )  # fmt: skip


def _ripple(seen: Seen, name: str, each: DriverMotion | ForceMotion, effort: Array) -> Iterator[Insight]:
    """Yield how far the peak of a driver is above its mean."""
    mean = float(np.trapezoid(effort, seen.time)) / seen.span
    peak = float(effort[np.abs(effort).argmax()])
    if abs(mean) < 0.02 * abs(peak) or not seen.repeats:
        return
    ratio = abs(peak / mean)
    if ratio > 1.5:
        yield insight(
            "ripple", ratio, "", (float(seen.time[0]), float(seen.time[-1])), 0.3 + 0.05 * ratio, joints=(name,),
            load=load(name), mean=amount(abs(mean), each.effort_unit), ratio=amount(ratio, "times", 2),
        )  # fmt: skip


# Peaks of joints, and what causes them.


def joint_peaks(seen: Seen) -> Iterator[Insight]:
    """Yield the largest reaction with its cause, and beside the weight of all that moves."""
    floor, best = 1e-6 * force_scale(seen.motion), None
    for name, each in seen.motion.joints.items():
        size = np.hypot(each.fx, each.fy)
        if size.max() > floor and np.ptp(size) > LEVEL * size.max() and (best is None or size.max() > best[1].max()):
            best = name, size
    if best is None:
        return
    name, size = best
    k = first_peak(size)
    at = float(seen.time[k])
    bodies = tuple(each for each in seen.motion.joints[name].bodies if each != "ground")
    values: dict[str, Any] = {"joint": joint(name), "amount": amount(size[k], "N"), "at": seen.moment(at)}
    rows = sorted(parts_of(seen, name, k).items(), key=lambda row: -row[1])
    if rows:
        cause, part = rows[0]
        template = "peak_cause" if part >= MAIN else "peak_causes"
        values |= {"cause": f"cause_{cause}", "part": amount(min(part, 1.0), "share")}
        if template == "peak_causes":
            values |= {"other": f"cause_{rows[1][0]}", "rest": amount(rows[1][1], "share")}
        else:
            against, off = rows[-1]
            template = "peak_relieved" if off < -RELIEVED else "peak_cause_alone" if part > ALONE else "peak_cause"
            values |= {"other": f"cause_{against}", "off": amount(-off / part, "share")}
        strength = 0.4 if cause == "weight" else 0.65
        yield insight(
            "peak_cause", size[k], "N", (at, at), strength, template, bodies=bodies, joints=(name,), **values
        )  # fmt: skip
    weight = sum(each.mass for each in seen.motion.bodies.values()) * float(np.hypot(*seen.motion.gravity))
    if weight > 0 and size[k] > 1.5 * weight:
        ratio = size[k] / weight
        yield insight(
            "peak_weight", ratio, "", (at, at), 0.3 + 0.1 * min(ratio, 5), bodies=bodies, joints=(name,),
            joint=joint(name), ratio=amount(ratio, "times"),
        )  # fmt: skip


# Muscles, motors and others that share the work.


def muscles(seen: Seen) -> Iterator[Insight]:
    """Yield who does most of the work where several drive."""
    works = {}
    for name, force in seen.motion.forces.items():
        if force.drives:
            works[name] = float(np.trapezoid(np.maximum(np.asarray(force.power), 0.0), seen.time))
    total = sum(works.values())
    if len(works) < 2 or total <= 0:
        return
    name = max(works, key=lambda each: works[each])
    share = works[name] / total
    power = np.asarray(seen.motion.forces[name].power)
    k = first_peak(power)
    yield insight(
        "work_share", share, "", seen.moment_of(k), 0.8, joints=(name,), load=load(name),
        share=amount(share, "share"), work=amount(works[name], "J"), total=amount(total, "J"),
        at=seen.moment(float(seen.time[k])), power=amount(power[k], "W"),
    )  # fmt: skip


# Gas in cylinders: its peak, and the turns between two strokes that push.


def gas(seen: Seen) -> Iterator[Insight]:
    """Yield the peak pressure of the first cylinder, as a force, with the angle after the top."""
    for name, force in seen.motion.forces.items():
        if force.gas is None:
            continue
        pressure = np.asarray(force.gas.pressure)
        k = first_peak(pressure)
        push = float(np.hypot(force.actions[-1].fx[k], force.actions[-1].fy[k]))
        at = float(seen.time[k])
        if force.gas.crank_angle is None or not force.gas.cycle_angle:
            return
        cycle = force.gas.cycle_angle
        angle = (force.gas.crank_angle[k] + math.pi) % cycle - math.pi
        yield insight(
            "gas", pressure[k], "Pa", (at, at), 0.5, bodies=(force.actions[-1].body,), joints=(name,), load=load(name),
            pressure=amount(pressure[k], "Pa"), push=amount(push, "N"), angle=amount(angle, "deg"),
        )  # fmt: skip
        return


def firing(seen: Seen) -> Iterator[Insight]:
    """Yield the turns of the crank between two strokes that push."""
    crank = seen.input
    cylinders = {name: gas for name, each in seen.motion.forces.items()
                 if (gas := each.gas) is not None and gas.crank_angle is not None and gas.cycle_angle}  # fmt: skip
    if crank is None or not cylinders or not crank.turns:
        return
    starts, cycle = [], 0.0
    for each in cylinders.values():
        k = first_peak(np.asarray(each.pressure))
        cycle = float(each.cycle_angle or cycle)
        starts.append(float(crank.value[k] - crank.value[0]) % cycle)
    starts.sort()
    gaps = [round(math.degrees((b - a) % cycle)) for a, b in zip(starts, [*starts[1:], starts[0] + cycle], strict=True)]
    even = max(gaps) - min(gaps) <= 1
    count = len(cylinders)
    if count == 1:
        template, strength = "fires_once", 0.6
    else:
        template, strength = ("fires_evenly", 0.6) if even else ("fires_unevenly", 0.8)
    yield insight(
        "firing", math.radians(gaps[0]), "rad", (float(seen.time[0]), float(seen.time[-1])), strength, template,
        joints=tuple(cylinders), bodies=(crank.body,), count=amount(count, "count"), crank=body(crank.body),
        gap=amount(cycle / count, "deg"), gaps=" + ".join(f"{gap}°" for gap in gaps),
        turns=amount(cycle / TURN, "count"),
    )  # fmt: skip
