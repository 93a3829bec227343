"""The plan of a shaft: thicknesses, journals, crank pins and webs along it (mm)."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise

from mechanisms.stages.automatic.layout.planar import Rounded, around, least_gap
from mechanisms.stages.automatic.layout.sizes import Sizes
from mechanisms.stages.automatic.shafts.bodies import (
    KNUCKLE_EYE,
    SAME,
    Link,
    LinkEye,
    Machine,
    Mounted,
    Shaft,
    Throw,
    carrier,
    carries,
    height_for,
    is_carrier,
    knuckle_eyes,
    middle,
    refuse_near,
)
from mechanisms.stages.automatic.shafts.cylinders import BIG_END, CRANK_PIN, ROD, SMALL_END, Cylinder
from shared.stage.errors import UserError

# How thick the links may be: what their distances along the normal leave (mm).

LEAST_STEP = 0.1
"""Between two links on crank pins at different places, in bores of their shaft."""
SIDE = 0.12
"""Gap between two rods side by side on one crank pin, in their thickness."""
THINNEST = 0.3
"""Least thickness of a link, as a part of what is wished."""
WASHER = 2.4
"""Between two links on one pin (rmm)."""
FREE = 0.6
"""Radius of a free end, in that of an eye."""
APART = 0.8
"""Between two links that pass each other (rmm)."""


@dataclass(frozen=True, eq=False)
class Measures:
    """Sizes that links, pins and shafts share."""

    machine: Machine
    sizes: Sizes
    cylinders: Mapping[str, Cylinder]

    @property
    def unit(self) -> float:
        """Millimetres in a reference millimetre."""
        return self.sizes.scale

    def of_rod(self, link: Link) -> float | None:
        """Return the bore whose piston a link drives; None for other links."""
        bores = [self.cylinders[eye.on].bore for eye in link.eyes if eye.on in self.cylinders]
        return min(bores, default=None)

    def of_shaft(self, shaft: Shaft) -> float:
        """Return the bore that a shaft's proportions follow, without pistons what goes with its pins."""
        links = [self.machine.links[throw.link] for throw in shaft.throws if throw.link in self.machine.links]
        bores = [bore for link in links if (bore := self.of_rod(link)) is not None]
        return min(bores, default=self.sizes.pin / (2 * CRANK_PIN) * 1.1)

    def crank_pin(self, shaft: Shaft) -> float:
        """Return the radius of a shaft's crank pins."""
        return CRANK_PIN * self.of_shaft(shaft)

    def eye(self, link: Link, eye: LinkEye) -> float:
        """Return the outer radius of an eye."""
        bore = self.of_rod(link)
        if not eye.on:
            return FREE * self.sizes.eye * self.unit
        if eye.on in self.machine.shafts:
            return (BIG_END / CRANK_PIN) * self.crank_pin(self.machine.shafts[eye.on])
        if eye.on in self.cylinders and bore is not None:
            return SMALL_END * bore
        if bore is not None and eye in knuckle_eyes(self.machine, link):
            return KNUCKLE_EYE * bore
        return self.sizes.eye * self.unit

    def wished(self, link: Link) -> float:
        """Return the thickness of a link where there is room; of one that carries rods, with its flanges."""
        bore = self.of_rod(link)
        if bore is not None and is_carrier(self.machine, link):
            return height_for(ROD * bore, self.axial)
        return ROD * bore if bore is not None else self.sizes.thickness * self.unit

    def shank(self, link: Link, thickness: Mapping[str, float]) -> float:
        """Return the thickness of a link away from its flanges."""
        own = thickness[link.body]
        return middle(own, self.axial) if is_carrier(self.machine, link) else own

    def outline(self, link: Link) -> Rounded:
        """Return the outline that holds a link in the plane."""
        return around([(eye.x, eye.y) for eye in link.eyes] or [(0.0, 0.0)], self.radius(link))

    def radius(self, link: Link) -> float:
        """Return the radius of its largest eye."""
        return max((self.eye(link, eye) for eye in link.eyes), default=self.sizes.eye * self.unit)

    @property
    def axial(self) -> float:
        """Gap along the axis of what turns."""
        return max(0.2, self.sizes.pivot.fit.axial * self.unit)


