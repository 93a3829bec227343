"""Insights into how far, how fast and when things move: dwells, quick returns, strokes, steps of outputs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from render.insights.insight import Insight
from render.insights.seen import TURN, Array, Output, Seen, amount, body, insight, joint
from shared.contract import Motion

REST, NEARLY = 1e-6, 0.02
"""Parts of its highest speed below which a thing rests, and nearly rests."""
LEAST_REST, STAYS = 0.06, 0.01
"""Part of the time that a rest takes at least, and of its travel that what nearly rests moves at most."""
ALIKE = 1.005
"""Ways whose times have a smaller ratio take equally long."""
ROCKER = 0.95
"""Strength of a rocker's return beside that of a slider, which is what a machine is made for."""
COSINE = 1e-6
"""Part of a stroke by which a motion may miss a cosine."""
TOLD = 1.03
"""Ratio of the two ways from which on one is worth a word."""


def travel(seen: Seen) -> Iterator[Insight]:
    """Yield all insights of this chapter."""
    for output in seen.outputs:
        yield from dwell(seen, output)
        yield from quick_return(seen, output)
        yield from stroke(seen, output)
        yield from halves(seen, output)
    yield from whirl(seen)
    yield from bends(seen)
    yield from level(seen)
    yield from partners(seen)
    yield from rolls(seen)


def dwell(seen: Seen, output: Output) -> Iterator[Insight]:
    """Yield the rests of an output while the input moves: locked, exact or nearly."""
    moved_by = seen.input
    if moved_by is None or not moved_by.is_even:
        return
    size = np.abs(output.rate)
    exact = rests(seen, size, REST)
    is_exact = sum(end - start for start, end in exact) > LEAST_REST * seen.span
    resting = exact if is_exact else rests(seen, size, NEARLY)
    stretches = [(a, b) for a, b in resting if b - a > LEAST_REST * seen.span / moved_by.turns]
    if not stretches:
        return
    start, end = stretches[0]
    if not is_exact and _moved(seen, output, start, end) > STAYS * output.travel:
        return
    share = sum(b - a for a, b in stretches) / seen.span
    angle = _turned(seen, start, end)
    locking = next((name for name, each in seen.motion.joints.items()
                    if output.body in each.bodies and each.shape is not None and each.shape.slots), "")  # fmt: skip
    times = round(len(stretches) / moved_by.turns)
    template = "dwell_locked" if locking else "dwell_times" if times > 1 else "dwell" if is_exact else "dwell_nearly"
    yield insight(
        "dwell", share, "", (start, end), 0.5 + share if is_exact else 0.25 + share, template,
        bodies=(output.body, moved_by.body), joints=(locking,) if locking else (), body=body(output.body),
        share=amount(share, "share"), crank=body(moved_by.body), angle=amount(angle, "deg"),
        times=amount(times, "times"),
    )  # fmt: skip


def rests(seen: Seen, size: Array, part: float) -> list[tuple[float, float]]:
    """Return start and end (s) of the times in which a rate (T,) is below a part of its largest, longest first.

    Between the samples of rest and of motion the beginning is found from the samples beyond.
    """
    mask, time = size <= part * size.max(), seen.time
    rows = []
    for start, end in seen.stretches(mask):
        first, last = (int(np.searchsorted(time, at)) for at in (start, end - seen.span if end > time[-1] else end))
        begins, ends = _edge(time, size, first, -1), _edge(time, size, last, 1)
        rows.append((start - begins, end + ends))
    return rows


def _edge(time: Array, size: Array, row: int, way: int) -> float:
    """Return the time (s) from a row at rest to where a rate begins, one way; 0 at the ends of the motion.

    The rate is taken to begin as a line or a parabola, whichever of them the next three samples are nearer to.
    """
    rows = row + way * np.arange(1, 4)
    if rows.min() < 0 or rows.max() >= len(time) or np.any(np.diff(size[rows]) <= 0):
        return 0.0
    steps = np.abs(time[rows] - time[row])
    lines = [size[rows] ** (1 / power) for power in (1, 2)]
    w = min(lines, key=lambda line: abs(float(line[2] - 2 * line[1] + line[0])) / float(line[2]))
    return min(max(float(steps[0] - w[0] * (steps[1] - steps[0]) / (w[1] - w[0])), 0.0), float(steps[0]))


