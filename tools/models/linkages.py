"""Known linkages for tests of automatic parts: bars and plates on pins, driven by a crank."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from mbsd import STANDARD_GRAVITY, Body, Mechanism, Motion, constant_rate, harmonic

TURN = constant_rate(2 * math.pi)
JANSEN = {"a": 38.0, "b": 41.5, "c": 39.3, "d": 40.1, "e": 55.8, "f": 39.4, "g": 36.7, "h": 65.7, "i": 49.0, "j": 50.0}
JANSEN |= {"k": 61.9, "l": 7.8, "m": 15.0}
"""Theo Jansen's eleven holy numbers, with the crank and its place."""


def four_bar(
    ground: float | tuple[float, float],
    crank: float,
    coupler: float,
    rocker: float,
    start: tuple[float, float] = (45.0, 100.0),
    *,
    masses: Sequence[float | None] = (None, None, None),
    law: Motion | None = TURN,
    at: float = 0.0,
    traced: tuple[float, float] | None = None,
    gravity: Sequence[float] | None = STANDARD_GRAVITY,
) -> Mechanism:
    """Return a four-bar A-B-C-D, with A at the origin and D at ``ground`` (m).

    ``traced``: point P of the coupler (m).

    ``at`` and ``start`` are rough angles (degrees) of crank, coupler and rocker; without a ``law`` nothing drives it.
    """
    m = Mechanism("four_bar", gravity=gravity)
    lengths = {"crank": crank, "coupler": coupler, "rocker": rocker}
    a, b, c = (m.bar(name, length, mass) for (name, length), mass in zip(lengths.items(), masses, strict=True))
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.at(*(ground if isinstance(ground, tuple) else (ground, 0))), c.start)
    if law is not None:
        m.drive_angle("motor", a, law)
    if traced is not None:
        m.trace("P", b.at(*traced))
    m.start_near(crank=at, coupler=start[0], rocker=start[1])
    return m


def drag_link() -> Mechanism:
    """Crank and rocker both turn fully, each over the other's pivot."""
    return four_bar(0.04, 0.10, 0.09, 0.11, (20.0, 70.0))


def watt() -> Mechanism:
    """A six-bar: a second dyad on the rocker, which is a plate of three joints."""
    m = four_bar_with_plate()
    link, out = m.bar("link", 0.11), m.bar("out", 0.08)
    m.revolute("E", m.bodies["rocker"].at(0.07, -0.05), link.start)
    m.revolute("F", link.end, out.end)
    m.revolute("G", m.ground.at(0.25, 0), out.start)
    m.start_near(link=10, out=90)
    return m


def four_bar_with_plate() -> Mechanism:
    """The four-bar of the gallery, its rocker a body of its own frame."""
    m = Mechanism("watt")
    crank, coupler, rocker = m.bar("crank", 0.04), m.bar("coupler", 0.12), m.body("rocker")
    m.revolute("A", m.ground.at(0, 0), crank.start)
    m.revolute("B", crank.end, coupler.start)
    m.revolute("C", coupler.end, rocker.at(0.09, 0))
    m.revolute("D", m.ground.at(0.12, 0), rocker.at(0, 0))
    m.drive_angle("motor", crank, TURN)
    m.start_near(crank=0, coupler=45, rocker=100)
    return m


def jansen_leg(unit: float = 2e-3) -> Mechanism:
    """One leg of Theo Jansen's walker; ``unit`` (m) is one of his."""
    length = {name: value * unit for name, value in JANSEN.items()}
    pivot, hub = np.array([-length["a"], -length["l"]]), np.array([length["m"], 0.0])
    top = corner(pivot, hub, length["b"], length["j"], 1)
    back = corner(pivot, top, length["d"], length["e"], 1)
    knee = corner(pivot, hub, length["c"], length["k"], -1)
    heel = corner(back, knee, length["f"], length["g"], -1)
    toe = corner(heel, knee, length["h"], length["i"], -1)
    m = Mechanism("jansen")
    upper, foot = m.body("upper"), m.body("foot")
    bars = {name: m.bar(name, length[name]) for name in ("m", "j", "k", "c", "f")}
    m.revolute("O", m.ground.at(0, 0), bars["m"].start)
    m.revolute("M", bars["m"].end, bars["j"].start)
    m.revolute("T", bars["j"].end, upper.at(length["b"], 0))
    m.revolute("G", m.ground.at(*pivot.tolist()), upper.origin)
    m.revolute("N", bars["m"].end, bars["k"].start)
    m.revolute("K", bars["k"].end, bars["c"].end)
    m.revolute("H", m.ground.at(*pivot.tolist()), bars["c"].start)
    m.revolute("U", upper.at(*seen(pivot, top, back)), bars["f"].start)
    m.revolute("F", bars["f"].end, foot.origin)
    m.revolute("L", bars["c"].end, foot.at(length["g"], 0))
    m.trace("toe", foot.at(*seen(heel, knee, toe)))
    m.drive_angle("motor", bars["m"], constant_rate(-2 * math.pi))
    ends = {"m": (np.zeros(2), hub), "upper": (pivot, top), "j": (hub, top), "k": (hub, knee)}
    ends |= {"c": (pivot, knee), "f": (back, heel), "foot": (heel, knee)}
    m.start_near(**{name: math.degrees(math.atan2(*(q - p)[::-1])) for name, (p, q) in ends.items()})
    return m