def thicknesses(measures: Measures) -> dict[str, float]:
    """Return thicknesses by link.

    Raises UserError naming both bodies, their distance and what to do where plates do not fit.
    """
    machine = measures.machine
    thickness = {name: measures.wished(link) for name, link in machine.links.items()}
    for first, second in _near(measures, thickness):
        a, b = machine.links[first], machine.links[second]
        apart = abs(a.z - b.z)
        if _shares_crank_pin(machine, a, b):
            room = apart - max(measures.axial, SIDE * apart)
        elif bore := _web_between(measures, a, b):
            room = apart - 2 * measures.axial - LEAST_STEP * bore
        elif _shares_pin(a, b):
            room = apart - WASHER * measures.unit
        else:
            room = apart - APART * measures.unit
        least = THINNEST * (measures.wished(a) + measures.wished(b)) / 2
        if room < least:
            gap, at = least_gap(
                measures.outline(a), measures.outline(b), (machine.poses[first], machine.poses[second]), 0.0
            )
            where = f"meet in the plane at t={machine.times[at]:.3g} s" if gap < 0 else "share a pin or a shaft"
            raise UserError(
                f"{machine.m.name}: '{first}' and '{second}' {where} and are {apart:.4g} mm apart along z; "
                f"plates of {least:.3g} mm and the gap between them need {least + apart - room:.3g} mm: move one of "
                "them along z, make pins thinner (automatic(m, pin=...)), or leave one out (automatic(m).leave_out)"
            )
        both = (thickness[first] + thickness[second]) / 2
        if both > room:
            thickness[first], thickness[second] = (thickness[name] * room / both for name in (first, second))
    for name, link in machine.links.items():
        above, bore = carrier(machine, link), measures.of_rod(link)
        if above is not None:
            thickness[name] = min(thickness[name], measures.shank(above, thickness))
        elif bore is not None and is_carrier(machine, link):
            refuse_near(machine, link, bore)
    return thickness


def _near(measures: Measures, thickness: Mapping[str, float]) -> Sequence[tuple[str, str]]:
    """Return pairs that are near along z and meet in the plane, or share a pin."""
    machine, pairs = measures.machine, []
    for a, b in combinations(machine.links.values(), 2):
        if carries(machine, a, b):
            continue
        more = max(
            (WASHER + APART) * measures.unit, LEAST_STEP * (_web_between(measures, a, b) or 0.0) + 2 * measures.axial
        )
        if abs(a.z - b.z) > (thickness[a.body] + thickness[b.body]) / 2 + more:
            continue
        poses = machine.poses[a.body], machine.poses[b.body]
        shared = _shares_pin(a, b) or _shares_crank_pin(machine, a, b) or _web_between(measures, a, b) is not None
        room = measures.unit * measures.sizes.room
        if shared or least_gap(measures.outline(a), measures.outline(b), poses, room)[0] < room:
            pairs.append((a.body, b.body))
    return pairs


def _shares_pin(a: Link, b: Link) -> bool:
    return any(eye.on == b.body for eye in a.eyes) or bool(
        {eye.joint for eye in a.eyes} & {eye.joint for eye in b.eyes}
    )


def _web_between(measures: Measures, a: Link, b: Link) -> float | None:
    """Return the bore of a shaft on which two links follow each other on different crank pins."""
    for shaft in measures.machine.shafts.values():
        links = [throw.link for throw in shaft.throws]
        if a.body in links and b.body in links and abs(links.index(a.body) - links.index(b.body)) == 1:
            return measures.of_shaft(shaft)
    return None


def _shares_crank_pin(machine: Machine, a: Link, b: Link) -> bool:
    for shaft in machine.shafts.values():
        places = {throw.link: (throw.x, throw.y) for throw in shaft.throws}
        if a.body in places and b.body in places:
            (x, y), (u, v) = places[a.body], places[b.body]
            if abs(x - u) < SAME and abs(y - v) < SAME:
                return True
    return False


# Where a shaft has its crank pins, webs and journals along the normal (mm).

