"""Solids of the shaft: journals, webs, counterweights, and wheels built up on it (mm)."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import combinations

import cadquery as cq
import numpy as np

from mechanisms.stages.automatic.body_shapes import first_made
from mechanisms.stages.automatic.shafts.bodies import Link, LinkEye, Machine, Shaft
from mechanisms.stages.automatic.shafts.shaft_plan import THIN, Pin, ShaftPlan, Web
from shared.contract.materials import MATERIALS
from shared.shapes import outline
from shared.shapes.build import eased, extruded, turned
from shared.shapes.outline import Circle
from shared.shapes.solid import Solid
from shared.shapes.units import cubic_metres, mm

# A shaft as one solid: journals, webs with counterweights, crank pins, a snout and a flange (mm).

INTO = 0.3
"""How far pins and journals reach into a web, in its thickness."""


def shaft_solid(plan: ShaftPlan, webs: Sequence[cq.Workplane], flywheel: float = 0.0) -> cq.Workplane:
    """Return the shaft in its body's frame with these webs.

    ``flywheel`` is the radius of a disc at its lower end, 0 for none.
    """
    if not plan.pins:
        return _plain(plan)
    shape = webs[0]
    for web in webs[1:]:
        shape = shape.union(web)
    into = INTO * min(web.high - web.low for web in plan.webs)
    for pin in plan.pins:
        shape = shape.union(_rod(plan.pin, pin.low - into, pin.high + into, (pin.x, pin.y)))
    for journal in plan.journals[1:-1]:
        shape = shape.union(_rod(plan.journal, journal.low - into, journal.high + into))
    shape = shape.union(_upper_end(plan, into)).union(_lower_end(plan, into, flywheel))
    for pin in plan.pins if plan.hole else ():
        webs_of = plan.webs_of(pin)
        low, high = min(web.low for web in webs_of), max(web.high for web in webs_of)
        shape = shape.cut(_rod(plan.hole, low - 1, high + 1, (pin.x, pin.y)))
    x, y = plan.shaft.axis
    return shape.translate((x, y, 0))


def _plain(plan: ShaftPlan) -> cq.Workplane:
    """Return a rod through all that sits on it."""
    low, high, r, c = plan.bottom(0.0), plan.top, plan.journal, 0.03 * plan.unit
    x, y = plan.shaft.axis
    shape = turned([(0, low), (r - c, low), (r, low + c), (r, high - c), (r - c, high), (0, high)])
    return shape.translate((x, y, 0))


def _rod(radius: float, low: float, high: float, at: tuple[float, float] = (0.0, 0.0)) -> cq.Workplane:
    return extruded(outline.circle(*at, radius), high - low, low)


def _upper_end(plan: ShaftPlan, into: float) -> cq.Workplane:
    """Return the last journal, and a thinner snout beyond it."""
    low, high, top = plan.journals[-1].low - into, plan.journals[-1].high, plan.top
    r, thin, c = plan.journal, THIN * plan.journal, 0.03 * plan.unit
    return turned(
        [(0, low), (r, low), (r, high - c), (r - c, high), (thin, high), (thin, top - c), (thin - c, top), (0, top)]
    )


def _lower_end(plan: ShaftPlan, into: float, flywheel: float) -> cq.Workplane:
    """Return the first journal, and a flange below it, or a flywheel."""
    high, low, end = plan.journals[0].high + into, plan.journals[0].low, plan.bottom(flywheel)
    r, wide, c = plan.journal, flywheel or 1.4 * plan.journal, 0.03 * plan.unit
    if not plan.has_flange and not flywheel:
        thin = THIN * r
        return turned(
            [(0, high), (r, high), (r, low + c), (r - c, low), (thin, low), (thin, end + c), (thin - c, end), (0, end)]
        )
    profile = [(0, high), (r, high), (r, low)]
    if flywheel:
        hub, rim = 1.4 * r, flywheel - 0.22 * (flywheel - 1.4 * r)
        dish = 0.25 * (low - end)
        profile += [(hub, low), (hub, low - dish), (rim, low - dish), (rim, low)]
    profile += [(wide - c, low), (wide, low - c), (wide, end + c), (wide - c, end), (0, end)]
    return turned(profile)


# A web of a shaft, from its axis to its crank pins, and the counterweight on it (mm).

EDGE = 0.018
"""Radius of what is rounded, in bores."""


@dataclass(frozen=True)
class Weight:
    """A counterweight: a sector about the axis, its flanks from the web's neck."""

    towards: float
    """Direction of its middle (rad)."""
    radius: float
    half: float
    """Half of its angle (rad)."""