def corner(p: np.ndarray, q: np.ndarray, from_p: float, from_q: float, side: int) -> np.ndarray:
    """The third corner of a triangle over p q, left of it for ``side`` 1."""
    apart = float(np.linalg.norm(q - p))
    along = (q - p) / apart
    forward = (from_p**2 - from_q**2 + apart**2) / (2 * apart)
    return p + forward * along + side * math.sqrt(from_p**2 - forward**2) * np.array([-along[1], along[0]])


def seen(origin: np.ndarray, towards: np.ndarray, point: np.ndarray) -> tuple[float, float]:
    """``point`` in the frame at ``origin`` whose x axis goes ``towards``."""
    along = (towards - origin) / np.linalg.norm(towards - origin)
    return float((point - origin) @ along), float((point - origin) @ np.array([-along[1], along[0]]))


def slider_crank(
    crank: float = 0.03,
    rod: float = 0.1,
    offset: float = 0.01,
    *,
    masses: Sequence[float | None] = (None, None, None),
    law: Motion | None = TURN,
    start: tuple[float, ...] = (0.0, 5.0, 0.0),
    gravity: Sequence[float] | None = STANDARD_GRAVITY,
) -> Mechanism:
    """Return a slider-crank O-A-B on a guide ``offset`` (m) above its shaft.

    ``start`` are rough angles (degrees).
    """
    m = Mechanism("slider_crank", gravity=gravity)
    bars = m.bar("crank", crank, masses[0]), m.bar("rod", rod, masses[1])
    slider = m.body("slider", masses[2])
    m.revolute("O", m.ground.at(0, 0), bars[0].start)
    m.revolute("A", bars[0].end, bars[1].start)
    m.revolute("B", bars[1].end, slider.origin)
    m.prismatic("guide", m.ground.at(0, offset), slider.origin)
    if law is not None:
        m.drive_angle("motor", bars[0], law)
    m.start_near(**dict(zip(("crank", "rod", "slider"), start, strict=False)))
    return m


def crank_shaper() -> Mechanism:
    """A quick return: a block on the crank slides on the lever, which moves the ram."""
    m = Mechanism("shaper")
    crank, link = m.bar("crank", 0.04), m.bar("link", 0.06)
    lever, block, ram = m.body("lever"), m.body("block"), m.body("ram")
    m.revolute("A", m.ground.at(0, 0.10), crank.start)
    m.revolute("O", m.ground.at(0, 0), lever.origin)
    m.revolute("P", crank.end, block.origin)
    m.prismatic("slide", lever.origin, block.origin)
    m.revolute("Q", lever.at(0.19, 0), link.start)
    m.revolute("R", link.end, ram.origin)
    m.prismatic("guide", m.ground.at(0, 0.185), ram.origin)
    m.drive_angle("motor", crank, TURN)
    m.start_near(crank=0, lever=68, block=68, link=175, ram=0)
    return m


def lift(crosses: int, bar: float = 0.16) -> Mechanism:
    """A scissor lift: three bodies and two for each cross."""
    m = Mechanism("lift")
    foot, platform, shoe = m.body("foot"), m.body("platform"), m.body("shoe")
    left, right = m.ground.at(0, 0), foot.origin
    for k in range(crosses):
        a, b = m.bar(f"a{k}", bar), m.bar(f"b{k}", bar)
        m.revolute(f"left{k}", left, a.start)
        m.revolute(f"right{k}", right, b.start)
        m.revolute(f"middle{k}", a.at(bar / 2, 0), b.at(bar / 2, 0))
        left, right = b.end, a.end
        m.start_near(**{a.name: 45, b.name: 135})
    m.revolute("hinge", left, platform.origin)
    m.revolute("shoe_pin", right, shoe.origin)
    m.prismatic("floor", m.ground.at(0, 0), foot.origin)
    m.prismatic("rail", platform.origin, shoe.origin)
    m.drive_coordinate("cylinder", m.ground.at(0, 0), foot.origin, harmonic(0.035, math.pi / 2, math.pi / 2, 0.11))
    m.start_near(platform=0, shoe=0, foot=0)
    return m