def _moved(seen: Seen, output: Output, start: float, end: float) -> float:
    """Return how far an output moves between two times, also over the seam of a period."""
    inside = (seen.time >= start) & (seen.time <= end) | (seen.time + seen.span <= end)
    values = output.value[inside]
    return float(np.ptp(values)) if output.slides else float(np.ptp(np.mod(values - values[0] + math.pi, TURN)))


def _turned(seen: Seen, start: float, end: float) -> float:
    """Return how far the crank turns between two times (rad), also over the seam of a period."""
    assert seen.input is not None
    value, time = seen.input.value, seen.time
    whole = value[-1] - value[0]
    over = end > time[-1]
    last = float(np.interp(end - seen.span if over else end, time, value)) + whole * over
    return last - float(np.interp(start, time, value))


def quick_return(seen: Seen, output: Output) -> Iterator[Insight]:
    """Yield how much longer one way of an output takes than the other, while its crank turns evenly once."""
    crank = seen.input
    if crank is None or not crank.is_even or not seen.repeats:
        return
    rows = seen.window()
    turn = float(seen.time[rows][-1] - seen.time[rows][0])
    resting = sum(end - start for start, end in rests(seen, np.abs(output.rate), REST))
    if resting > LEAST_REST * seen.span or not _comes_back(output.value[rows], output.travel):
        return
    reversals = [(at, sign) for at, sign in seen.crossings(output.rate) if at < seen.time[0] + turn * (1 - 1e-9)]
    if len(reversals) != 2:
        return
    (first, sign), (second, _) = reversals
    one, other = (second - first, turn - (second - first))
    if sign < 0:
        one, other = other, one  # one: on the way to larger values
    slow, fast = max(one, other), min(one, other)
    ratio = slow / fast
    starts = first if (second - first) == slow else second
    angles = [TURN * part / turn for part in (slow, fast)]
    if ratio < TOLD:
        if ratio < ALIKE and output.slides:
            yield insight(
                "even_return", ratio, "", (first, second), 0.2, bodies=(output.body, crank.body),
                body=body(output.body), crank=body(crank.body),
            )  # fmt: skip
        return
    template = "quick_return_slider" if output.slides else "quick_return"
    strength = min(0.4 + 1.5 * (1 - 1 / ratio), 1.0) * (1.0 if output.slides else ROCKER)
    yield insight(
        "quick_return", ratio, "", (starts, starts + slow), strength, template,
        bodies=(output.body, crank.body), body=body(output.body), crank=body(crank.body),
        slow=amount(angles[0], "deg"), fast=amount(angles[1], "deg"), ratio=amount(ratio, "times"),
    )  # fmt: skip


def halves(seen: Seen, output: Output) -> Iterator[Insight]:
    """Yield that a slider moves exactly as a cosine of its crank, or how long it is in the outer half of its stroke."""
    crank = seen.input
    if crank is None or not crank.is_even or not seen.repeats or not output.slides:
        return
    when = (float(seen.time[0]), float(seen.time[-1]))
    angle = crank.value
    wave = np.stack([np.cos(angle), np.sin(angle), np.ones(len(angle))], axis=1)
    fit, *_ = np.linalg.lstsq(wave, output.value, rcond=None)
    names: dict[str, Any] = {"body": body(output.body), "crank": body(crank.body)}
    if np.abs(wave @ fit - output.value).max() < COSINE * output.travel:
        amplitude = float(np.hypot(fit[0], fit[1]))
        yield insight(
            "cosine", amplitude, "m", when, 0.9, bodies=(output.body, crank.body), amplitude=amount(amplitude, "m"),
            **names,
        )  # fmt: skip
        return
    axis = next((each for each in seen.motion.joints.values() if each.pair == "pin"
                 and set(each.bodies) == {"ground", crank.body}), None)  # fmt: skip
    if axis is None:
        return
    middle = (float(output.value.max()) + float(output.value.min())) / 2
    centre = seen.centres[output.body]
    distance = np.hypot(centre.x - axis.x[0], centre.y - axis.y[0])
    sign = 1.0 if np.corrcoef(distance, output.value)[0, 1] > 0 else -1.0
    ends = [at for at, _ in seen.crossings(output.value - middle)]
    if len(ends) != 2 * crank.turns:
        return
    first = float(np.interp((ends[0] + ends[1]) / 2, seen.time, output.value))
    inside = (ends[1] - ends[0]) * crank.turns / seen.span
    share = inside if sign * (first - middle) > 0 else 1 - inside
    if abs(share - 0.5) > 0.01:
        yield insight(
            "halves", share, "", (ends[0], ends[1]), 0.4 + 2 * abs(share - 0.5), bodies=(output.body, crank.body),
            share=amount(share, "share"), **names,
        )  # fmt: skip


