"""The size of parts: how far joints reach, lengths that must hold a pin, and the scale (mm)."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace
from itertools import combinations
from typing import Any

import numpy as np

from mbsd import Mechanism, Solution
from mbsd.model.body import Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mechanisms.stages.automatic.layout.planar import placed
from mechanisms.stages.loading.wishes import wished_scale
from mechanisms.stages.parts_files import TOLERANCE
from shared.shapes.pin import Head, Pivot
from shared.shapes.screw import SOCKET
from shared.shapes.standards import CIRCLIPS, Fit, shim_ring
from shared.shapes.units import mm
from shared.stage.errors import UserError
from shared.stage.face import said
from shared.stage.scale import Scale

# Lengths from which the scale of the parts follows: the reach of joints, and lengths that must hold a pin's width.

LINK, STUD = 22.0, 18.0
"""Least distances of two pins of one body, and of a spring's stud and a pin or stud beside it (rmm)."""
ROD = "distance"
"""The kind of joint that is a rod: like a body here, though it has no mass and no pose of its own in the model."""
STRETCHING = (
    "spring", "spring_law", "curve_of_length", "actuator", "gas", "gas_cycle", "gas_strut", "hydraulic_cylinder",
)  # fmt: skip
"""Kinds of forces that act along the line of two points, or along an axis on which both may be."""
ROPE, LINEAR = "rope", "drive_distance"
"""The kinds of contact and of driver that do."""
NEAR = 0.02
"""Studs that are nearer to each other, as a part of the whole, are on one place, or do not decide the scale."""


type Place = tuple[float, float]


@dataclass(frozen=True)
class Extent:
    """Extent of a joint, contact or force: how far it reaches, and which lengths must hold its parts."""

    radii: tuple[tuple[Marker, float], ...] = ()
    """Markers and radii (m) round them."""
    least: tuple[tuple[float, float], ...] = ()
    """Lengths of the model (m), each with the least that it may be in rmm."""


class Kinds[Result](dict[str, Callable[..., Result]]):
    """Functions by the names of the kinds of joints, forces, contacts or drivers that they serve."""

    def enter[Served: Callable[..., Any]](self, name: str) -> Callable[[Served], Served]:
        """Return a decorator that enters a function for a kind. Raises ValueError for a second one."""

        def entered(function: Served) -> Served:
            if name in self:
                raise ValueError(f"{name}: registered twice")
            self[name] = function
            return function

        return entered


EXTENTS: Kinds[Extent] = Kinds()
"""Functions of a joint, contact or force and the solution that return its extent."""
extent = EXTENTS.enter


@dataclass(frozen=True)
class Lengths:
    """Lengths of a mechanism (m) from which the size of its parts follows."""

    apart: list[tuple[float, str, float]]
    """Distances of two pins of a body, or what is like one, each with words for it, and the length that these mean;
    without those that are none.
    """
    overall: float
    """The longer side of all that is swept."""

    @property
    def shortest(self) -> tuple[float, str, float]:
        """The shortest distance, with its words and their length."""
        return min(self.apart, default=(self.overall, "all that moves", self.overall))


def lengths_of(m: Mechanism, solution: Solution, left_out: Collection[str] = ()) -> Lengths:
    """Return lengths of a mechanism and its motion, without bodies that are ``left_out``."""
    places, studs = defaultdict[str, list[Place]](list), defaultdict[str, list[Place]](list)
    pins = defaultdict[str, list[tuple[str, Place]]](list)
    least: list[tuple[float, str, float]] = []
    for thing in holding(m):
        pair = getattr(thing.kind, "pair", "pin")  # forces that hold are pins with play
        for marker in (thing.i, thing.j):
            body, place = marker.body.name, (marker.x, marker.y)
            if body not in left_out:
                places[body].append(place)
                if pair == "pin" or thing.kind.name == ROD or (pair == "slot" and marker is thing.j):
                    pins[body].append((thing.name, place))
    for thing in (*m.joints.values(), *m.contacts.values(), *m.forces.values()):
        if thing.kind.name in EXTENTS and not any(body in left_out for body in thing.bodies):
            own = EXTENTS[thing.kind.name](thing, solution)
            least += [(length * LINK / wanted, f"a length of '{thing.name}'", length) for length, wanted in own.least]
            for marker, radius in own.radii:
                places[marker.body.name] += [(marker.x + radius * u, marker.y + radius * v) for u, v in _ROUND]
    for element in stretching(m, left_out):
        for marker in (element.i, element.j):
            places[marker.body.name].append((marker.x, marker.y))
            studs[marker.body.name].append((marker.x, marker.y))
    jointed = {name for thing in holding(m) for name in thing.bodies}
    for name, body in m.bodies.items():
        if name not in (*jointed, *left_out, "ground"):
            places[name].append(body.com)
        if body.length is not None and name not in left_out:
            places[name] += [(0.0, 0.0), (body.length, 0.0)]
    seen = np.concatenate([[[0.0, 0.0]], *[_swept(solution, body, np.array(at)) for body, at in places.items()]])
    overall = float(np.ptp(seen[1:], axis=0).max()) if len(seen) > 1 else 1.0
    apart = [
        (d := math.dist(a, b), f"the distance of '{first}' and '{second}' on '{body}'", d)
        for body, on_it in pins.items()
        for (first, a), (second, b) in combinations(on_it, 2)
    ]
    for body, at in studs.items():
        beside = [math.dist(a, b) for i, a in enumerate(at) for b in [*at[:i], *(place for _, place in pins[body])]]
        words = f"the distance of pins or ends of springs on '{body}'"
        least += [(d * LINK / STUD, words, d) for d in beside if d > NEAR * overall]
    return Lengths([length for length in [*apart, *least] if length[0] > 1e-3 * overall], overall)