def web_solid(plan: ShaftPlan, web: Web, weight: Weight | None = None) -> cq.Workplane:
    """Return a web about its shaft's axis."""
    height, edge = web.high - web.low, EDGE * plan.unit
    circles = [(0.0, 0.0, plan.neck), *((x, y, plan.cheek) for x, y in web.pins)]
    shape = _hulls(circles, height, web.low)
    if weight is not None:
        shape = shape.union(_counterweight(plan.neck, weight, height, web.low))
    return first_made([*(partial(eased, shape.clean(), size, "|Z", True) for size in (edge, edge / 2)), lambda: shape])


def _hulls(circles: Sequence[Circle], height: float, z: float) -> cq.Workplane:
    """Return an outline round all circles: the hulls of all pairs, which for a web is all that it needs."""
    wires = [_hull(a, b) for a, b in combinations(circles, 2)]
    shape = extruded(wires[0], height, z)
    for wire in wires[1:]:
        shape = shape.union(extruded(wire, height, z))
    return shape


def _hull(a: Circle, b: Circle) -> cq.Wire:
    """Return an outline round two circles; the larger alone if it holds the other."""
    if math.dist(a[:2], b[:2]) <= abs(a[2] - b[2]) + 1e-6:
        return outline.circle(*max(a, b, key=lambda circle: circle[2]))
    return outline.hull([a, b])


def _counterweight(neck: float, weight: Weight, height: float, z: float) -> cq.Workplane:
    def place(radius: float, turn: float) -> tuple[float, float]:
        return radius * math.cos(weight.towards + turn), radius * math.sin(weight.towards + turn)

    far, half = weight.radius, weight.half
    flat = cq.Workplane(origin=(0, 0, z)).moveTo(*place(neck, -math.pi / 2)).lineTo(*place(far, -half))
    return (
        flat.threePointArc(place(far, 0.0), place(far, half)).lineTo(*place(neck, math.pi / 2)).close().extrude(height)
    )


# Masses on the crank pins of a shaft, which its counterweights balance.
#
# A rod of mass m, its centre of mass at the part s of its length from the crank pin, is replaced by masses at its ends:
#
#     m (1 - s) turns with the pin,    m s + m_p slides with the piston
#
# Half of what slides, put on the pin, turns with the shaft like the first order of its force that does; the other half
# turns against the shaft, and no counterweight takes it. Source: Norton, Design of Machinery, ch. 13 and 14.

SLIDES = 0.5
"""The part of what slides that counterweights balance."""


@dataclass(frozen=True)
class Load:
    """A mass (kg) that turns with a shaft, at a place from its axis (mm)."""

    mass: float
    x: float
    y: float
    z: float


def loads(machine: Machine, shaft: Shaft, made: Mapping[str, Sequence[Solid]]) -> list[Load]:
    """Return one for each link on the shaft.

    Masses are those that the model gives, else those of the solids in ``made``.
    """
    on_pins = []
    for throw in shaft.throws:
        link = machine.links.get(throw.link)
        if link is not None:
            on = next(eye for eye in link.eyes if eye.joint == throw.joint)
            mass = _on_pin(machine, link, on, made)
            on_pins.append(Load(mass, throw.x - shaft.axis[0], throw.y - shaft.axis[1], throw.z))
    return on_pins


