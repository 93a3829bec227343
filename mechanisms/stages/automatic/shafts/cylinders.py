"""The sizes of cylinders from the stroke, the rod and the neighbours along the shaft (mm).

Along the middle of a bore, s is counted from abreast of the shaft. All proportions are parts of the bore.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from mechanisms.stages.automatic.layout.planar import Rounded, around, box, disc, least_gap
from mechanisms.stages.automatic.shafts import bodies
from shared.stage.errors import UserError
from shared.stage.paths import shown_file

SQUARE = 0.95
"""Bore over stroke, where there is room and no gas says otherwise."""
WALL = 0.065
"""Thickness of a liner's wall."""
CROWN, SKIRT, LEAST_SKIRT = 0.5, 0.36, 0.16
"""Heights of a piston, above and below its wrist pin."""
SQUISH = 0.07
"""From the piston to the head at the top dead centre."""
CRANK_PIN, BIG_END, SMALL_END, WRIST_PIN = 0.26, 0.39, 0.22, 0.125
"""Radii."""
SHANK = 0.13
"""Half of a rod's width."""
HEAD = 0.16
"""Height of a head."""
ROOM = 0.05
"""Between what turns and what stands or slides."""
ROD = 0.24
"""Thickness of a connecting rod."""
LATEST = 0.15
"""How far above the lowest place of the wrist pin a liner may begin."""
EVERY = 3
"""Step between the poses at which rods and liners are looked at."""
SMALLEST = 0.4
"""Bores are tried down to this part of the wished one."""
STEP = 0.96


@dataclass(frozen=True, eq=False)
class Cylinder:
    """One piston with its liner."""

    piston: bodies.Piston
    shaft: bodies.Shaft | None
    bore: float
    origin: tuple[float, float]
    """Where s is 0, on ground."""
    lowest: float
    """s of the wrist pin at the bottom dead centre."""
    highest: float
    """s of the wrist pin at the top dead centre."""
    low: float
    """s of the liner's lower end."""
    skirt: float
    """Length of the piston below its wrist pin."""
    against: tuple[str, float] | None = None
    """A piston in the same cylinder from its other end, and s halfway between both crowns."""

    @property
    def crown(self) -> float:
        """Height of the piston above its wrist pin."""
        return CROWN * self.bore

    @property
    def top(self) -> float:
        """s of the liner's upper end."""
        if self.against is not None:
            return self.against[1]
        return self.highest + self.crown + SQUISH * self.bore

    @property
    def outer(self) -> float:
        """Outer radius of the liner."""
        return (0.5 + WALL) * self.bore

    @property
    def running(self) -> float:
        """Gap of the piston in its liner."""
        return max(0.12, 0.0025 * self.bore)

    @property
    def counterweight(self) -> float:
        """The largest radius about the shaft that stays clear of piston and liner."""
        return min(self.low, self.lowest - self.skirt) - ROOM * self.bore


def cylinders(machine: bodies.Machine) -> dict[str, Cylinder]:
    """Return cylinders by piston.

    Raises UserError naming cylinders that have no room beside each other, or none for their rod.
    """
    wished = {name: _wish(machine, piston) for name, piston in machine.pistons.items()}
    _refuse_near(machine, wished)
    fitted = {}
    for name, piston in machine.pistons.items():
        own = wished[name]
        fixed = piston.area is not None
        if fixed and piston.link in machine.links:
            bodies.refuse_near(machine, machine.links[piston.link], own)
        bore = own
        while bore >= (own if fixed else SMALLEST * own):
            made = _fitted(machine, piston, bore, wished)
            if isinstance(made, Cylinder):
                fitted[name] = made
                break
            bore *= STEP
        else:
            wider = ", the angle between banks wider" if _neighbour_limit(machine, piston, own) else ""
            raise UserError(
                f"{machine.m.name}: a bore of {own:.4g} mm has no room for piston '{name}' in '{piston.joint}': "
                f"{_fitted(machine, piston, bore / STEP, wished)}; make the rod longer, the throw shorter{wider}, "
                f"or shape it by hand in {shown_file(machine.m.name, 'parts')}"
            )
    return {name: _beside_its_mate(machine, own, fitted) for name, own in fitted.items()}


