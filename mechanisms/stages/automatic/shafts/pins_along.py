"""Pins between links in different planes, and axles on ground that links turn on (mm)."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from mechanisms.stages.automatic.layout.planar import Rounded, disc
from mechanisms.stages.automatic.shafts.bodies.kinds import NEAR
from mechanisms.stages.automatic.shafts.bodies.planes import SAME
from mechanisms.stages.automatic.shafts.knuckles import carries
from mechanisms.stages.automatic.shafts.passing import Takes
from shared.stage.errors import UserError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from mechanisms.stages.automatic.layout.sizes import Sizes
    from mechanisms.stages.automatic.shafts.bodies.kinds import Machine

FOOT = 16.0
"""Radius of the foot of what carries an axle on ground (rmm)."""


@dataclass(frozen=True, eq=False)
class Axle:
    """Links that turn about one axis, in the order of their planes; the lowest holds the pin unless ground does."""

    joint: str
    places: Mapping[str, tuple[float, float]]
    """Place on each body, ground included where it holds the pin, in its frame."""
    stack: tuple[str, ...]

    @property
    def holder(self) -> str:
        """The body with the pin."""
        return "ground" if "ground" in self.places else self.stack[0]


def axles(machine: Machine) -> list[Axle]:
    """Pins between links, and between links and ground. Raises UserError for two links of one axis in one plane."""
    groups: list[tuple[str, dict[str, tuple[float, float]]]] = []
    for body, link in machine.links.items():
        for eye in link.eyes:
            if eye.on not in machine.links and eye.on != "ground":  # shafts, pistons, free ends
                continue
            if eye.on in machine.links and carries(machine, link, machine.links[eye.on]):
                continue  # between the flanges of its carrier
            other = _place_of(machine, eye.joint, eye.on)
            ends = {body: (eye.x, eye.y), eye.on: other}
            near = [group for group in groups if _share(group[1], ends)]
            joined = {k: v for _, group in near for k, v in group.items()} | ends
            name = near[0][0] if near else eye.joint
            groups = [group for group in groups if group not in near]
            groups.append((name, joined))
    made = []
    for name, places in groups:
        stack = sorted((body for body in places if body != "ground"), key=lambda body: machine.links[body].z)
        for below, above in pairwise(stack):
            z = machine.links[below].z
            if machine.links[above].z - z < SAME:
                raise UserError(
                    f"{machine.m.name}: '{below}' and '{above}' are both at z = {z:g} mm and turn about one axis in "
                    f"'{name}'; give them places z that differ by more than their thickness"
                )
        made.append(Axle(name, places, tuple(stack)))
    return made


def _place_of(machine: Machine, joint: str, body: str) -> tuple[float, float]:
    from mechanisms.stages.automatic.shafts.bodies.planes import marker_on, place

    return place(marker_on(machine.m.joints[joint], body))


def _share(a: Mapping[str, tuple[float, float]], b: Mapping[str, tuple[float, float]]) -> bool:
    return any(abs(a[k][0] - b[k][0]) < NEAR and abs(a[k][1] - b[k][1]) < NEAR for k in a.keys() & b.keys())


def axle_takes(own: Axle, machine: Machine, thickness: Mapping[str, float], sizes: Sizes, low: float) -> list[Takes]:
    """Its pin with head, spacers and column; ``low`` is the top of the base plate."""
    unit, on = sizes.scale, frozenset(own.places)
    first, last = machine.links[own.stack[0]], machine.links[own.stack[-1]]
    top = last.z + thickness[last.body] / 2 + _head(sizes) + 0.5 * unit
    start = low if own.holder == "ground" else first.z - thickness[first.body] / 2
    shape = pin_outline(own, sizes)
    return [Takes(f"the pin of '{own.joint}'", own.holder, shape, start, top, on)]


def _head(sizes: Sizes) -> float:
    return sizes.head.height * sizes.scale


def bore_of(own: Axle, body: str, sizes: Sizes) -> float:
    """Diameter of the hole in a link on an axle."""
    pivot = sizes.pivot
    return (pivot.held if body == own.holder else pivot.pin + pivot.fit.running) * sizes.scale


def pin_outline(own: Axle, sizes: Sizes) -> Rounded:
    """What holds the pin with its head in the plane, in the frame of the body that holds it."""
    return disc(*own.places[own.holder], sizes.hardware * sizes.scale)