def hands(count: int = 3, apart: float = 0.03) -> Mechanism:
    """Bars that turn about pivots side by side, each over all the other pivots."""
    m = Mechanism("hands")
    for k in range(count):
        hand = m.bar(f"hand{k}", 0.1)
        m.revolute(f"O{k}", m.ground.at(apart * k, 0), hand.start)
        m.drive_angle(f"motor{k}", hand, constant_rate(2 * math.pi, k))
    return m


# Walkers: many legs of Theo Jansen on one frame, each with a crank of its own, as machines of many bodies.


RATE = 2 * math.pi


def walker(legs: int = 6, unit: float = 1e-3, apart: float = 0.0, moving: bool = False) -> Mechanism:
    """Return legs of seven bodies, each the mirror image of the one before.

    Their cranks are a part of a turn after each other; the plates between them are one frame.
    """
    m = Mechanism("walker")
    frame = m.ground
    if moving:
        frame = m.body("frame")
        m.prismatic("way", m.ground.at(0, 0), frame.origin)
        m.drive_coordinate("pull", m.ground.at(0, 0), frame.origin, constant_rate(0.1 * unit / 1e-3))
        m.start_near(frame=0)
    for k in range(legs):
        _leg(m, frame, k, k * apart, 1 if k % 2 else -1, RATE * k / legs, unit)
    return m


def _leg(m: Mechanism, frame: Body, number: int, shaft: float, side: int, phase: float, unit: float) -> None:
    """One leg with its crank; ``side`` -1 is Jansen's own, 1 its mirror image."""
    n = {name: value * unit for name, value in JANSEN.items()}
    axis = np.array([shaft, 0.0])
    pivot = axis + np.array([side * n["a"], -n["l"]])
    hub = axis + n["m"] * np.array([math.cos(phase), math.sin(phase)])
    top = corner(pivot, hub, n["b"], n["j"], -side)
    back = corner(pivot, top, n["d"], n["e"], -side)
    knee = corner(pivot, hub, n["c"], n["k"], side)
    heel = corner(back, knee, n["f"], n["g"], side)
    toe = corner(heel, knee, n["h"], n["i"], side)
    crank, j, k, c, f = (m.bar(f"{name}{number}", n[name]) for name in "mjkcf")
    upper, foot = m.body(f"upper{number}"), m.body(f"foot{number}")
    m.revolute(f"O{number}", frame.at(*axis.tolist()), crank.start)
    m.revolute(f"M{number}", crank.end, j.start)
    m.revolute(f"T{number}", j.end, upper.at(n["b"], 0))
    m.revolute(f"G{number}", frame.at(*pivot.tolist()), upper.origin)
    m.revolute(f"N{number}", crank.end, k.start)
    m.revolute(f"K{number}", k.end, c.end)
    m.revolute(f"H{number}", frame.at(*pivot.tolist()), c.start)
    m.revolute(f"U{number}", upper.at(*seen(pivot, top, back)), f.start)
    m.revolute(f"V{number}", f.end, foot.origin)
    m.revolute(f"W{number}", c.end, foot.at(n["g"], 0))
    m.trace(f"toe{number}", foot.at(*seen(heel, knee, toe)))
    m.drive_angle(f"motor{number}", crank, constant_rate(RATE, phase))
    ends = {crank: (axis, hub), upper: (pivot, top), j: (hub, top), k: (hub, knee)}
    ends |= {c: (pivot, knee), f: (back, heel), foot: (heel, knee)}
    m.start_near(**{body.name: math.degrees(math.atan2(*(q - p)[::-1])) for body, (p, q) in ends.items()})


def bank(pistons: int = 4, throw: float = 0.04, rod: float = 0.14) -> Mechanism:
    """Return pistons of one crank whose bores share an axis: in one plane none has room beside another."""
    m = Mechanism("bank")
    crank = m.body("crank")
    m.revolute("shaft", m.ground.at(0, 0), crank.origin)
    for k in range(pistons):
        turn = math.pi * (k in (1, 2))
        link, piston = m.bar(f"rod{k + 1}", rod), m.body(f"piston{k + 1}")
        m.revolute(f"throw{k + 1}", crank.at(throw * math.cos(turn), throw * math.sin(turn)), link.start)
        m.revolute(f"wrist{k + 1}", link.end, piston.origin)
        m.prismatic(f"bore{k + 1}", m.ground.at(0, 0, math.pi / 2), piston.origin)
        m.start_near(**{link.name: 90})
    m.drive_angle("motor", crank, constant_rate(RATE))
    m.start_near(crank=0)
    return m
