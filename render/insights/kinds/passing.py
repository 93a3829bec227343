"""Insights into how force is passed on: transmission and pressure angles, dead points, toggles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from render.insights.insight import Insight, Named
from render.insights.loops import LEAST, Loop, loops
from render.insights.seen import TURN, Seen, amount, body, insight
from shared.contract import JointMotion
from shared.contract.geometry import felt

STEEP = math.radians(30.0)
"""Pressure angle up to which a cam pushes a follower well."""
CHANGES = 1e-6
"""Part of their sum by which the links of a change-point mechanism may differ."""
NEAR = 0.02
"""Margin of a pose near a singular one."""


def passing(seen: Seen) -> Iterator[Insight]:
    """Yield all insights of this chapter."""
    all_loops = loops(seen.motion)
    yield from crank_limit(seen, all_loops)
    sliding = [loop for loop in all_loops if loop.slides]
    for loop in all_loops:
        yield from transmission(seen, loop)
        yield from change_point(seen, loop)
        if not loop.slides or len(sliding) == 1:
            yield from dead_points(seen, loop, len(all_loops) == 1)
    if len(sliding) > 1:
        yield from dead_centres(seen, sliding)
    for name, joint in seen.motion.joints.items():
        if joint.pair is None and joint.shape is not None and joint.shape.outline_closed:
            yield from pressure_angle(seen, name, joint)


def transmission(seen: Seen, loop: Loop) -> Iterator[Insight]:
    """Yield the least transmission angle, with the angle of the crank."""
    mu = loop.transmission
    k = int(mu.argmin())
    at = float(seen.time[k])
    if seen.input is not None and not seen.input.turns and mu[k] < NEAR:
        return  # a toggle: it says more
    least = float(mu[k])
    template = "transmission" if least < LEAST else "transmission_good"
    if loop.slides:
        template = f"leans{'' if least < LEAST else '_good'}"
    lean = math.pi / 2 - least
    where: dict[str, Any] = {} if loop.slides else {"angle": amount(float(loop.angle[k]), "place")}
    where |= {"side": amount(math.tan(lean), "share")} if loop.slides else {}
    yield insight(
        "transmission", least, "rad", (at, at), 0.3 + LEAST - least if least < LEAST else 0.35, template,
        bodies=(loop.crank, loop.coupler, loop.follower), coupler=body(loop.coupler), follower=body(loop.follower),
        least=amount(least, "deg"), lean=amount(lean, "deg"),
**where,
    )  # fmt: skip


def dead_points(seen: Seen, loop: Loop, is_alone: bool) -> Iterator[Insight]:
    """Yield where crank and coupler are in line: dead points of a crank, the toggle of a lever."""
    passed = loop.dead_points(seen.time)
    if not passed:
        return
    at, angle = passed[0]
    names: dict[str, Any] = {"coupler": body(loop.coupler), "crank": body(loop.crank), "follower": body(loop.follower)}
    bodies = (loop.crank, loop.coupler, loop.follower)
    if float(np.ptp(loop.angle)) > 1.9 * math.pi:
        if len(passed) < 2:
            return
        (at, angle), (other, second) = sorted(passed[:2], key=lambda row: row[1] % TURN)
        template = "dead_centres" if loop.slides else "dead_points"
        yield insight(
            "dead_point", angle, "rad", (min(at, other), max(at, other)), 0.4, template, bodies=bodies, **names,
            first=amount(angle, "place"), second=amount(second, "place"),
        )  # fmt: skip
        return
    if not is_alone:
        return  # other loops move the follower on
    past = _past(seen, loop, at)
    yield insight(
        "toggle", past, "rad", (at, at), 1.0, "toggle", bodies=bodies, **names, past=amount(past, "deg"),
        at=amount(at, "s"),
    )  # fmt: skip


def dead_centres(seen: Seen, sliding: list[Loop]) -> Iterator[Insight]:
    """Yield that each piston of an engine stands still twice in a turn."""
    passed = sliding[0].dead_points(seen.time)
    if len(passed) < 2 or len({loop.crank for loop in sliding}) > 1:
        return
    pistons = tuple(dict.fromkeys(loop.follower for loop in sliding))
    yield insight(
        "dead_point", passed[0][1], "rad", (passed[0][0], passed[1][0]), 0.3, "dead_centres_of_all",
        bodies=(sliding[0].crank, *pistons), follower=Named("body", pistons, each=True),
        coupler=Named("body", tuple(loop.coupler for loop in sliding), each=True), crank=body(sliding[0].crank),
    )  # fmt: skip


def _past(seen: Seen, loop: Loop, at: float) -> float:
    """Return how far the crank goes past its dead point (rad): the shorter way to an end of its swing."""
    angle = float(np.interp(at, seen.time, loop.angle))
    return float(min(loop.angle.max() - angle, angle - loop.angle.min()))


def change_point(seen: Seen, loop: Loop) -> Iterator[Insight]:
    """Yield that all links can lie in one line."""
    if loop.slides:
        return
    short, *middle, long = sorted(loop.lengths)
    if abs(short + long - sum(middle)) > CHANGES * (short + long):
        return
    k = int(np.argmin(seen.motion.diagnostics.singularity_margin))
    parallel = abs(loop.lengths[0] - loop.lengths[2]) < CHANGES and abs(loop.lengths[1] - loop.lengths[3]) < CHANGES
    yield insight(
        "change_point", short + long, "m", seen.moment_of(k), 0.7,
        "parallelogram" if parallel else "change_point", bodies=(loop.crank, loop.coupler, loop.follower),
        crank=body(loop.crank), coupler=body(loop.coupler), follower=body(loop.follower),
    )  # fmt: skip


def crank_limit(seen: Seen, all_loops: list[Loop]) -> Iterator[Insight]:
    """Yield the length up to which a crank can turn round: the least of its loops."""
    turning = [loop for loop in all_loops if float(np.ptp(loop.angle)) > 1.9 * math.pi]
    if not turning or len({loop.crank for loop in turning}) > 1:
        return
    loop = min(turning, key=lambda each: each.longest_crank[0])
    (most, end), length = loop.longest_crank, loop.lengths[0]
    if not length * (1 + CHANGES) < most < math.inf:
        return  # it drags the follower round, or passes a change point
    yield insight(
        "limit", most, "m", (float(seen.time[0]), float(seen.time[-1])), 0.4 + 0.5 * length / most,
        f"limit_crank{end}", bodies=(loop.crank, loop.coupler, loop.follower), crank=body(loop.crank),
        length=amount(length, "m"), most=amount(most, "m"), coupler=body(loop.coupler), follower=body(loop.follower),
    )  # fmt: skip


def pressure_angle(seen: Seen, name: str, joint: JointMotion) -> Iterator[Insight]:
    """Yield the largest angle between a cam's push and the way of the follower where it is pushed."""
    follower = joint.bodies[1]
    own = seen.motion.bodies.get(follower)
    if own is None:
        return
    place, force, _ = felt(joint)
    size = np.hypot(*force.T)
    omega = np.asarray(own.omega)
    vx = np.asarray(own.vx) - omega * (place[:, 1] - np.asarray(own.y))
    vy = np.asarray(own.vy) + omega * (place[:, 0] - np.asarray(own.x))
    speed = np.hypot(vx, vy)
    counts = (speed > 0.05 * speed.max()) & (size > max(1e-3 * size.max(), seen.floors["N"]))
    if not counts.any() or speed.max() <= 0:
        return
    cosine = np.abs(force[:, 0] * vx + force[:, 1] * vy) / np.maximum(size * speed, 1e-300)
    angle = np.where(counts, np.arccos(np.clip(cosine, 0, 1)), 0.0)
    k = int(angle.argmax())
    good = angle[k] < STEEP
    if angle[k] < 1e-4:
        return
    yield insight(
        "pressure_angle", angle[k], "rad", seen.moment_of(k), 0.6, f"pressure_{'good' if good else 'steep'}",
        bodies=joint.bodies, joints=(name,), cam=body(joint.bodies[0]), follower=body(follower),
        angle=amount(angle[k], "deg"), at=seen.moment(float(seen.time[k])),
    )  # fmt: skip