WEB, LEAST_WEB = 0.22, 0.09
"""Thickness of a web, wished and least, in bores."""
SHARE = 0.27
"""Share of the space between two crank pins that each of two webs gets."""
LEAST_BEARING = 0.16
END = 0.34
"""Lengths of journals, in bores: between two throws at least, and at either end."""
JOURNAL = 1.1
"""Radius of the journals in that of the crank pins."""
NECK = 1.1
"""Radius of a web about the axis, in that of the journals."""
CHEEK = 1.3
"""Radius of a web round its crank pin in that of the pin."""
HOLE = 0.55
"""Radius of the hole through a crank pin and its webs, in that of the pin."""
WEIGHT = 1.15
"""Radius of a counterweight at most, in what the webs reach."""
SNOUT, FLANGE = 0.3, 0.12
"""Lengths beyond the journals at the upper and at the lower end, in bores."""
THIN = 0.7
"""Radius of a shaft beyond its last bearing, in that of its journals."""
PROUD = 0.05
"""So far a shaft reaches beyond a wheel at its end, in bores."""
PLAIN = 0.6
"""Radius of a shaft without throws, at most, in the least radius within what sits on it."""
BETWEEN = 2.4
"""Least distance of two cams or wheels with a bearing between them, in radii of the journal."""
SAME_HEIGHT = 1e-3


@dataclass(frozen=True)
class Pin:
    """A crank pin with all links on it, from ``low`` to ``high``."""

    x: float
    y: float
    low: float
    high: float
    links: tuple[str, ...]


@dataclass(frozen=True)
class Web:
    """From ``low`` to ``high``, between the axis and the pins at its two faces.

    ``weight``: with a counterweight.
    """

    low: float
    high: float
    pins: tuple[tuple[float, float], ...]
    weight: bool


@dataclass(frozen=True)
class Journal:
    """A part that turns in a bearing on ground."""

    low: float
    high: float


@dataclass(frozen=True, eq=False)
class ShaftPlan:
    """All of one shaft, in its own frame about its axis."""

    shaft: Shaft
    unit: float
    """The bore that it goes with."""
    pin: float
    """Radius of its crank pins."""
    pins: tuple[Pin, ...]
    webs: tuple[Web, ...]
    journals: tuple[Journal, ...]
    gap: float
    """Along the axis, beside what turns on it or in what it turns."""
    counterweight: float
    """The largest radius of a counterweight."""
    mounted: tuple[Mounted, ...] = ()
    """Wheels and cams, in the order of their planes."""

    @property
    def journal(self) -> float:
        """Radius of its journals."""
        return JOURNAL * self.pin

    @property
    def cheek(self) -> float:
        """Radius of a web round a crank pin."""
        return CHEEK * self.pin

    @property
    def has_weights(self) -> bool:
        """True if there is room for counterweights."""
        return self.counterweight > 1.15 * self.neck

    @property
    def hole(self) -> float:
        """Radius of the holes through crank pins and their webs.

        0 where they would come out in a journal or a pin.
        """
        radius = HOLE * self.pin
        near = [math.hypot(pin.x, pin.y) - self.neck for pin in self.pins]
        near += [math.dist((a.x, a.y), (b.x, b.y)) - self.pin for a, b in pairwise(self.pins) if self._flies(a, b)]
        return radius if min(near, default=0.0) > radius + 0.1 * self.pin else 0.0

    def _flies(self, before: Pin, after: Pin) -> bool:
        return any(web.low == before.high and web.high == after.low for web in self.webs)

    def webs_of(self, pin: Pin) -> list[Web]:
        """Return the webs at both ends of a crank pin."""
        return [web for web in self.webs if web.high == pin.low or web.low == pin.high]

    @property
    def neck(self) -> float:
        """Radius of a web about the axis."""
        return NECK * self.journal

    @property
    def swept(self) -> float:
        """Radius that webs, and at most a counterweight, sweep about the axis."""
        reach = max((math.hypot(pin.x, pin.y) for pin in self.pins), default=0.0) + self.cheek
        on_it = max((part.radius for part in self.mounted), default=0.0)
        return max(reach, self.counterweight if self.has_weights else 0.0, self.journal, on_it)

    @property
    def webs_sweep(self) -> float:
        """Radius that its webs sweep about the axis, without wheels."""
        return max(math.hypot(pin.x, pin.y) for pin in self.pins) + self.cheek if self.pins else self.journal

    @property
    def ends(self) -> tuple[float, float]:
        """Ends of all journals along z."""
        return self.journals[0].low, self.journals[-1].high

    @property
    def top(self) -> float:
        """Highest z of the shaft."""
        beyond = [part.high + PROUD * self.unit for part in self.mounted if part.low > self.ends[1]]
        return max([self.ends[1] + (SNOUT if self.pins else PROUD) * self.unit, *beyond])

    @property
    def has_flange(self) -> bool:
        """True if its lower end is a flange: that of a crankshaft without a wheel there."""
        return bool(self.pins) and not any(part.high < self.ends[0] for part in self.mounted)

    def bottom(self, flywheel: float) -> float:
        """Return the lowest z of the shaft; ``flywheel`` is the radius of its flywheel, 0 for none."""
        beyond = [part.low - PROUD * self.unit for part in self.mounted if part.high < self.ends[0]]
        end = (2.2 if flywheel else 1.0) * FLANGE if self.pins else PROUD
        return min([self.ends[0] - end * self.unit, *beyond])

    def seat_radius(self, part: Mounted) -> float:
        """Return the radius of the shaft where a wheel or a cam sits."""
        inside = self.ends[0] < part.z < self.ends[1]
        return self.journal if inside or not self.pins else THIN * self.journal


