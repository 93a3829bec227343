"""Walkers: many legs of Theo Jansen on one frame, each with a crank of its own, as machines of many bodies."""

from __future__ import annotations

import math

import numpy as np

from mbsd import Body, Mechanism, constant_rate
from tools.models.linkages import JANSEN, corner, seen

RATE = 2 * math.pi


def walker(legs: int = 6, unit: float = 1e-3, apart: float = 0.0, moving: bool = False) -> Mechanism:
    """Legs of seven bodies, each the mirror image of the one before, their cranks a part of a turn after each other;
    ``unit`` (m) is one of Jansen's. Their shafts are ``apart`` (m); 0 is one line for all, of which there are no parts.
    ``moving``: the frame is a body that is pulled along ground, else the legs stand on ground.
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