def _beside_its_mate(machine: bodies.Machine, own: Cylinder, every: Mapping[str, Cylinder]) -> Cylinder:
    """Return the cylinder, shared with a piston that works against its own.

    Raises UserError if their crowns would meet.
    """
    for name, other in every.items():
        way = np.array(other.origin) - np.array(own.origin)
        along = np.array(own.piston.along)
        aside = abs(float(along[0] * way[1] - along[1] * way[0]))
        faces = float(along @ other.piston.along) < -1 + 1e-9 and float(way @ along) > own.highest
        if other is own or not faces or aside > bodies.SAME or abs(other.piston.z - own.piston.z) > bodies.SAME:
            continue
        low, high = own.highest + own.crown, float(way @ along) - other.highest - other.crown
        middle = (low + high) / 2
        gap = float(_between(machine, own, other, along).min()) - own.crown - other.crown
        if gap < own.running:
            raise UserError(
                f"{machine.m.name}: the crowns of '{own.piston.body}' and '{name}' in one cylinder come as near as "
                f"{gap:.4g} mm; pistons reach {CROWN:g} bores beyond their wrist pins, so move the shafts apart"
            )
        return replace(own, against=(name, middle))
    return own


def _between(machine: bodies.Machine, own: Cylinder, other: Cylinder, along: np.ndarray) -> np.ndarray:
    """Return (T,): distance of the wrist pins of two pistons along their cylinder."""
    ends = [machine.path(cylinder.piston.body, *cylinder.piston.wrist) @ along for cylinder in (own, other)]
    return ends[1] - ends[0]


def _stroke(machine: bodies.Machine, piston: bodies.Piston) -> tuple[float, float, np.ndarray]:
    """Return the least and largest s of the wrist pin, and where s is 0."""
    shaft = _shaft(machine, piston)
    along, line = np.array(piston.along), np.array(piston.line)
    foot = line if shaft is None else line + ((np.array(shaft.at) - line) @ along) * along
    s = (machine.path(piston.body, *piston.wrist) - foot) @ along
    return float(s.min()), float(s.max()), foot


def _shaft(machine: bodies.Machine, piston: bodies.Piston) -> bodies.Shaft | None:
    link = machine.links.get(piston.link or "")
    driven = bodies.throw_of(machine, link) if link else None
    return driven[0] if driven else None


def _wish(machine: bodies.Machine, piston: bodies.Piston) -> float:
    """Return the bore of the gas, else one equal to the stroke as far as neighbours allow."""
    if piston.area is not None:
        return math.sqrt(4 * piston.area / math.pi)
    low, high, _ = _stroke(machine, piston)
    room = [apart / (1 + 2 * WALL + ROOM) for apart in _neighbours(machine, piston).values()]
    return min([SQUARE * (high - low), *room])


def _neighbours(machine: bodies.Machine, piston: bodies.Piston) -> dict[str, float]:
    """Return pistons on the same line in the plane, or beside it, with their distances along z."""
    distances = {}
    for name, other in machine.pistons.items():
        cross = piston.along[0] * other.along[1] - piston.along[1] * other.along[0]
        if (
            other is piston
            or abs(cross) > 1e-6
            or piston.along[0] * other.along[0] + piston.along[1] * other.along[1] < 0
        ):
            continue
        distances[name] = abs(other.z - piston.z)
    return {name: z for name, z in distances.items() if z > 1e-6}


def _refuse_near(machine: bodies.Machine, bores: Mapping[str, float]) -> None:
    for name, piston in machine.pistons.items():
        for other, apart in _neighbours(machine, piston).items():
            least = (0.5 + WALL + ROOM / 4) * (bores[name] + bores[other])
            if name < other and apart < least - 1e-9 and (piston.area or machine.pistons[other].area):
                raise UserError(
                    f"{machine.m.name}: the cylinders of '{name}' and '{other}' are {apart:.4g} mm apart along z, and "
                    f"bores of {bores[name]:.4g} and {bores[other]:.4g} mm with their walls need {least:.4g} mm; move "
                    "them apart, or make the bores smaller"
                )


def _fitted(machine: bodies.Machine, piston: bodies.Piston, bore: float, bores: Mapping[str, float]) -> Cylinder | str:
    """Return the cylinder with this bore, or why it does not fit."""
    lowest, highest, foot = _stroke(machine, piston)
    shaft = _shaft(machine, piston)
    room = ROOM * bore
    low, skirt = lowest - SKIRT * bore, SKIRT * bore
    if shaft is not None:
        link = machine.links[piston.link or ""]
        _, throw = bodies.throw_of(machine, link) or (shaft, shaft.throws[0])
        swept = shaft.radius(throw) + max(BIG_END * bore, bodies.ring_reach(machine, link, bore)) + room
        skirt = min(skirt, max(LEAST_SKIRT * bore, lowest - swept))
        if lowest - skirt - room < CRANK_PIN * bore * 1.25:
            return f"its skirt would come down to {lowest - skirt:.4g} mm from the axis of the shaft"
        low, most = max(swept, lowest - skirt, _neighbour_limit(machine, piston, bore)), lowest + LATEST * bore
        while low <= most and not _has_room(machine, piston, foot, low, bore):
            low += room / 2
        if low > most:
            return (
                f"rods and liners beside it leave its liner no room below {low:.4g} mm from the shaft, and the wrist "
                f"pin comes down to {lowest:.4g} mm"
            )
    return Cylinder(piston, shaft, bore, (float(foot[0]), float(foot[1])), lowest, highest, low, skirt)