def holding(m: Mechanism) -> list[Joint | Force]:
    """Return joints, and forces that hold two bodies together as joints do."""
    return [*m.joints.values(), *(force for force in m.forces.values() if force.kind.journal is not None)]


def stretching(m: Mechanism, left_out: Collection[str] = ()) -> list[Force | Joint]:
    """Return forces, ropes and drivers between two points that have parts at both ends."""
    elements: list[Force | Joint] = [force for force in m.forces.values() if force.kind.name in STRETCHING]
    elements += [contact for contact in m.contacts.values() if contact.kind.name == ROPE]
    elements += [driver for driver in m.drivers.values() if driver.kind.name == LINEAR]
    return [element for element in elements if not any(body in left_out for body in element.bodies)]


_ROUND = [(np.cos(a), np.sin(a)) for a in np.linspace(0.0, 2 * np.pi, 16, endpoint=False)]


def _swept(solution: Solution, body: str, at: np.ndarray) -> np.ndarray:
    if body == "ground":
        return at
    view = solution.body(body)
    return placed(at, np.column_stack([view.x, view.y, view.theta])).reshape(-1, 2)


def distance(joint: Joint, solution: Solution) -> float:
    """Return the distance between a joint's two markers at the start (m)."""
    first, second = (_swept(solution, k.body.name, np.array([[k.x, k.y]]))[0] for k in (joint.i, joint.j))
    return float(np.hypot(*(second - first)))


def rods_of(m: Mechanism, left_out: Collection[str] = ()) -> dict[str, Joint]:
    """Return rods by name, which is that of the joint unless a body has it.

    Rods that lack an end are left out.
    """
    rods: dict[str, Joint] = {}
    for name, joint in m.joints.items():
        rod = f"rod_{name}" if name in m.bodies else name
        if joint.kind.name == ROD and rod not in left_out and not any(body in left_out for body in joint.bodies):
            rods[rod] = joint
    return rods


# Sizes follow the mechanism: one scale for pins, eyes and plates, from its shortest link and its overall size.
#
# Everything is laid out and built with pins of :data:`PIN` mm, in reference millimetres (rmm), and scaled at the end.
# So a 20 mm clockwork and a 3 m excavator have the same proportions, chamfers included.

PIN = 8.0
"""Diameter of a pin (rmm)."""
STANDARD = (
    0.5, 0.6, 0.8, 1, 1.2, 1.6, 2, 2.5, 3, 4, 5, 6, 8, 10, 12, 16, 20, 25, 30, 40, 50, 60, 80, 100, 120, 160, 200,
)  # fmt: skip
"""Diameters of pins that there are (mm), after ISO 2338; a larger one is a whole number of 50 mm."""
THICKEST_SCREW = 4.0
"""Largest screw of a pedestal's flange (rmm)."""
LEAST_LINK = 2.75
"""The shortest distance of two pins of one body, in diameters of a pin."""
OVERALL = 20.0
"""The longer side of what the joints sweep, in diameters of a pin."""

MUCH_THINNER = 2.5
"""Pins thinner by this factor than the size of the machine suggests are reported."""
COARSEST = 0.13
"""Tolerance of meshes, at most so much of the clearance of pins."""
THINNEST = 0.5
"""Thinnest of the pins that are tried, in pins of the wished size."""
CLEAR = 0.6
"""Between what touches by design, such as a cam and its roller, or stops, in running fits."""