def _comes_back(values: Array, travel: float) -> bool:
    return abs(float(values[-1] - values[0])) < 1e-6 * travel


def stroke(seen: Seen, output: Output) -> Iterator[Insight]:
    """Yield the stroke of a slider beside its crank's radius, and the angle through which a rocker swings."""
    when = (float(seen.time[0]), float(seen.time[-1]))
    if not output.slides:
        if output.travel < 0.98 * TURN and seen.input is not None:
            yield insight(
                "stroke", output.travel, "rad", when, 0.35, "swings_through", bodies=(output.body,),
                body=body(output.body), travel=amount(output.travel, "deg"),
            )  # fmt: skip
        return
    crank = seen.input.body if seen.input and seen.input.turns else ""
    radius = crank_radius(seen.motion, crank)
    ratio = output.travel / radius if radius else 0.0
    if abs(ratio - 2) < 2e-3:
        yield insight(
            "stroke", output.travel, "m", when, 0.35, "stroke_twice", bodies=(output.body, crank),
            body=body(output.body), travel=amount(output.travel, "m"), crank=body(crank),
        )  # fmt: skip
    elif ratio > 2:
        yield insight(
            "stroke", output.travel, "m", when, 0.4 + 0.2 * (ratio - 2), "stroke_times",
            bodies=(output.body, crank), body=body(output.body), travel=amount(output.travel, "m"),
            crank=body(crank), ratio=amount(ratio, "times"),
        )  # fmt: skip
    else:
        yield insight(
            "stroke", output.travel, "m", when, 0.35, bodies=(output.body,), body=body(output.body),
            travel=amount(output.travel, "m"),
        )  # fmt: skip


def crank_radius(motion: Motion, crank: str) -> float:
    """Return the distance of a crank's other pin from its axis (m); 0 of a crank with none, or several."""
    axis, others = None, []
    for each in motion.joints.values():
        if crank in each.bodies and each.pair in ("pin", "slot"):
            if "ground" in each.bodies:
                axis = each
            else:
                others.append(each)
    if axis is None or not others:
        return 0.0
    radii = {round(float(np.hypot(each.x[0] - axis.x[0], each.y[0] - axis.y[0])), 9) for each in others}
    return radii.pop() if len(radii) == 1 else 0.0


def whirl(seen: Seen) -> Iterator[Insight]:
    """Yield bodies on pins that are flung right round, of a mechanism that is let go."""
    if seen.input is not None or seen.motion.drivers:
        return
    on_pins = {each for joint in seen.motion.joints.values() if joint.pair == "pin" for each in joint.bodies}
    for name in seen.motion.bodies:
        turns = float(np.ptp(seen.theta[name])) / TURN
        if turns >= 1 and name in on_pins:
            ends = sorted(float(seen.time[k]) for k in (seen.theta[name].argmin(), seen.theta[name].argmax()))
            yield insight(
                "whirl", turns, "", (ends[0], ends[1]), 0.4 + 0.1 * turns, bodies=(name,), body=body(name),
                turns=amount(turns, "", 2),
            )  # fmt: skip


def bends(seen: Seen) -> Iterator[Insight]:
    """Yield how far pins between two moving bodies open and close."""
    for name, each in seen.motion.joints.items():
        if each.pair != "pin" or "ground" in each.bodies:
            continue
        first, second = each.bodies
        turned = seen.theta[second] - seen.theta[first]
        travel = float(np.ptp(turned))
        if 0.35 < travel < TURN * 0.98:
            ends = (float(seen.time[turned.argmin()]), float(seen.time[turned.argmax()]))
            yield insight(
                "bend", travel, "rad", (min(ends), max(ends)), 0.15 + travel / 10, bodies=each.bodies, joints=(name,),
                joint=joint(name), travel=amount(travel, "deg"),
            )  # fmt: skip