def shaft_plan(
    shaft: Shaft,
    measures: Measures,
    thickness: Mapping[str, float],
    cylinders: Mapping[str, Cylinder],
    mounted: Sequence[Mounted] = (),
) -> ShaftPlan:
    """Plan a shaft.

    Raises UserError naming two links that are too near along z for a web between them, and wheels that have no room on
    it.
    """
    on_it = tuple(sorted(mounted, key=lambda part: part.z))
    if not shaft.throws:
        bores = [cylinder.bore for cylinder in cylinders.values()]
        unit = min(bores) if bores and not all(part.is_wheel for part in on_it) else measures.of_shaft(shaft)
        return _plain(shaft, measures, on_it, unit)
    unit, gap = measures.of_shaft(shaft), measures.axial
    pins = _pins(shaft, thickness, gap, _both(unit))
    webs, journals = _between(measures, shaft, pins, unit)
    thick = webs[0].high - webs[0].low
    first, last = pins[0].low - thick, pins[-1].high + thick
    webs = [Web(first, pins[0].low, ((pins[0].x, pins[0].y),), True), *webs[1:-1]]
    webs.append(Web(pins[-1].high, last, ((pins[-1].x, pins[-1].y),), True))
    journals = [Journal(first - END * unit, first), *journals, Journal(last, last + END * unit)]
    own = [cylinder.counterweight for cylinder in cylinders.values() if cylinder.shaft is shaft]
    reach = max(math.hypot(pin.x, pin.y) for pin in pins) + CHEEK * measures.crank_pin(shaft)
    weight = min([*own, WEIGHT * reach])
    radius = measures.crank_pin(shaft)
    plan = ShaftPlan(shaft, unit, radius, tuple(pins), tuple(webs), tuple(journals), gap, weight, on_it)
    _refuse_mounted(measures.machine.m.name, plan)
    return plan


def _refuse_mounted(name: str, plan: ShaftPlan) -> None:
    """Raise UserError for a wheel among the throws, and for one that is too small for its shaft."""
    low, high = plan.ends
    for part in plan.mounted:
        if plan.pins and part.high > low - plan.gap and part.low < high + plan.gap:
            raise UserError(
                f"{name}: {part.what} is at z = {part.z:.4g} mm, where '{plan.shaft.body}' has its crank pins and "
                f"bearings, from {low:.4g} to {high:.4g} mm; give it a place beyond, below "
                f"{low - plan.gap - part.thickness / 2:.4g} or above {high + plan.gap + part.thickness / 2:.4g} mm"
            )
        if part.inner < plan.seat_radius(part):
            raise UserError(
                f"{name}: {part.what} has no room for its shaft, whose radius is {plan.seat_radius(part):.4g} mm, and "
                f"inside of its rim there are {part.inner:.4g} mm; make the wheel larger"
            )