def _on_pin(machine: Machine, link: Link, on: LinkEye, made: Mapping[str, Sequence[Solid]]) -> float:
    """Return the mass on a pin (kg): of a link, the piston that it drives, and rods that it carries."""
    mass, com = _mass(machine, link.body, made)
    others = [eye for eye in link.eyes if eye is not on and math.hypot(eye.x - on.x, eye.y - on.y) > 0]
    far = next((eye for eye in others if eye.on in machine.pistons), None) or max(
        others, key=lambda eye: math.hypot(eye.x - on.x, eye.y - on.y), default=None
    )
    if far is None:
        return mass
    u, v = far.x - on.x, far.y - on.y
    part = min(1.0, max(0.0, ((com[0] - on.x) * u + (com[1] - on.y) * v) / (u * u + v * v)))
    share = mass * (1 - part)
    if far.on in machine.pistons:
        share += SLIDES * (mass * part + _mass(machine, far.on, made)[0])
    for eye in others:
        rod = machine.links.get(eye.on)
        if rod is not None and any(end.on in machine.pistons for end in rod.eyes):
            share += _on_pin(machine, rod, next(end for end in rod.eyes if end.joint == eye.joint), made)
    return share


def _mass(machine: Machine, body: str, made: Mapping[str, Sequence[Solid]]) -> tuple[float, tuple[float, float]]:
    """Return the mass (kg) and centre of mass (mm) of a body."""
    given = machine.m.bodies[body]
    if given.mass_given:
        return given.mass, (mm(given.com[0]), mm(given.com[1]))
    total, x, y = 0.0, 0.0, 0.0
    for solid in made.get(body, ()):
        shape = solid.shape.val()
        mass, centre = MATERIALS[solid.material].density * cubic_metres(shape.Volume()), shape.Center()
        total, x, y = total + mass, x + mass * centre.x, y + mass * centre.y
    return total, ((x / total, y / total) if total else (0.0, 0.0))


# Webs with counterweights as large as what their shaft carries asks for (mm).
#
# Each load is shared by the two counterweights it is between by the law of the lever, so that force and couple vanish:
#
#     S_a = -sum m (z_b - z) / (z_b - z_a) (x, y),    S_b = -sum m (z - z_a) / (z_b - z_a) (x, y)
#
# Source: Norton, Design of Machinery, ch. 12, balancing in two planes. A counterweight is a sector of the radius R and
# the angle 2 a with flanks to the neck of the radius n; its area has beyond the neck the first moment
#
#     2/3 R^3 sin a + 1/3 n R^2 cos^2 a - 2/3 n^3

SECTOR, WIDEST = math.radians(62), math.radians(90)
"""Half of a counterweight's angle, and at most where the radius does not suffice."""
LEAST = 1.1
"""The least radius of a counterweight, in the neck's."""
STEPS, ENOUGH = 4, 2e-4
"""How often a counterweight is made again for what its rounded edges change, and the part that may be left."""


def balanced_webs(plan: ShaftPlan, loads: Sequence[Load], density: float) -> list[cq.Workplane]:
    """Return the webs of a shaft of that density (kg/m^3), with counterweights where they have room."""
    webs = [web_solid(plan, web) for web in plan.webs]
    if not plan.has_weights:
        return webs
    moments = [_moment(web, density) for web in webs]
    middles = [(web.low + web.high) / 2 for web in plan.webs]
    turning = [(load.z, load.mass * np.array([load.x, load.y])) for load in loads]
    for pin in plan.pins:
        place = density * math.pi * np.array([pin.x, pin.y])
        area = plan.pin**2 - plan.hole**2
        turning.append(((pin.low + pin.high) / 2, cubic_metres(area * (pin.high - pin.low)) * place))
        for web in plan.webs_of(pin):
            k = plan.webs.index(web)
            moments[k] = moments[k] - cubic_metres(plan.hole**2 * (web.high - web.low)) * place
    turning += [(z, own) for z, own, web in zip(middles, moments, plan.webs, strict=True) if not web.weight]
    heavy = [k for k, web in enumerate(plan.webs) if web.weight]
    for a, b in zip(heavy[::2], heavy[1::2], strict=True):
        between = [(z, moment) for z, moment in turning if middles[a] < z < middles[b]]
        for own, other in ((a, b), (b, a)):
            shares = [(z - middles[other]) / (middles[own] - middles[other]) * moment for z, moment in between]
            wanted = -(moments[own] + sum(shares, np.zeros(2)))
            webs[own] = _balanced(plan, plan.webs[own], webs[own], wanted, density)
    return webs