@dataclass(frozen=True)
class Sizes:
    """Sizes in rmm; ``scale`` millimetres are one rmm."""

    scale: float
    pivot: Pivot
    thickness: float = 7.0
    """Thickness of links and plates."""
    eye: float = 13.0
    """Outer radius of an eye."""
    stylus_eye: float = 7.0
    hardware: float = 9.2
    """Radius of all that turns about a pin: flange, washer, head, boss, pedestal."""
    roller: float = 13.0
    """Diameter of a roller in a slot."""
    head: Head = Head(14.0, 4.0, 1.6)
    pedestal: float = 8.0
    """Least height of a pedestal."""
    pin_end: float = 1.2
    """Length of a pin beyond its circlip."""
    room: float = 1.5
    """Least gap in the plane between bodies that share a height."""
    ratio: float = 1.0
    """Millimetres of the finished piece for a millimetre here: 0.05 for a model at 1:20."""

    def of_metres(self, length: float) -> float:
        """Return a length of the model (m) in rmm."""
        return mm(length) / self.scale

    @property
    def finished(self) -> float:
        """Millimetres of the finished piece that one rmm is, which is what standards go by."""
        return self.scale * self.ratio

    @property
    def pin(self) -> float:
        """Diameter of a pin (mm)."""
        return PIN * self.scale

    @property
    def finished_pin(self) -> float:
        """The same of the finished piece."""
        return PIN * self.finished

    @property
    def end_room(self) -> float:
        """Height (rmm) that the head of a pin takes above the eye that turns under it, with room above."""
        pivot = self.pivot
        return pivot.flange_room + pivot.fit.axial + self.head.height + pivot.fit.axial

    @property
    def clip_room(self) -> float:
        """Height (rmm) that a circlip and the pin's end take above the eye, with room above."""
        return self.pivot.flange_room + self.pivot.retainer_room + self.pin_end + self.pivot.fit.axial

    @property
    def tolerance(self) -> float | None:
        """Largest distance (mm of the finished piece) of meshes from the true surface; None: the usual.

        It is in proportion where parts are large, and well below the clearance of pins.
        """
        large = min(self.finished, COARSEST * self.pivot.fit.running * self.finished / TOLERANCE)
        return TOLERANCE * large if large > 1.0 else None

    @property
    def screw(self) -> float:
        """Nominal diameter (mm of the finished piece) of a pedestal's screws; 0 where all are too thick.

        It is the standard one next to 3 rmm.
        """
        nearest = min(SOCKET, key=lambda size: abs(size - 3.0 * self.finished))
        return nearest if nearest <= THICKEST_SCREW * self.finished else 0.0


def sizes(shortest: float, overall: float, fit: Fit | None = None, thinnest: float = THINNEST) -> list[Sizes]:
    """Return sizes, the most wanted first, then with thinner pins.

    They follow from the shortest distance of two joints of one body and the longer side of what all joints sweep (m).
    The last pins are ``thinnest`` times as thick at least.
    """
    pin = standard(min(mm(shortest) / LEAST_LINK, mm(overall) / OVERALL))
    thinner = [d for d in reversed(STANDARD) if thinnest * pin <= d < pin]
    return [of_pin(d, fit) for d in (pin, *thinner)]


def thin_pins(lengths: Lengths, pin: float) -> str:
    """Return why pins of ``pin`` mm are much thinner than usual in a machine of this size.

    Empty where they are not.
    """
    shortest, words, own = lengths.shortest
    usual = standard(mm(lengths.overall) / OVERALL)
    if standard(mm(shortest) / LEAST_LINK) * MUCH_THINNER > usual:
        return ""
    return (
        f"pins of {pin:g} mm, because {words} is {mm(own):.3g} mm; a machine of {mm(lengths.overall):.3g} mm "
        f"would have pins of {usual:g} mm. Move the two farther apart, or put them on one place"
    )


def of_pin(diameter: float, fit: Fit | None = None, ratio: float = 1.0) -> Sizes:
    """Return sizes that go with pins of this diameter (mm).

    Washers and circlips are those that one can buy where there are any.

    ``fit`` in mm; by default what a workshop can make, small or large. Both are those of the finished piece, in the
    ``ratio`` to the machine.
    """
    scale = diameter / PIN
    if fit is None:
        running = min(max(0.2 * scale, 0.16), 0.6)
        axial = min(max(0.4 * scale, 0.16), 2.0)
        fit = Fit(running, Fit.press * scale, axial, Fit.seat * scale)
    of_reference = Fit(fit.running / scale, fit.press / scale, fit.axial / scale, fit.seat / scale)
    return Sizes(scale / ratio, _bought(Pivot(fit=of_reference), diameter, scale), ratio=ratio)


