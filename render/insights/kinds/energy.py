"""Insights into energy: losses, impacts, sticking, swings that die away, orbits, springs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import Any

import numpy as np

from render.insights.insight import Insight
from render.insights.kinds.ratios import held_ratio
from render.insights.seen import TURN, Array, Output, Seen, amount, body, insight, load
from shared.contract import ContactMotion, ForceMotion

LOST = 1e-3
"""Part of the energy that moves below which nothing is lost."""
STANDS = 0.01
"""Part of its largest kinetic energy with which a motion all but stands."""
BACK = 2e-3
"""Part of its range by which a place or a speed is away from where it began, if it is back."""
SMALL = 0.02
"""Part of the largest loss below which another is not counted."""
SOFT = 1e-5
"""Part of the energy that moves below which impacts are none."""
ALWAYS = 0.98
"""Part of the time from which on a contact always sticks."""
LEAST_SWINGS = 3


def energy(seen: Seen) -> Iterator[Insight]:
    """Yield all insights of this chapter."""
    if seen.motion.analysis == "simulation":
        yield from losses(seen)
        yield from swings(seen)
        yield from slides(seen)
        yield from orbits(seen)
        yield from returns(seen)
        yield from climbs(seen)
        yield from isolation(seen)
    yield from impacts(seen)
    yield from rhythm(seen)
    for name, contact in seen.motion.contacts.items():
        yield from sticking(seen, name, contact)
    yield from turns_of_cycle(seen)


def losses(seen: Seen) -> Iterator[Insight]:
    """Yield who takes most of the energy, and that nothing does."""
    motion = seen.motion
    kinetic, potential = np.asarray(motion.energy.kinetic), np.asarray(motion.energy.potential)
    scale = max(float(kinetic.max()), float(np.ptp(potential)))
    if scale <= 0:
        return
    taken = {name: lost for name, each in motion.forces.items()
             if not each.drives and (lost := _lost(seen, each)) > LOST * scale}  # fmt: skip
    hits = -sum(event.energy for event in motion.events)
    if hits > LOST * scale:
        taken["impacts"] = hits
    if not taken:
        is_free = not motion.drivers and not any(each.drives for each in motion.forces.values())
        if is_free and float(np.ptp(kinetic + potential)) < 1e-4 * scale:
            template = "energy_kept_between" if motion.forces or motion.contacts else "energy_kept"
            yield insight(
                "energy_kept", float(np.ptp(kinetic + potential)), "J", _whole(seen), 0.45, template,
                most=amount(float(np.ptp(kinetic)), "J"),
            )  # fmt: skip
        return
    candidates = len(taken)
    taken = {name: lost for name, lost in taken.items() if lost > SMALL * max(taken.values())}
    total = sum(taken.values())
    name = max(taken, key=lambda each: taken[each])
    share = taken[name] / total
    of_all = total / scale
    values: dict[str, Any] = {
        "lost": amount(taken[name], "J"),
        "share": amount(share, "share"),
        "total": amount(total, "J"),
    }
    if name == "impacts":
        count = sum(event.what == "impact" for event in motion.events)
        yield insight("losses", hits, "J", _whole(seen), 0.4 + 0.3 * of_all, "lost_in_impacts",
                      count=amount(count, "count"), **values)  # fmt: skip
        return
    template = "lost_mostly" if len(taken) > 1 else "lost_alone" if candidates == 1 else "lost_nearly"
    yield insight(
        "losses", taken[name], "J", _whole(seen), 0.4 + 0.3 * min(of_all, 1), template, joints=(name,),
        load=load(name), **values,
    )  # fmt: skip


def _lost(seen: Seen, force: ForceMotion) -> float:
    """Return the energy (J) that a force takes from the motion and does not hold."""
    work = float(np.trapezoid(np.asarray(force.power), seen.time))
    return -(work + force.potential[-1] - force.potential[0])


def _whole(seen: Seen) -> tuple[float, float]:
    return float(seen.time[0]), float(seen.time[-1])


# Swings: their period beside that of small ones, and how fast they die away.


def swings(seen: Seen) -> Iterator[Insight]:
    """Yield the period of the clearest free swing, with its loss from one swing to the next."""
    if seen.input is not None or seen.motion.drivers or seen.motion.events:
        return
    best = None
    for output in _swinging(seen):
        tops = peaks(seen.time, output.value)
        if len(tops) >= LEAST_SWINGS - 1 and (best is None or output.travel > best[0].travel):
            best = output, tops
    if best is None:
        return
    output, tops = best
    times = np.array([at for at, _ in tops])
    gaps = np.diff(times)
    if not len(gaps) or np.ptp(gaps) > 0.1 * gaps.mean():
        return
    period = float(gaps.mean())
    small = small_period(seen, output)
    if small is not None and period > 1.02 * small:
        yield insight(
            "swing", period, "s", (times[0], times[1]), 0.95, "swing_long", bodies=(output.body,),
            body=body(output.body), period=amount(period, "s"), small=amount(small, "s"),
            ratio=amount(period / small, "times"),
        )  # fmt: skip
    else:
        yield insight(
            "swing", period, "s", (times[0], times[1]), 0.45, bodies=(output.body,), body=body(output.body),
            period=amount(period, "s"),
        )  # fmt: skip
    ends = sorted([*tops, *((at, -value) for at, value in peaks(seen.time, -output.value))])
    widths = np.abs(np.diff([value for _, value in ends]))
    if _dies(tops) and len(tops) >= LEAST_SWINGS and np.all(np.diff(widths) < 0):
        kept = float((widths[-1] / widths[0]) ** (2 / (len(widths) - 1)))
        if kept < 0.995:
            yield insight(
                "decay", kept, "", (ends[0][0], ends[-1][0]), 0.7, bodies=(output.body,), body=body(output.body),
                lost=amount(1 - kept, "share"),
            )  # fmt: skip


def slides(seen: Seen) -> Iterator[Insight]:
    """Yield bodies that swing to and fro on a guide of another moving body."""
    for name, each in seen.motion.joints.items():
        if each.pair != "guide" or "ground" in each.bodies:
            continue
        first, second = each.bodies
        x, y = np.asarray(each.x), np.asarray(each.y)
        carrier = seen.motion.bodies[first]
        angle = seen.theta[first] + (each.shape.markers[0][2] if each.shape is not None else 0.0)
        value = np.cos(angle) * (x - carrier.x) + np.sin(angle) * (y - carrier.y)
        tops = peaks(seen.time, value)
        gaps = np.diff([at for at, _ in tops])
        if len(gaps) and np.ptp(gaps) < 0.1 * gaps.mean():
            yield insight(
                "slide", gaps.mean(), "s", (tops[0][0], tops[1][0]), 0.7, bodies=(first, second), joints=(name,),
                body=body(second), other=body(first), period=amount(gaps.mean(), "s"),
                travel=amount(float(np.ptp(value)), "m"),
            )  # fmt: skip


def _swinging(seen: Seen) -> list[Output]:
    """Return outputs, and points that trace a swing, that go to and fro."""
    outputs = [each for each in seen.outputs if each.slides or each.travel < TURN]
    for name, traced in seen.motion.points.items():
        if not outputs and traced.body in seen.motion.bodies:
            x, y = np.asarray(traced.x), np.asarray(traced.y)
            along = (x, traced.vx) if np.ptp(x) > np.ptp(y) else (y, traced.vy)
            outputs.append(Output(name, True, along[0], np.asarray(along[1])))
    return [each for each in outputs if each.travel > 1e-6]


def peaks(time: Array, values: Array) -> list[tuple[float, float]]:
    """Return times and values of the maxima inside a series, from parabolas through three samples."""
    out = []
    floor = 0.02 * float(np.ptp(values))
    keep = np.concatenate([[True], np.diff(time) > 0])
    t, v = time[keep], values[keep]
    for k in np.flatnonzero((v[1:-1] > v[:-2]) & (v[1:-1] >= v[2:])) + 1:
        a, b, c = np.polyfit(t[k - 1 : k + 2] - t[k], v[k - 1 : k + 2], 2)
        out.append((float(t[k] - b / (2 * a)), float(c - b * b / (4 * a))))
    return [row for row in out if row[1] - v.min() > floor]


def _dies(tops: list[tuple[float, float]]) -> bool:
    """Return True if each maximum is below the one before."""
    return len(tops) > 1 and all(later[1] < row[1] for row, later in pairwise(tops))


def small_period(seen: Seen, output: Output) -> float | None:
    """Return the period of small swings (s) of one body on a pin under its weight; else None."""
    motion = seen.motion
    if output.slides or len(motion.bodies) != 1 or motion.forces or output.body not in motion.bodies:
        return None
    each = motion.bodies[output.body]
    pin = next(j for j in motion.joints.values() if j.pair == "pin" and "ground" in j.bodies)
    centre = seen.centres[output.body]
    arm = float(np.hypot(centre.x[0] - pin.x[0], centre.y[0] - pin.y[0]))
    gravity = float(np.hypot(*motion.gravity))
    if not arm or not gravity or not each.mass:
        return None
    return TURN * math.sqrt((each.inertia + each.mass * arm**2) / (each.mass * gravity * arm))


# Impacts and sticking.


def impacts(seen: Seen) -> Iterator[Insight]:
    """Yield the hardest impact, with the speed that comes back, and how many there are."""
    hits = [event for event in seen.motion.events if event.what == "impact" and event.impulse]
    if not hits:
        return
    hardest = max(hits, key=lambda event: abs(event.impulse))
    moved = max(max(seen.motion.energy.kinetic), float(np.ptp(seen.motion.energy.potential)))
    if (
        abs(hardest.energy) < SOFT * moved
        and all(each.energy > -SOFT * moved for each in hits)
        and not _comes_back(seen)
    ):
        return
    contact = seen.motion.contacts.get(hardest.name)
    at, unit = hardest.time, f"{contact.effort_unit if contact else 'N'} s"
    values: dict[str, Any] = {"load": load(hardest.name), "at": amount(at, "s")}
    values |= {"impulse": amount(abs(hardest.impulse), unit)}
    back = rebound(seen, contact, at) if contact is not None else None
    if contact is not None and back is not None:
        values |= {"before": amount(back[0], f"{contact.unit}/s"), "share": amount(back[1], "share")}
        template = "impact_all_back" if back[1] > 0.999 else "impact_stops" if back[1] < 1e-3 else "impact_back"
    else:
        template = "impact"
    yield insight(
        "impact", abs(hardest.impulse), unit, (at, at), 0.85, template,
        bodies=tuple(each for each in contact.bodies if each != "ground") if contact else (), joints=(hardest.name,),
        **values,
    )  # fmt: skip
    if len(hits) > 2:
        yield insight(
            "impact", len(hits), "", (hits[0].time, hits[-1].time), 0.3, "impacts",
            joints=tuple(dict.fromkeys(event.name for event in hits)), count=amount(len(hits), "count"),
            first=amount(hits[0].time, "s"), last=amount(hits[-1].time, "s"),
        )  # fmt: skip


def rhythm(seen: Seen) -> Iterator[Insight]:
    """Yield the contact that is hit evenly, most often of all."""
    times: dict[str, list[float]] = {}
    for event in seen.motion.events:
        if event.what == "impact":
            times.setdefault(event.name, []).append(event.time)
    for name, hits in sorted(times.items(), key=lambda row: -len(row[1])):
        gaps = np.diff(hits)
        if len(gaps) > 1 and np.ptp(gaps) < 0.01 * gaps.mean():
            yield insight(
                "rhythm", gaps.mean(), "s", (hits[0], hits[1]), 0.6, joints=(name,), load=load(name),
                period=amount(gaps.mean(), "s"),
            )  # fmt: skip
            return


def _comes_back(seen: Seen) -> bool:
    """Return True if some contact throws back what meets it: then impacts take no energy."""
    shares = [rebound(seen, contact, event.time) for event in seen.motion.events if event.what == "impact"
              and (contact := seen.motion.contacts.get(event.name)) is not None]  # fmt: skip
    return any(each is not None and each[1] > 0.1 for each in shares)


def rebound(seen: Seen, contact: ContactMotion, at: float) -> tuple[float, float] | None:
    """Return the speed before an impact (m/s or rad/s) and the part that comes back; None if unknown."""
    rows = np.flatnonzero(seen.time == at)
    if len(rows) < 2:
        return None
    before, after = -float(contact.rate[rows[0]]), float(contact.rate[rows[-1]])
    return (before, max(after, 0.0) / before) if before > 1e-9 else None


def sticking(seen: Seen, name: str, contact: ContactMotion) -> Iterator[Insight]:
    """Yield how long a contact sticks, or a body stays on another."""
    states = np.array(contact.state)
    for state, template in (("sticks", "sticks"), ("slides", "slides")):
        mask = states == state
        share = seen.share(mask)
        if share > 0.03:
            start, end = next(seen.stretches(mask))
            template = f"{template}_always" if share > ALWAYS else template
            yield insight(
                "sticking", share, "", (start, end), 0.4 + 0.3 * (state == "sticks" and share < ALWAYS), template,
                joints=(name,), bodies=tuple(each for each in contact.bodies if each != "ground"), load=load(name),
                share=amount(share, "share"),
            )  # fmt: skip


# Orbits, tuned springs, cycles.


def orbits(seen: Seen) -> Iterator[Insight]:
    """Yield how near and how far two bodies come that attract each other, and their speeds there."""
    for name, force in seen.motion.forces.items():
        if force.value is None or len(force.actions) != 2 or max(force.potential) >= 0:
            continue  # what attracts holds less than nothing
        distance = np.asarray(force.value)
        near, far = int(distance.argmin()), int(distance.argmax())
        ratio = float(distance[far] / distance[near])
        small = min((action.body for action in force.actions), key=lambda each: seen.motion.bodies[each].mass)
        other = next(action.body for action in force.actions if action.body != small)
        if ratio < 1.01:
            continue
        at = float(seen.time[near])
        rate = np.hypot(
            seen.centres[small].vx - seen.centres[other].vx, seen.centres[small].vy - seen.centres[other].vy
        )
        yield insight(
            "orbit", ratio, "", (at, at), 0.9, bodies=(small, other), joints=(name,), body=body(small),
            other=body(other), ratio=amount(ratio, "times"), speed=amount(rate[near] / rate[far], "times"),
        )  # fmt: skip
        gaps = np.diff([row[0] for row in peaks(seen.time, -distance)])
        if len(gaps) and np.ptp(gaps) < 0.02 * gaps.mean():
            yield insight(
                "period", gaps.mean(), "s", (at, at + float(gaps.mean())), 0.5, "orbit_period", bodies=(small, other),
                body=body(small), other=body(other), period=amount(gaps.mean(), "s"),
            )  # fmt: skip
        return


def returns(seen: Seen) -> Iterator[Insight]:
    """Yield when all bodies are where they began, and as fast, of a motion that is let go."""
    if seen.motion.drivers:
        return
    centres = seen.centres.values()
    away = np.zeros(len(seen.time))
    for part in ("x", "y", "vx", "vy"):
        rows = [getattr(centre, part) for centre in centres]
        scale = max(float(np.ptp(row)) for row in rows)
        away = np.maximum(away, np.max([np.abs(row - row[0]) for row in rows], axis=0) / (scale or 1.0))
    out = np.flatnonzero(away > 0.2)
    if not len(out):
        return
    near = np.flatnonzero((away < BACK) & (np.arange(len(away)) > out[0]))
    if len(near):
        at = float(seen.time[near[0]])
        yield insight("returns", at - float(seen.time[0]), "s", (float(seen.time[0]), at), 0.6,
                      bodies=tuple(seen.motion.bodies), period=amount(at - float(seen.time[0]), "s"))  # fmt: skip


def climbs(seen: Seen) -> Iterator[Insight]:
    """Yield how much of its height a motion under weight alone gets back when it first stands still again."""
    energy_of, events = seen.motion.energy, seen.motion.events
    if seen.motion.drivers or any(np.any(each.potential) for each in seen.motion.forces.values()):
        return
    kinetic, height = np.asarray(energy_of.kinetic), np.asarray(energy_of.potential)
    top = float(kinetic.max())
    if top <= 0 or kinetic[0] > 1e-6 * top or any(event.energy < -LOST * top for event in events):
        return
    moving = np.flatnonzero(kinetic > 0.2 * top)
    again = np.flatnonzero((kinetic < STANDS * top) & (np.arange(len(kinetic)) > moving[0]))
    if not len(again):
        return
    first = again[: int(np.argmax(np.append(np.diff(again) > 1, True))) + 1]
    k = int(first[kinetic[first].argmin()])
    low = float(height[:k].min())
    if height[0] <= low:
        return
    share = (float(height[k]) - low) / (float(height[0]) - low)
    template = "climbs_back" if share > 1 - STANDS else "climbs"
    yield insight(
        "climbs", share, "", seen.moment_of(k), 0.5 if share > 1 - STANDS else 0.9, template,
        bodies=tuple(seen.motion.bodies), share=amount(share, "share"), at=amount(seen.time[k], "s"),
    )  # fmt: skip


def isolation(seen: Seen) -> Iterator[Insight]:
    """Yield how much more gently a sprung body is shaken than what is at the other end of its spring."""
    for name, force in seen.motion.forces.items():
        if force.look != "coil" or len(force.actions) != 2:
            continue
        bodies = [action.body for action in force.actions if action.body in seen.centres]
        if len(bodies) != 2 or not any(seen.motion.gravity):
            continue
        shaken = {each: float(np.abs(seen.centres[each].ay).max()) for each in bodies}
        gentle, rough = sorted(bodies, key=lambda each: shaken[each])
        if shaken[gentle] <= 0 or shaken[rough] < 1.3 * shaken[gentle]:
            continue
        ratio = shaken[rough] / shaken[gentle]
        k = int(np.abs(seen.centres[rough].ay).argmax())
        yield insight(
            "isolation", ratio, "", seen.moment_of(k), 0.8, bodies=(gentle, rough), joints=(name,),
            body=body(gentle), other=body(rough), load=load(name), most=amount(shaken[rough], "m/s²"),
            least=amount(shaken[gentle], "m/s²"), ratio=amount(ratio, "times", 2),
        )  # fmt: skip


def turns_of_cycle(seen: Seen) -> Iterator[Insight]:
    """Yield that a mechanism begins anew only after several turns of its crank."""
    crank = seen.input
    if crank is None or not seen.repeats or crank.turns < 2 or not _differs(seen):
        return
    yield insight(
        "period", crank.turns, "", _whole(seen), 0.4, "cycle_turns", bodies=(crank.body,), crank=body(crank.body),
        turns=amount(crank.turns, "count"),
    )  # fmt: skip


def _differs(seen: Seen) -> bool:
    """Return True if some body is elsewhere after one turn of the crank, gears left out."""
    assert seen.input is not None
    if any(held_ratio(output.rate, seen.input.rate) is not None for output in seen.outputs):
        return False
    row = len(seen.time[seen.window()]) - 1
    for name in seen.motion.bodies:
        turned = seen.theta[name][row] - seen.theta[name][0]
        if abs(math.remainder(float(turned), TURN)) > 1e-3:
            return True
    return False