def _balanced(plan: ShaftPlan, web: Web, bare: cq.Workplane, wanted: np.ndarray, density: float) -> cq.Workplane:
    """Return a web whose counterweight has the wanted moment (2,) (kg mm), or the largest one."""
    asked, without, made = wanted, _moment(bare, density), bare
    for _ in range(STEPS):
        weight = _weight(plan, asked / (density * cubic_metres(web.high - web.low)))
        if weight is None:
            return bare
        made = web_solid(plan, web, weight)
        left = wanted - (_moment(made, density) - without)
        if weight.half >= WIDEST or np.linalg.norm(left) < ENOUGH * np.linalg.norm(wanted):
            break
        asked = asked + left
    return made


def _weight(plan: ShaftPlan, wanted: np.ndarray) -> Weight | None:
    """Return the counterweight of a first moment of area (2,) (mm^3), as far as there is room."""
    size, far, neck = float(np.linalg.norm(wanted)), plan.counterweight, plan.neck

    def area(radius: float, half: float) -> float:
        flanks = neck * radius**2 * math.cos(half) ** 2 / 3
        return 2 / 3 * radius**3 * math.sin(half) + flanks - 2 / 3 * neck**3

    if size <= max(0.0, area(LEAST * neck, SECTOR)):
        return None
    towards = math.atan2(wanted[1], wanted[0])
    if size <= area(far, SECTOR):
        return Weight(towards, _solved(lambda radius: area(radius, SECTOR) - size, LEAST * neck, far), SECTOR)
    if size < area(far, WIDEST):
        return Weight(towards, far, _solved(lambda half: area(far, half) - size, SECTOR, WIDEST))
    return Weight(towards, far, WIDEST)


def _solved(rest: Callable[[float], float], low: float, high: float) -> float:
    """Return where a rising function is zero, by bisection."""
    for _ in range(48):
        middle = (low + high) / 2
        low, high = (middle, high) if rest(middle) < 0 else (low, middle)
    return (low + high) / 2


def _moment(shape: cq.Workplane, density: float) -> np.ndarray:
    """Return (2,): mass times place of the centre of mass from the axis (kg mm)."""
    solid = shape.val()
    centre = solid.Center()
    return density * cubic_metres(solid.Volume()) * np.array([centre.x, centre.y])


# A shaft in pieces, for rods whose big ends are of one piece: its pins are pressed into the webs above (mm).

SEAT = 0.02
BEYOND = 0.01
"""How far a pin reaches into what it is made one with."""


def built_up(shape: cq.Workplane, plan: ShaftPlan, pins: Sequence[Pin]) -> list[cq.Workplane]:
    """Return pieces of a shaft from its lower end up, one more than ``pins``.

    Each of these belongs to the piece below.
    """
    pieces = [shape]
    far = 4 * (plan.swept + plan.top - plan.ends[0])
    for pin in pins:
        x, y = plan.shaft.axis[0] + pin.x, plan.shaft.axis[1] + pin.y
        whole, top = pieces.pop(), next(web.high for web in plan.webs if web.low == pin.high)
        below = cq.Workplane().box(far, far, far, centered=(True, True, False)).translate((0, 0, pin.high - far))
        pressed = extruded(outline.circle(x, y, plan.pin), top - pin.high + BEYOND, pin.high - BEYOND)
        hole = extruded(outline.circle(x, y, plan.hole), top - pin.high + 2, pin.high - 1) if plan.hole else None
        lower = whole.intersect(below).union(pressed)
        upper = whole.cut(below).cut(extruded(outline.circle(x, y, plan.pin + SEAT), top - pin.high + 2, pin.high - 1))
        pieces += [lower if hole is None else lower.cut(hole), upper]
    return pieces
