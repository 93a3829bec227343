"""Travel of everything: strokes, ranges of rockers, turns of cranks, spans of points, flights.

Bodies are held by joints until an event releases these.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np

from render.magnitudes import centre_of_mass
from render.report.written import Amounts, degrees, listed, moment, table
from shared.contract import JointMotion, Motion
from shared.contract.quantity import figures

SLIDING = ("guide", "slot")
"""Pairs of joints in which something slides."""
TURN = 2 * math.pi
LISTED = 4
"""Bodies of a group that are named, at most."""
WHOLE = 1e-6
"""Turns: what misses one by less has turned once."""


def travel_section(motion: Motion) -> list[str]:
    """Return tables of sliding, turning and traced things, and sentences on bodies free of ground."""
    amount = Amounts(motion)
    lines: list[str] = []
    strokes = [
        [f"{name} ({joint.kind.replace('_', ' ')})", f"{joint.bodies[0]}, {joint.bodies[1]}",
         amount(stroke(motion, joint), "m", 4)]
        for name, joint in motion.joints.items()
        if joint.pair in SLIDING
    ]  # fmt: skip
    if strokes:
        lines += ["### Sliders", "", *table(["joint", "bodies", "stroke"], strokes), ""]
    rows = []
    for name, body in motion.bodies.items():
        at = centre_of_mass(body)
        spans = [amount(float(np.ptp(part)), "m", 4) for part in (at.x, at.y)]
        rows.append([name, *spans, _turned(np.asarray(body.theta), amount.floors["rad"])])
    rows += [
        [f"point {name}", amount(float(np.ptp(point.x)), "m", 4), amount(float(np.ptp(point.y)), "m", 4), ""]
        for name, point in motion.points.items()
    ]
    lines += ["### Bodies and points", "", "Spans of centres of mass and of traced points.", ""]
    lines += [*table(["", "span x", "span y", "angle"], rows), ""]
    return [*lines, *_flights(motion, amount)]


def stroke(motion: Motion, joint: JointMotion) -> float:
    """Return how far the second marker of a joint goes along its line, seen from the first body (m)."""
    seen = _seen_from(motion, joint.bodies[0], np.asarray(joint.x), np.asarray(joint.y))
    if joint.shape is not None:
        angle = joint.shape.markers[0][2]
        along = np.array([math.cos(angle), math.sin(angle)])
    else:  # files of versions 1 and 2 do not say
        along = np.linalg.svd(seen - seen.mean(axis=0), full_matrices=False)[2][0]
    return float(np.ptp(seen @ along))


def _seen_from(motion: Motion, body: str, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return places in the world, (T,) each, as (T, 2) in the frame of a body."""
    if body not in motion.bodies:
        return np.column_stack([x, y])
    own = motion.bodies[body]
    c, s = np.cos(own.theta), np.sin(own.theta)
    u, v = x - np.asarray(own.x), y - np.asarray(own.y)
    return np.column_stack([c * u + s * v, c * v - s * u])


def _turned(theta: np.ndarray, floor: float) -> str:
    """Return words for the range of an angle: whole turns of a crank, from where to where a rocker swings."""
    span = float(np.ptp(theta))
    if span <= floor:
        return "0"
    if span >= TURN * (1 - WHOLE):
        turns = span / TURN
        return f"{figures(turns, 3)} {'turn' if abs(turns - 1) < WHOLE else 'turns'}"
    middle = TURN * round((float(theta.min()) + float(theta.max())) / 2 / TURN)
    low, high = (degrees(float(end) - middle) for end in (theta.min(), theta.max()))
    return f"{degrees(span)} ({low} to {high})"


def _flights(motion: Motion, amount: Amounts) -> list[str]:
    """Return a sentence for each group of bodies that no joint holds on ground, at times or for good.

    It counts from the start or from a release on.
    """
    released, known = releases(motion), set[str]()
    lines = []
    for row, event in [(0, ""), *sorted(set(released.values()))]:
        held = [joint for name, joint in motion.joints.items() if name not in released or released[name][0] > row]
        for group in _free_groups(motion, held):
            name = max(group, key=lambda body: motion.bodies[body].mass)
            at = centre_of_mass(motion.bodies[name])
            x, y = at.x[row:] - at.x[row], at.y[row:] - at.y[row]
            if group <= known or max(np.ptp(x), np.ptp(y)) <= amount.floors["m"]:
                continue
            known |= group
            others = f" with {listed(sorted(group - {name}))}" if 1 < len(group) <= LISTED else ""
            since = f"From {event} on (t = {moment(motion.time[row])}) no" if row else "No"
            along, across, up = (amount(float(part), "m", 4) for part in (x[-1], y[-1], y.max()))
            rises = f", and {up} up at most" if y.max() > max(y[-1], amount.floors["m"]) else ""
            lines += [
                f"{since} joint holds {name}{others} on ground: to the end it goes {along} along x and {across} along "
                f"y{rises}.",
                "",
            ]
    return lines


def releases(motion: Motion) -> dict[str, tuple[int, str]]:
    """Return the row from which on a joint is released, and the event that did it, by joint."""
    names = {event.time: event.name for event in motion.events if event.what == "event"}
    out = {}
    for name, joint in motion.joints.items():
        row = joint.rows_held(motion.time)
        if joint.released is not None and row < len(motion.time):
            out[name] = row, names.get(joint.released, "a release")
    return out


def _free_groups(motion: Motion, held: Iterable[JointMotion]) -> list[set[str]]:
    """Return bodies that joints tie together but not to ground, largest groups first."""
    group_of: dict[str, set[str]] = {body: {body} for body in ("ground", *motion.bodies)}
    for joint in held:
        first, second = (group_of.get(body, set()) for body in joint.bodies)
        if first is not second:
            first |= second
            group_of |= dict.fromkeys(second, first)
    groups = {id(group): group for group in group_of.values() if "ground" not in group}
    return sorted(groups.values(), key=len, reverse=True)