def level(seen: Seen) -> Iterator[Insight]:
    """Yield bodies that are carried about without turning, though nothing on ground keeps them from it."""
    for name in seen.level:
        centre = seen.centres[name]
        travel = float(np.hypot(np.ptp(centre.x), np.ptp(centre.y)))
        if travel > 0.01 * seen.size:
            upright = abs(math.remainder(float(seen.theta[name][0]), math.pi / 2)) < 1e-3
            template = "level" if upright and any(seen.motion.gravity) else "keeps_direction"
            yield insight(
                "level", travel, "m", (float(seen.time[0]), float(seen.time[-1])), 0.75, template, bodies=(name,),
                body=body(name), travel=amount(travel, "m"),
            )  # fmt: skip


def partners(seen: Seen) -> Iterator[Insight]:
    """Yield outputs that move alike, or against each other."""
    outputs = seen.outputs
    for kind in (True, False):
        yield from _partners(seen, [output for output in outputs if output.slides == kind])


def _partners(seen: Seen, outputs: list[Output]) -> Iterator[Insight]:
    """Yield groups of outputs whose velocities are one but for the sign."""
    groups: list[dict[str, int]] = []
    for output in outputs:
        own = _velocity(seen, output)
        for group in groups:
            first = _velocity(seen, next(each for each in outputs if each.body == next(iter(group))))
            size = float(np.abs(first).max())
            sign = next((s for s in (1, -1) if np.abs(own - s * first).max() < 1e-6 * size), 0)
            if sign:
                group[output.body] = sign
                break
        else:
            groups.append({output.body: 1})
    when = (float(seen.time[0]), float(seen.time[-1]))
    for group in groups:
        alike = tuple(name for name, sign in group.items() if sign > 0)
        against = tuple(name for name, sign in group.items() if sign < 0)
        if against:
            template = "mirror_groups" if len(group) > 2 else "mirror"
            yield insight(
                "mirror", -1.0, "", when, 0.7, template, bodies=(*alike, *against), bodies_one=body(*alike),
                bodies_other=body(*against),
            )  # fmt: skip
        elif len(alike) > 1:
            yield insight("mirror", 1.0, "", when, 0.55, "together", bodies=alike, bodies_one=body(*alike))


def _velocity(seen: Seen, output: Output) -> Array:
    """Return the velocity of a slider (2 T,), or the rate of a rocker (T,)."""
    centre = seen.centres[output.body]
    return np.concatenate([centre.vx, centre.vy]) if output.slides else output.rate


def rolls(seen: Seen) -> Iterator[Insight]:
    """Yield bodies that no joint pins on ground and whose way is their turning times a radius."""
    for name, centre in seen.centres.items():
        speed, spin = np.hypot(centre.vx, centre.vy), np.abs(seen.omega[name])
        if name in seen.pinned or spin.max() < 1e-6 or speed.max() < 1e-9 or not _is_round(seen, name):
            continue
        radius = float(speed.max() / spin.max())
        rolling = np.abs(speed - radius * spin) < 1e-4 * speed.max()
        if seen.share(rolling) > 0.98 and np.ptp(seen.theta[name]) > 1.0:
            turns = float(np.abs(np.diff(seen.theta[name])).sum()) / TURN
            yield insight(
                "rolls", TURN * radius, "m", (float(seen.time[0]), float(seen.time[-1])), 0.5, bodies=(name,),
                body=body(name), way=amount(TURN * radius, "m"), turns=amount(turns, "", 3),
            )  # fmt: skip


def _is_round(seen: Seen, name: str) -> bool:
    """Return True if a contact or joint says that the body has a radius and meets ground."""
    groups = (seen.motion.contacts, seen.motion.joints)
    shapes = [each.shape for group in groups for each in group.values()
              if set(each.bodies) == {"ground", name} and not (each.shape and each.shape.teeth)]  # fmt: skip
    return any(shape is not None and (shape.radius_second or shape.radius_first) for shape in shapes)