def rod_shapes(machine: bodies.Machine, link: bodies.Link, bore: float) -> list[Rounded]:
    """Return the shapes of a connecting rod in the plane: its shank, and its big end."""
    if bodies.is_carrier(machine, link):
        return [*shank_shapes(machine, link, bore), flange_shape(machine, link, bore)]
    if bodies.carrier(machine, link) is not None:
        return shank_shapes(machine, link, bore)
    places = [(eye.x, eye.y) for eye in link.eyes]
    big = [disc(eye.x, eye.y, BIG_END * bore) for eye in link.eyes if eye.on in machine.shafts]
    return [around(places, (SHANK + 2 * ROOM) * bore), *big]


def shank_shapes(machine: bodies.Machine, link: bodies.Link, bore: float) -> list[Rounded]:
    """Return shapes of a carrier or a rod on one: shank, small end, and knuckle eye or crank hub."""
    main = bodies.rod_foot(machine, link)
    ends = [eye for eye in link.eyes if eye.on in machine.pistons or eye is main]
    shank = around([(eye.x, eye.y) for eye in ends], (SHANK + ROOM / 2) * bore)
    radius = bodies.HUB if bodies.is_carrier(machine, link) else bodies.KNUCKLE_EYE
    discs = [disc(eye.x, eye.y, (radius if eye is main else SMALL_END) * bore) for eye in ends]
    return [shank, *discs]


def flange_shape(machine: bodies.Machine, link: bodies.Link, bore: float) -> Rounded:
    """Return the outline of a carrier's flanges, round its knuckle pins and its big end."""
    main = bodies.rod_foot(machine, link)
    pins = [eye for eye in link.eyes if eye.on in machine.links]
    turns = [k * math.pi / 6 for k in range(12)] if main is not None else []
    wide = (BIG_END - bodies.KNUCKLE_EYE) * bore
    own = [(main.x + wide * math.cos(a), main.y + wide * math.sin(a)) for a in turns] if main is not None else []
    return around([*((eye.x, eye.y) for eye in pins), *own], bodies.KNUCKLE_EYE * bore)


def _has_room(machine: bodies.Machine, piston: bodies.Piston, foot: np.ndarray, low: float, bore: float) -> bool:
    """Return True if no rod meets a liner that begins at ``low``: its own leans, others pass beside it."""
    along, own = np.array(piston.along), machine.links[piston.link or ""]
    left = np.array([-along[1], along[0]])
    main = bodies.rod_foot(machine, own)
    eyes = [eye for eye in own.eyes if eye.on == piston.body or eye is main]
    start, end = (machine.path(own.body, eye.x, eye.y) - foot for eye in eyes)
    a, b = sorted((start, end), key=lambda path: float((path @ along).mean()))
    part = np.clip((low - a @ along) / ((b - a) @ along), 0.0, 1.0)
    aside = np.abs((a + part[:, None] * (b - a)) @ left).max()
    if aside + SHANK * bore > (0.5 - ROOM) * bore:
        return False
    wide = (0.5 + WALL) * bore
    wall = box((foot[0], foot[1]), piston.along, low, low + bore, wide)
    still = machine.poses["ground"][::EVERY]
    for other in machine.pistons.values():
        link = machine.links.get(other.link or "")
        if other is piston or link is None or abs(other.z - piston.z) > wide + ROD * bore / 2:
            continue
        poses = machine.poses[link.body][::EVERY], still
        if any(
            least_gap(shape, wall, poses, ROOM * bore)[0] < ROOM * bore / 2 for shape in rod_shapes(machine, link, bore)
        ):
            return False
    return True


def _neighbour_limit(machine: bodies.Machine, piston: bodies.Piston, bore: float) -> float:
    """Return how far from the shaft liners of other banks leave room for this one."""
    low = 0.0
    for other in machine.pistons.values():
        if other is piston or abs(other.z - piston.z) > (1 + 2 * WALL + ROOM) * bore:
            continue
        between = math.acos(max(-1.0, min(1.0, float(np.dot(piston.along, other.along)))))
        if between > 1e-6:
            low = max(low, (0.5 + WALL + ROOM / 2) * bore / math.tan(between / 2))
    return low
