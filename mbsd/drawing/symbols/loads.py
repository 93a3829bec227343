"""Signs of forces: springs, dampers, loads from outside, gas in cylinders, gas struts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.codes import AXIS, DAMPING, LINE, LINEAR, PUSH, TURN
from mbsd.base.errors import ModelError
from mbsd.drawing.canvas import Canvas
from mbsd.drawing.carriers import Carrier, End, along_axes, along_line, at_place, on_body
from mbsd.drawing.look import LOAD
from mbsd.drawing.pose import Pose
from mbsd.drawing.symbols.geometry import BESIDE
from mbsd.drawing.symbols.surfaces import draw_way, surface_way
from mbsd.drawing.symbols.wheels import draw_gear_pair
from mbsd.model.cylinders.cycle import Opening
from mbsd.model.cylinders.engine_cylinder import cylinder_of
from mbsd.model.force import Force
from mbsd.model.teeth import with_radii

if TYPE_CHECKING:
    from mbsd.model.joint import Joint


COILS = 5, 12
"""Fewest and most; between them one for each 1.4 units."""
BEARING, JOURNAL = 0.8, 0.36
"""Radii of a bearing with clearance and of the journal in it, in units: play is drawn large, whatever it is."""
WIDE, NARROW = 0.65, 0.3
"""Half the width of a coil, in units; of a short spring, in its length."""


def draw_force(canvas: Canvas, force: Force, pose: Pose, joints: Sequence[Joint] = ()) -> None:
    """Draw the sign of a force by its first element; ``joints`` are those of the mechanism."""
    i, j = pose.place(force.i), pose.place(force.j)
    if force.kind.sign == "engine cylinder":
        draw_engine_cylinder(canvas, force, pose, joints)
        return
    if force.kind.sign == "strut":
        draw_strut(canvas, force, pose)
        return
    if force.kind.sign == "double acting":
        _double_acting(canvas, force, pose)
        return
    if force.kind.sign == "clearance":
        _journal(canvas, force, pose)
        return
    if force.kind.sign == "mesh":
        draw_gear_pair(canvas, force, pose, dict.fromkeys(force.bodies, LOAD))
        return
    if not force.kind.elements(force):
        draw_special(canvas, force, pose)
        return
    element = force.kind.elements(force)[0]
    if element.kind == TURN:
        with canvas.on(at_place(force.j)):
            _turning(canvas, force, j)
    elif element.kind == PUSH:
        way = -1.0 if force.params.get("force", 0.0) < 0 else 1.0
        with canvas.on(along_axes(force.i, force.j)):
            tail = _arrow(canvas, j, way * pose.axis(force.i))
        with canvas.on(at_place(force.j)):
            canvas.label(force.name, tail, 0.4, LOAD)
    elif force.kind.sign == "attraction":
        with canvas.on(along_line(force.i, force.j)):
            canvas.line([i, j], LOAD, 1.0, order=3, dash=(1, 2))
            canvas.label(force.name, (i + j) / 2, 0.4, LOAD)
    elif element.kind == LINE or len(force.kind.elements(force)) == 1:
        end = i + float((j - i) @ pose.axis(force.i)) * pose.axis(force.i) if element.kind == AXIS else j
        damped = any(term.kind == DAMPING and term.a != 0.0 for term in element.terms)
        line = along_line(force.i, force.j)
        with canvas.on(line if _keeps_width(force, pose, end, canvas.unit) else None):
            _coil(canvas, force.name, i, end, damped)
        for point, carrier in ((i, at_place(force.i)), (end, at_place(force.j) if end is j else None)):
            with canvas.on(carrier):
                canvas.circle(point, 0.26, edge=LOAD, fill=LOAD, order=5.5, width=0.5)
        with canvas.on(line):
            canvas.label(force.name, (i + end) / 2, 1.3, LOAD)
    else:  # springs along both axes: a bushing
        with canvas.on(at_place(force.j)):
            for radius in (1.0, 0.5):
                canvas.circle(j, radius, edge=LOAD, order=3.2, width=1.2, alpha=0.3)
            canvas.label(force.name, j, 1.2, LOAD)


def force_reach(force: Force, pose: Pose, joints: Sequence[Joint] = ()) -> np.ndarray:
    """Return (k, 2) of what a force's sign needs beside its bodies; ``joints`` are those of the mechanism."""
    if force.kind.sign == "engine cylinder":
        return engine_cylinder_reach(force, pose, joints)
    if force.kind.sign == "mesh":
        sized = with_radii(force.params)
        sides = ((pose.place(force.i), sized["radius_i"]), (pose.place(force.j), sized["radius_j"]))
        return np.vstack([centre + radius * np.array([[-1.0, -1.0], [1.0, 1.0]]) for centre, radius in sides])
    place = pose.place(force.j)
    size = force.params["radius"] if force.kind.surface is not None or force.kind.journal is not None else 0.0
    disc = place + size * np.array([[-1.0, -1.0], [1.0, 1.0]])
    if force.kind.surface is None or not size:
        return disc
    return np.vstack([disc, surface_way(force, pose, BESIDE * size, whole=False)])