def _plain(shaft: Shaft, measures: Measures, mounted: Sequence[Mounted], unit: float) -> ShaftPlan:
    """Return a shaft without throws: a rod with bearings between what sits on it.

    Wheels at its ends are beyond the last.
    """
    room = min(part.inner for part in mounted)
    pin = min(CRANK_PIN * unit, PLAIN * room / JOURNAL)
    journal, gap = JOURNAL * pin, measures.axial
    long = LEAST_BEARING * unit + 2 * gap
    first, last = mounted[0], mounted[-1]
    hangs = [len(mounted) > 1 and part.is_wheel for part in (first, last)]
    rooms = []
    for k, (before, after) in enumerate(pairwise(mounted)):
        needed = (k == 0 and hangs[0]) or (k == len(mounted) - 2 and hangs[1])
        space = after.low - before.high
        if needed and space < long + 2 * gap:
            raise UserError(
                f"{measures.machine.m.name}: {before.what} and {after.what} are {after.z - before.z:.4g} mm apart "
                f"along '{shaft.body}', and with a bearing between them they need "
                f"{after.z - before.z - space + long + 2 * gap:.4g} mm; move one of them along z"
            )
        if needed or space > BETWEEN * journal:
            rooms.append((before.high, after.low, needed))
    both = len(rooms) == 1 and all(hangs)
    journals = []
    for low, high, _ in rooms:
        most = END * unit
        if both and high - low > 2 * long + 2 * gap:
            size = min(most, (high - low) / 2 - 2 * gap)
            journals += [Journal(low + gap, low + gap + size), Journal(high - gap - size, high - gap)]
        else:
            middle, half = (low + high) / 2, min(most, high - low - 2 * gap) / 2
            journals.append(Journal(middle - half, middle + half))
    if not hangs[0]:
        journals.insert(0, Journal(first.low - gap - END * unit, first.low - gap))
    if not hangs[1]:
        journals.append(Journal(last.high + gap, last.high + gap + END * unit))
    plan = ShaftPlan(shaft, unit, pin, (), (), tuple(journals), gap, 0.0, tuple(mounted))
    _refuse_mounted(measures.machine.m.name, plan)
    return plan


def _pins(shaft: Shaft, thickness: Mapping[str, float], gap: float, most: float) -> list[Pin]:
    """Return groups of links that share a pin.

    At one place they follow each other along z, where less than ``most`` is between them.
    """
    groups: list[list[Throw]] = []
    for throw in shaft.throws:
        last = groups[-1][-1] if groups else None
        between = throw.z - last.z - (thickness[throw.link] + thickness[last.link]) / 2 if last else math.inf
        if last and between < most and math.hypot(last.x - throw.x, last.y - throw.y) < SAME_HEIGHT:
            groups[-1].append(throw)
        else:
            groups.append([throw])
    pins = []
    for group in groups:
        first, last = group[0], group[-1]
        x, y = first.x - shaft.axis[0], first.y - shaft.axis[1]
        low, high = first.z - thickness[first.link] / 2 - gap, last.z + thickness[last.link] / 2 + gap
        pins.append(Pin(x, y, low, high, tuple(throw.link for throw in group)))
    return pins


def _between(measures: Measures, shaft: Shaft, pins: list[Pin], unit: float) -> tuple[list[Web], list[Journal]]:
    """Return webs and journals between the crank pins.

    The first and the last web stand for those at the ends.
    """
    spaces = [after.low - before.high for before, after in pairwise(pins)]
    thick = min([WEB * unit, *(SHARE * space for space in spaces if space >= _both(unit))])
    end = Web(0.0, thick, (), True)
    webs, journals = [end], []
    for (before, after), space in zip(pairwise(pins), spaces, strict=True):
        places = (before.x, before.y), (after.x, after.y)
        if space >= _both(unit):
            low, high = before.high + thick, after.low - thick
            webs += [Web(before.high, low, places[:1], True), Web(high, after.low, places[1:], True)]
            journals.append(Journal(low, high))
        elif space >= LEAST_WEB * unit:
            webs.append(Web(before.high, after.low, places, False))
        else:
            first, second = before.links[-1], after.links[0]
            z = [link.z for link in (measures.machine.links[first], measures.machine.links[second])]
            raise UserError(
                f"{measures.machine.m.name}: '{first}' and '{second}' are {z[1] - z[0]:.4g} mm apart along z on "
                f"'{shaft.body}', on crank pins at different places; the web between them needs "
                f"{z[1] - z[0] - space + LEAST_WEB * unit:.4g} mm: move them apart along z"
            )
    return [*webs, end], journals


def _both(unit: float) -> float:
    """Return the least space for two webs and a journal."""
    return (2 * LEAST_WEB + LEAST_BEARING) * unit / (1 - 0.2)