def _bought(pivot: Pivot, diameter: float, scale: float) -> Pivot:
    """Return the pivot with the sizes of standard washers and circlips."""
    ring, clip = shim_ring(diameter, pivot.washer_thickness * scale), CIRCLIPS.get(diameter)
    if ring:
        washer, thickness = ring.outer / scale, ring.thickness / scale
        pivot = replace(pivot, washer=washer, washer_thickness=thickness, washer_buy=ring.name)
    if clip:
        depth = (clip.shaft - clip.groove) / 2 / scale
        pivot = replace(pivot, clip_thickness=clip.thickness / scale, groove_depth=depth, clip_buy=clip.name)
        pivot = replace(pivot, groove_width=clip.width / scale)
    return pivot


def standard(wish: float) -> float:
    """Return the standard diameter (mm) next below ``wish``; the smallest one if there is none below."""
    if wish >= STANDARD[-1] + 50:
        return 50.0 * (wish // 50)
    return max((d for d in STANDARD if d <= wish * (1 + 1e-9)), default=STANDARD[0])


def refuse_sizes(name: str, pin: float | None, fit: Fit | None) -> None:
    """Raise UserError for sizes that are none."""
    given = {"pin": pin} | ({f"fit.{field}": value for field, value in vars(fit).items()} if fit else {})
    for what, value in given.items():
        if value is not None and not 0 < value < float("inf"):
            raise UserError(f"{name}: {what} is {value} mm; give a positive number")


# Sizes of models at a scale, which are printed: pins and clearances in millimetres of the finished piece.
#
# Hardware of a pin of :data:`LEAST` mm is as thin as a nozzle allows: the wall of a bushing is 0.41 mm, its flange
# 0.45 mm, and washers and circlips of that size are bought (DIN 988, DIN 471).

LEAST = 3.0
"""Diameter of the thinnest pin (mm)."""
RUNNING, PRESS, AXIAL = 0.3, 0.1, 0.3
"""Least clearances of printed parts (mm)."""


def printed_sizes(
    name: str, lengths: Lengths, scale: Scale, thinnest: float, pin: float | None = None, fit: Fit | None = None
) -> list[Sizes]:
    """Return the most wanted first, then with thinner pins, the last ``thinnest`` times as thick at least.

    ``pin`` (mm of the machine) is what its author wishes there, ``fit`` (mm of the piece) what the printer does. Raises
    UserError naming the shortest link and the smallest scale that would do, if no pin fits it.
    """
    shortest, link, own = lengths.shortest
    room = mm(shortest) * scale.ratio / LEAST_LINK
    if room < LEAST * (1 - 1e-9):
        raise UserError(_too_short(name, shortest, link, own, scale))
    wished = mm(lengths.overall) * scale.ratio / OVERALL if pin is None else pin * scale.ratio
    thick = max(standard(min(room, wished)), LEAST)
    thinner = [d for d in reversed(STANDARD) if max(thinnest * thick, LEAST) <= d < thick]
    return [of_pin(d, fit or printed_fit(d), scale.ratio) for d in (thick, *thinner)]


def printed_fit(pin: float) -> Fit:
    """Return clearances that printed parts with pins of this diameter need (mm)."""
    size = pin / PIN
    return Fit(
        min(max(0.2 * size, RUNNING), 0.6), max(Fit.press * size, PRESS), max(0.4 * size, AXIAL), Fit.seat * size
    )


def fit_at_scale(pin: float) -> Fit:
    """Return the clearances for a parts.py with pins of this diameter, in mm of the machine.

    They are ``Fit()``, or in a model at a scale what its printer needs.
    """
    scale = wished_scale()
    if scale is None:
        return Fit()
    fit = printed_fit(pin * scale.ratio)
    return Fit(*(clearance / scale.ratio for clearance in (fit.running, fit.press, fit.axial, fit.seat)))


def _too_short(name: str, shortest: float, link: str, own: float, scale: Scale) -> str:
    needed = LEAST * LEAST_LINK
    times = mm(shortest) / needed
    least = f"1:{math.floor(times)}" if times >= 1 else f"{math.ceil(1 / times)}:1"
    return (
        f"{name} at {scale}: {link} becomes {mm(own) * scale.ratio:.3g} mm, and the thinnest pins that can be "
        f"printed, of {LEAST:g} mm, need {needed * own / shortest:.3g} mm; "
        f"{said(scale=least)} is the smallest that works"
    )
