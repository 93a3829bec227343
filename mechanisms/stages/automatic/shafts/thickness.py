"""How thick the links may be: what their distances along the normal leave (mm)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.planar import Rounded, around, least_gap
from mechanisms.stages.automatic.shafts.bodies.planes import SAME
from mechanisms.stages.automatic.shafts.cylinders import BIG_END, CRANK_PIN, ROD, SMALL_END
from mechanisms.stages.automatic.shafts.knuckles import (
    KNUCKLE_EYE,
    carrier,
    carries,
    height_for,
    is_carrier,
    knuckle_eyes,
    middle,
    refuse_near,
)
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from mechanisms.stages.automatic.layout.sizes import Sizes
    from mechanisms.stages.automatic.shafts.bodies.kinds import Link, LinkEye, Machine, Shaft
    from mechanisms.stages.automatic.shafts.cylinders import Cylinder

WEB = 0.1
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
        """The bore whose piston a link drives; None of other links."""
        bores = [self.cylinders[eye.on].bore for eye in link.eyes if eye.on in self.cylinders]
        return min(bores, default=None)

    def of_shaft(self, shaft: Shaft) -> float:
        """The bore that a shaft's proportions follow; of a shaft without pistons what goes with its pins."""
        links = [self.machine.links[throw.link] for throw in shaft.throws if throw.link in self.machine.links]
        bores = [bore for link in links if (bore := self.of_rod(link)) is not None]
        return min(bores, default=self.sizes.pin / (2 * CRANK_PIN) * 1.1)

    def crank_pin(self, shaft: Shaft) -> float:
        """Radius of a shaft's crank pins."""
        return CRANK_PIN * self.of_shaft(shaft)

    def eye(self, link: Link, eye: LinkEye) -> float:
        """Outer radius of an eye."""
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
        """Thickness of a link where there is room; of one that carries rods, with its flanges."""
        bore = self.of_rod(link)
        if bore is not None and is_carrier(self.machine, link):
            return height_for(ROD * bore, self.axial)
        return ROD * bore if bore is not None else self.sizes.thickness * self.unit

    def shank(self, link: Link, thickness: Mapping[str, float]) -> float:
        """Thickness of a link away from its flanges."""
        own = thickness[link.body]
        return middle(own, self.axial) if is_carrier(self.machine, link) else own

    def outline(self, link: Link) -> Rounded:
        """What holds it in the plane."""
        return around([(eye.x, eye.y) for eye in link.eyes] or [(0.0, 0.0)], self.radius(link))

    def radius(self, link: Link) -> float:
        """Radius of its largest eye."""
        return max((self.eye(link, eye) for eye in link.eyes), default=self.sizes.eye * self.unit)

    @property
    def axial(self) -> float:
        """Gap along the axis of what turns."""
        return max(0.2, self.sizes.pivot.fit.axial * self.unit)


def thicknesses(measures: Measures) -> dict[str, float]:
    """By link. Raises UserError naming both bodies, their distance and what to do where plates do not fit."""
    machine = measures.machine
    thickness = {name: measures.wished(link) for name, link in machine.links.items()}
    for first, second in _near(measures, thickness):
        a, b = machine.links[first], machine.links[second]
        apart = abs(a.z - b.z)
        if _shares_crank_pin(machine, a, b):
            room = apart - max(measures.axial, SIDE * apart)
        elif bore := _web_between(measures, a, b):
            room = apart - 2 * measures.axial - WEB * bore
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
    """Pairs that are near along z and meet in the plane, or share a pin."""
    machine, pairs = measures.machine, []
    for a, b in combinations(machine.links.values(), 2):
        if carries(machine, a, b):
            continue
        more = max((WASHER + APART) * measures.unit, WEB * (_web_between(measures, a, b) or 0.0) + 2 * measures.axial)
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
    """The bore that goes with a shaft on which two links follow each other, on crank pins at different places."""
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
