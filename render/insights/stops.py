"""Moments at which a story may stop: insights at one moment, events, and every peak that an author may ask for."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from render.insights.insight import Insight
from render.insights.kinds.loads import LEVEL, first_peak
from render.insights.meeting import meets, place_of
from render.insights.ranking import insights
from render.insights.seen import Array, Seen, amount, insight, joint, load, point
from render.insights.seen import body as body_named
from render.magnitudes import force_scale
from shared.contract import BodyMotion, JointMotion, Motion

EDGE = 0.02
"""Part of a motion without a period at its start: a stop there has nothing before it, and comes after others."""


def stops(motion: Motion) -> list[Insight]:
    """Return what is worth a stop, the most telling first; then events and the peaks of joints and speeds."""
    findings = insights(motion)
    everything = [each for each in findings if each.start == each.end or each.kind == "dead_point"]
    everything += [*_events(motion), *_reactions(motion), *_speeds(motion)]
    if motion.period is not None:
        return everything
    start, span = motion.time[0], motion.time[-1] - motion.time[0]
    return sorted(everything, key=lambda each: each.start - start < EDGE * span)


def words_of(each: Insight) -> tuple[str, ...]:
    """Return the names by which an author may ask for a stop: ``rocker turns back``, ``floor: impact``, ``B``."""
    follower = each.values.get("follower")
    if each.kind == "dead_point" and follower is not None and not isinstance(follower, str):
        return tuple(f"{name} turns back" for name in getattr(follower, "names", ()))
    if "what" in each.values or each.kind == "impact":
        return (f"{each.joints[0]}: {each.values.get('what', 'impact')}",)
    return each.joints


def carried(motion: Motion, time: float) -> tuple[str, float]:
    """Return the joint that carries most at a time, and how much (N); no name where nothing is carried."""
    sizes = {name: float(np.interp(time, motion.time, np.hypot(each.fx, each.fy)))
             for name, each in motion.joints.items()}  # fmt: skip
    name = max(sizes, key=lambda each: sizes[each], default="")
    return (name, sizes[name]) if name and sizes[name] > 1e-9 * max(force_scale(motion), 1e-300) else ("", 0.0)


def _events(motion: Motion) -> Iterator[Insight]:
    """Yield events in their order, impacts by contacts with the hardest first."""
    hits: dict[str, tuple[float, float]] = {}
    for event in motion.events:
        if event.what == "impact" and abs(event.impulse) > hits.get(event.name, (-1.0, 0.0))[0]:
            hits[event.name] = abs(event.impulse), event.time
    for name, (impulse, at) in sorted(hits.items(), key=lambda row: -row[1][0]):
        unit = f"{motion.contacts[name].effort_unit if name in motion.contacts else 'N'} s"
        yield insight("impact", impulse, unit, (at, at), 0.0, joints=(name,), load=load(name), at=amount(at, "s"),
                      impulse=amount(impulse, unit))  # fmt: skip
    for event in motion.events:
        if event.what not in ("end", "impact"):
            yield insight("event", 0.0, "", (event.time, event.time), 0.0, joints=(event.name,), name=event.name,
                          what=event.what)  # fmt: skip


def _reactions(motion: Motion) -> Iterator[Insight]:
    """Yield peaks of joints, the largest first."""
    floor, rows = 1e-6 * force_scale(motion), []
    for name, each in motion.joints.items():
        size = np.hypot(each.fx, each.fy)
        if size.max() > floor and np.ptp(size) > LEVEL * size.max():
            k = first_peak(size)
            rows.append((-float(size[k]), name, float(motion.time[k])))
    for least, name, at in sorted(rows):
        yield insight("reaction", -least, "N", (at, at), 0.0, joints=(name,), joint=joint(name),
                      amount=amount(-least, "N"))  # fmt: skip


def _speeds(motion: Motion) -> Iterator[Insight]:
    """Yield the fastest of all, and every traced point at its fastest."""
    name, _ = fastest(motion) if motion.bodies else ("", 0.0)
    sizes = {each: speed for each, speed in speeds(motion).items() if each == name or each in motion.points}
    for each, size in sorted(sizes.items(), key=lambda row: row[0] != name):
        if size.max() > 1e-9 and np.ptp(size) > LEVEL * size.max():
            k = first_peak(size)
            at = float(motion.time[k])
            named = point(each) if each in motion.points else body_named(each) if each in motion.bodies else joint(each)
            yield insight("speed", size[k], "m/s", (at, at), 0.0, joints=(each,), name=named,
                          amount=amount(size[k], "m/s"))  # fmt: skip


def fastest(motion: Motion) -> tuple[str, float]:
    """Return the fastest traced point, pin or body (by its fastest place known), and its speed (m/s)."""
    most = {name: float(size.max()) for name, size in speeds(motion).items()}
    name = max(most, key=lambda each: most[each])
    return name, most[name]


def speeds(motion: Motion) -> dict[str, Array]:
    """Return the speeds (T,) m/s of bodies, of points, and of second markers of pins and guides.

    A body counts by its centre of mass, by places where others meet it, and by the rims of its wheels.
    """
    seen = Seen(motion)
    out = {name: np.hypot(centre.vx, centre.vy) for name, centre in seen.centres.items()}
    for each in motion.joints.values():
        own = [(name, motion.bodies[name]) for name in each.bodies if name in motion.bodies]
        if each.pair is None and each.acts is not None and meets(each):
            for name, body in own:
                out[name] = np.maximum(out[name], _speed_at(body, *place_of(each)))
        for name, speed in _rims(motion, each):
            out[name] = np.maximum(out[name], speed)
    out |= {name: np.hypot(each.vx, each.vy) for name, each in motion.points.items()}
    for name, each in motion.joints.items():
        own = motion.bodies.get(each.bodies[1])
        if own is not None and each.pair is not None and name not in out:
            out[name] = _speed_at(own, np.asarray(each.x), np.asarray(each.y))
    return out


def _rims(motion: Motion, joint: JointMotion) -> Iterator[tuple[str, Array]]:
    """Yield the bodies of a joint that are wheels about their markers, and the largest speeds on their rims."""
    shape = joint.shape
    for name, marker, radius in (
        ()
        if shape is None
        else zip(shape.bodies, shape.markers, (shape.radius_first, shape.radius_second), strict=True)
    ):
        if radius is not None and name in motion.bodies:
            body = motion.bodies[name]
            turned = (marker[0] + 1j * marker[1]) * np.exp(1j * np.asarray(body.theta))
            centre = _speed_at(body, turned.real + body.x, turned.imag + body.y)
            yield name, centre + radius * np.abs(body.omega)


def _speed_at(own: BodyMotion, x: Array, y: Array) -> Array:
    """Return the speed of the point of a body that is at (x, y) (m/s)."""
    omega = np.asarray(own.omega)
    return np.hypot(np.asarray(own.vx) - omega * (y - np.asarray(own.y)), np.asarray(own.vy) + omega * (x - own.x))
