"""Signs of gas in cylinders: an engine's barrel with its piston and valves, and the barrel and rod of a gas strut."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import along_axes, along_line, at_place, on_body
from mbsd.drawing.look import LOAD
from mbsd.drawing.pose import Pose
from mbsd.model.cylinders.cycle import Opening
from mbsd.model.cylinders.engine_cylinder import cylinder_of
from mbsd.model.force import Force

if TYPE_CHECKING:
    from mbsd.model.joint import Joint

VALVE, LIFT, BESIDE = 0.3, 0.16, 0.46
"""Half the width of a valve, how far an open one is lifted, and how far from the middle it is, in half bores."""
SKIRT = 0.3
"""How far the barrel reaches beyond the piston's lowest place, in half bores."""
SLENDER = 0.07
"""Half the width of a strut's barrel, in its length."""


def draw_engine_cylinder(canvas: Canvas, force: Force, pose: Pose, joints: Sequence[Joint]) -> None:
    """Barrel and head in true size, the piston's crown, and valves that stand open or closed, ports likewise."""
    origin, u = pose.place(force.i), pose.axis(force.i)
    n = np.array([-u[1], u[0]])
    half = max(0.5 * force.params["bore"], 0.5 * canvas.unit)
    here, head, low, openings = _barrel(force, pose, joints, half)
    barrel = [(low, -half), (head, -half), (head, half), (low, half)]
    with canvas.on(on_body(force.i.body.name)):
        canvas.line([origin + x * u + y * n for x, y in barrel], LOAD, 1.6, order=3)
    crown = [origin + here * u + side * 0.97 * half * n for side in (-1.0, 1.0)]
    with canvas.on(along_axes(force.i, force.j)):
        canvas.line(crown, LOAD, 2.4, order=3.2)
    sides = [-1.0, 1.0] if len(openings) > 1 else [-1.0]
    for side, opening in zip(sides, openings, strict=False):
        if opening.port is None:
            at = head + (LIFT * half if opening.open else 0.0)
            ends = [(at, (side * BESIDE + s * VALVE) * half) for s in (-1.0, 1.0)]
        else:
            at = head + opening.port
            out = half * (1.0 + (2.0 if opening.open else 1.0) * LIFT)
            ends = [(at, side * half), (at, side * out)]
        canvas.line([origin + x * u + y * n for x, y in ends], LOAD, 3.0, order=3.1)
    with canvas.on(along_line(force.i, force.j)):
        canvas.label(force.name, origin + 0.5 * (head + here) * u + half * n, 0.6, LOAD)


def engine_cylinder_reach(force: Force, pose: Pose, joints: Sequence[Joint]) -> np.ndarray:
    """(4, 2) corners of the barrel (m)."""
    origin, u = pose.place(force.i), pose.axis(force.i)
    n, half = np.array([-u[1], u[0]]), 0.5 * force.params["bore"]
    _, head, low, _ = _barrel(force, pose, joints, half)
    return np.array([origin + x * u + side * (1.0 + LIFT) * half * n for x in (head, low) for side in (-1.0, 1.0)])


def _barrel(
    force: Force, pose: Pose, joints: Sequence[Joint], half: float
) -> tuple[float, float, float, Sequence[Opening]]:
    """Places of crown, head and end along the axis (m), and what is open; the head is at the marker if not known."""
    here = float((pose.place(force.j) - pose.place(force.i)) @ pose.axis(force.i))
    ways = np.append(pose.travel.get(f"force {force.name}", np.zeros(0)), here)
    low = float(ways.max()) + SKIRT * half
    try:
        cylinder = cylinder_of(force, joints)
    except ModelError:
        return here, min(0.0, float(ways.min())), low, ()
    crank, frame = (pose.frames[name][2] for name in (force.params["crank"], force.bodies[0]))
    since = cylinder.sense * (crank - frame - cylinder.fires_at)
    head = cylinder.top - cylinder.bore.clearance
    return here, head, low, force.params["cycle"].openings(since, cylinder.bore)


def draw_strut(canvas: Canvas, force: Force, pose: Pose) -> None:
    """The barrel on the first point, and the rod with its piston on the second."""
    i, j = pose.place(force.i), pose.place(force.j)
    gap = float(np.hypot(*(j - i)))
    if gap <= 0.0:
        return
    u = (j - i) / gap
    n = np.array([-u[1], u[0]])
    p = force.params
    long = p["retracted"] if "retracted" in p else p["length"] - p["stroke"]
    half = max(p["bore"] / 2 if "bore" in p else SLENDER * long, 0.4 * canvas.unit)
    piston = gap - force.params["stroke"] - 0.05 * long
    box = [(0.06 * long, -half), (long, -half), (long, half), (0.06 * long, half), (0.06 * long, -half)]
    canvas.line([i, i + 0.06 * long * u], LOAD, 1.6, order=3)
    canvas.line([i + x * u + y * n for x, y in box], LOAD, 1.4, order=3)
    canvas.line([j, i + piston * u], LOAD, 1.8, order=3.1)
    canvas.line([i + piston * u + side * 0.9 * half * n for side in (-1.0, 1.0)], LOAD, 2.2, order=3.1)
    for marker, point in ((force.i, i), (force.j, j)):
        with canvas.on(at_place(marker)):
            canvas.circle(point, 0.26, edge=LOAD, fill=LOAD, order=5.5, width=0.5)
    with canvas.on(along_line(force.i, force.j)):
        canvas.label(force.name, (i + j) / 2, 1.3, LOAD)