def draw_special(canvas: Canvas, force: Force, pose: Pose) -> None:
    """Draw a ring where the force acts, on each of its bodies; surface and disc too if it is a contact."""
    if force.kind.surface is not None:
        _surface(canvas, force, pose)
    bodies = force.params.get("bodies", ())
    places = [(Carrier("place", (End(name),)), pose.point(name, 0.0, 0.0)) for name in bodies]
    places = places or [(at_place(force.j), pose.place(force.j))]
    for carrier, place in places:
        with canvas.on(carrier):
            canvas.circle(place, 0.9, edge=LOAD, order=3.2, width=1.2, alpha=0.3)
    with canvas.on(places[0][0]):
        canvas.label(force.name, places[0][1], 1.2, LOAD)


def _journal(canvas: Canvas, force: Force, pose: Pose) -> None:
    """Draw a pin, and round it the bearing with visible play."""
    with canvas.on(at_place(force.i)):
        canvas.circle(pose.place(force.i), BEARING, edge=LOAD, order=7.8, width=1.3)
    with canvas.on(at_place(force.j)):
        canvas.circle(pose.place(force.j), JOURNAL, edge=LOAD, fill=LOAD, order=8, width=1.0)
        canvas.label(force.name, pose.place(force.j), BEARING + 0.35, LOAD)


def _surface(canvas: Canvas, force: Force, pose: Pose) -> None:
    """Draw the profile or line as far as the body comes, and the disc that touches it.

    A line of ground has strokes on its solid side.
    """
    radius, body = force.params["radius"], force.i.body.name
    path = surface_way(force, pose, max(BESIDE * radius, 3.0 * canvas.unit))
    draw_way(canvas, path, body, {body: LOAD})
    with canvas.on(at_place(force.j)):
        canvas.circle(pose.place(force.j), radius / canvas.unit, edge=LOAD, order=1.6, width=1.2, alpha=0.1)


def _keeps_width(force: Force, pose: Pose, end: np.ndarray, unit: float) -> bool:
    """True if a spring from marker to marker never becomes so short that its coils are drawn narrower."""
    gap = pose.place(force.j) - pose.place(force.i)
    along, aside = (ways.get(f"force {force.name}", np.zeros(0)) for ways in (pose.travel, pose.aside))
    shortest = float(np.hypot(along, aside).min(initial=float(np.hypot(*gap))))
    return bool(np.array_equal(end, pose.place(force.j))) and NARROW * shortest >= WIDE * unit


def _coil(canvas: Canvas, name: str, i: np.ndarray, j: np.ndarray, damped: bool) -> None:
    """Draw a spring; beside it a dashpot where there is damping."""
    length = float(np.hypot(*(j - i)))
    if length < 0.2 * canvas.unit:
        canvas.circle(j, 0.9, edge=LOAD, order=3.2, width=1.2, alpha=0.3)
        return
    along = (j - i) / length
    across = np.array([-along[1], along[0]])
    half = min(WIDE * canvas.unit, NARROW * length)
    shift = 1.1 * half * across if damped else np.zeros(2)
    first, last = i + 0.18 * length * along, j - 0.18 * length * along
    coils = canvas.coils.setdefault(name, int(np.clip(round(0.64 * length / (1.4 * canvas.unit)), *COILS)))
    steps = np.linspace(0.0, 1.0, 2 * coils + 2)
    sides = np.array([0.0, *([1.0, -1.0] * coils), 0.0])
    zigzag = first + steps[:, None] * (last - first) + half * sides[:, None] * across + shift
    canvas.line([i, first, *zigzag, last, j], LOAD, 1.3, order=3)
    if damped:
        middle = (first + last) / 2
        cup = 0.22 * float(np.hypot(*(last - first))) * along
        wall = 0.55 * half * across
        pot = np.array([middle + cup + wall, middle - cup + wall, middle - cup - wall, middle + cup - wall])
        canvas.line(pot - shift, LOAD, 1.3, order=3)
        canvas.line([first, first - shift, middle - cup - shift], LOAD, 1.3, order=3)
        canvas.line([last, last - shift, middle - shift], LOAD, 1.3, order=3)
        canvas.line([middle - shift + 0.8 * wall, middle - shift - 0.8 * wall], LOAD, 1.8, order=3)


def _turning(canvas: Canvas, force: Force, centre: np.ndarray) -> None:
    """Draw a spiral spring; an arrow around the centre where it is a torque from outside or a motor."""
    terms = [term.kind for element in force.kind.elements(force) for term in element.terms]
    spring = LINEAR in terms or "stiffness" in force.laws or "of_angle" in force.laws or "law" in force.params
    turn = np.linspace(-0.4, 5 * math.pi if spring else 1.2 * math.pi, 90)
    radius = (0.8 + 1.2 * turn / turn[-1] if spring else np.full(len(turn), 1.7)) * canvas.unit
    path = centre + radius[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    canvas.line(path, LOAD, 1.3, order=7)
    if not spring:
        canvas.head(path[-1] + (path[-1] - path[-2]), path[-1] - path[-2], LOAD)
    canvas.label(force.name, centre, 2.2, LOAD)


def _arrow(canvas: Canvas, at: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Return the arrow of a force from outside; returns its tail (m)."""
    tail = at - 4.0 * canvas.unit * along
    tip = at - 0.75 * canvas.unit * along
    canvas.line([tail, tip - 0.5 * canvas.unit * along], LOAD, 2.0, order=9.5)
    canvas.head(tip, along, LOAD)
    return tail


VALVE, LIFT, OFF_AXIS = 0.3, 0.16, 0.46
"""Half the width of a valve, how far an open one is lifted, and how far from the middle it is, in half bores."""
SKIRT = 0.3
"""Length of the barrel beyond the piston's lowest place, in half bores."""
SLENDER = 0.07
"""Half the width of a strut's barrel, in its length."""


def draw_engine_cylinder(canvas: Canvas, force: Force, pose: Pose, joints: Sequence[Joint]) -> None:
    """Draw barrel and head in true size, the piston's crown, and valves and ports, open or closed."""
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
            ends = [(at, (side * OFF_AXIS + s * VALVE) * half) for s in (-1.0, 1.0)]
        else:
            at = head + opening.port
            out = half * (1.0 + (2.0 if opening.open else 1.0) * LIFT)
            ends = [(at, side * half), (at, side * out)]
        canvas.line([origin + x * u + y * n for x, y in ends], LOAD, 3.0, order=3.1)
    with canvas.on(along_line(force.i, force.j)):
        canvas.label(force.name, origin + 0.5 * (head + here) * u + half * n, 0.6, LOAD)


def engine_cylinder_reach(force: Force, pose: Pose, joints: Sequence[Joint]) -> np.ndarray:
    """Return (4, 2) corners of the barrel (m)."""
    origin, u = pose.place(force.i), pose.axis(force.i)
    n, half = np.array([-u[1], u[0]]), 0.5 * force.params["bore"]
    _, head, low, _ = _barrel(force, pose, joints, half)
    return np.array([origin + x * u + side * (1.0 + LIFT) * half * n for x in (head, low) for side in (-1.0, 1.0)])


def _barrel(
    force: Force, pose: Pose, joints: Sequence[Joint], half: float
) -> tuple[float, float, float, Sequence[Opening]]:
    """Return crown, head and end along the axis (m), and what is open; an unknown head is at the marker."""
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


def _double_acting(canvas: Canvas, force: Force, pose: Pose) -> None:
    """Draw the barrel on the first body, and on the second the piston, as wide as the bore."""
    origin, u = pose.place(force.i), pose.axis(force.i)
    n, half, stroke = np.array([-u[1], u[0]]), 0.5 * force.params["bore"], force.params["stroke"]
    here = float((pose.place(force.j) - origin) @ u)
    beside = 0.12 * half
    box = [(-beside, -half), (stroke + beside, -half), (stroke + beside, half), (-beside, half), (-beside, -half)]
    with canvas.on(at_place(force.i)):
        canvas.line([origin + x * u + y * n for x, y in box], LOAD, 1.4, order=3)
    canvas.line([origin + here * u + side * 0.92 * half * n for side in (-1.0, 1.0)], LOAD, 2.6, order=3.1)
    with canvas.on(at_place(force.i)):
        canvas.label(force.name, origin + 0.5 * stroke * u + half * n, 0.6, LOAD)


def draw_strut(canvas: Canvas, force: Force, pose: Pose) -> None:
    """Draw the barrel on the first point, and the rod with its piston on the second."""
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
