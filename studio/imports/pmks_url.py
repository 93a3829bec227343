"""Mechanisms in addresses of PMKS+: its joints and links as pins, slides, welds and drives.

A slider is a joint in a slot of the ground or of a link; what is pinned to it rides in the slot and turns, unless it
is welded. Older addresses have three records for one: the slot, a pin at the same place, a block of both. A link pinned
to the ground twice is of the ground. Links of a weld move as one. A drive turns the second of two links at a pin
against the first, the ground before all others, or moves a slider along its slot (mechanism-builder.ts, actuator.ts).
"""

from __future__ import annotations

import math
import re
from urllib.parse import urlparse

from shared.stage.errors import UserError
from studio.imports.limits import Titles
from studio.imports.pmks_records import PARTS, ROOTS, JointRecord, LinkRecord, Records, query_of, records_of
from studio.imports.sketch import GROUND, Link, Load, Motor, Place, Push, Sketch, Slide, Weld

HOST = "pmksplus.com"
RECORD = re.compile(rf"\.[{ROOTS}{PARTS}][RP]\w")
UNITS = (
    ("an inch", 0.0254, 0.45359237, 0.45359237 * 0.0254**2),
    ("a centimetre", 0.01, 1e-3, 1e-4),
    ("a metre", 1.0, 1.0, 1.0),
)
"""Units by that of length: its name, m, kg of a mass (lb, g, kg), kg m^2 of an inertia (lb in^2, kg cm^2, kg m^2)."""
POUND = 4.4482216152605
"""N"""
GRAVITY = (0.0, -9.81)
USUAL_RATE = 5.0
"""Units of length a second of a driven slider, in addresses older than the setting."""


def is_pmks_url(text: str) -> bool:
    """Return True if a text is such an address, its beginning, or its query alone."""
    first = text.strip()
    if "\n" in first:
        return False
    if first.startswith("pmks2:"):
        return True
    try:
        host = urlparse(first).hostname or ""
    except ValueError:
        return False
    return host == HOST or host.endswith(f".{HOST}") or (first.count("..") >= 2 and RECORD.search(first) is not None)


def read(text: str, name: str) -> Sketch:
    """Return the mechanism of such an address. Raises UserError if it cannot be read."""
    return _Reader(records_of(query_of(text)), name).sketch


class _Reader:
    def __init__(self, records: Records, name: str) -> None:
        self.records = records
        unit, self.length, self.mass, self.inertia = UNITS[records.length]
        self.sketch = Sketch(name, "PMKS+", unit=f"{unit}, as the address says")
        self.joints, self.blocks = self._folded()
        roots = [link for link in records.links.values() if link.is_root and link.id not in self.blocks]
        titles = Titles()
        self.labels = {joint.id: titles.title_for(joint.name or joint.id) for joint in self.joints.values()}
        names = Titles()
        self.bodies = {
            link.id: GROUND if self._is_frame(link) else names.title_for(link.name or link.id) for link in roots
        }
        for link in roots:
            self._weld(link)
        self.on = {joint: self._carriers(joint, roots) for joint in self.joints}
        for link in roots:
            if self.bodies[link.id] != GROUND:
                self._link(link)
        for joint in self.joints.values():
            if joint.is_slider:
                self._slide(joint)
            else:
                self._pin(joint)
        self._drives()
        self._loads()
        self.sketch.freedom = self._freedom(roots)
        if any(link.mass for link in self.sketch.links.values()) and records.has_gravity:
            self.sketch.gravity = GRAVITY
        self._name_left_out()

    def _weld(self, root: LinkRecord) -> None:
        """Make all parts of a welded link, and their parts, one body."""
        parts = list(root.parts)
        while parts:
            part = parts.pop()
            if part not in self.bodies:
                self.bodies[part] = self.bodies[root.id]
                parts += self.records.links[part].parts

    def _folded(self) -> tuple[dict[str, JointRecord], dict[str, LinkRecord]]:
        """Return joints with slot and pin as one, by the pin's id, and the blocks that joined them."""
        joints, blocks = dict(self.records.joints), {}
        for block in self.records.links.values():
            given = [joints[joint] for joint in block.joints if joint in joints]
            slots, pins = [j for j in given if j.is_slider], [j for j in given if not j.is_slider]
            if not block.is_block or len(slots) != 1 or len(pins) != 1:
                continue
            (slot,), (pin,) = slots, pins
            blocks[block.id] = block
            del joints[slot.id]
            joints[pin.id] = JointRecord(
                pin.id, pin.name, True, slot.is_input or pin.is_input,
                slot.is_grounded or (pin.is_grounded and not slot.carrier), pin.is_welded,
                slot.is_traced or pin.is_traced, pin.x, pin.y, slot.angle, slot.carrier, slot.slot,
                slot.speed or pin.speed, block.mass, slot.has_friction or pin.has_friction,
            )  # fmt: skip
        return joints, blocks

    def _is_frame(self, link: LinkRecord) -> bool:
        """Return True if it is pinned to the ground at two places."""
        pins = (self.joints[joint] for joint in link.joints if joint in self.joints)
        return len({pin.place for pin in pins if pin.is_grounded and not pin.is_slider}) > 1

    def _carriers(self, joint: str, roots: list[LinkRecord]) -> list[str]:
        """Return the links on a joint in the address's order, the ground first if it is pinned there."""
        given = self.joints[joint]
        ground = [GROUND] if given.is_grounded and not given.is_slider else []
        return list(dict.fromkeys([*ground, *(self.bodies[link.id] for link in roots if joint in link.joints)]))

    def _place(self, joint: str) -> Place:
        x, y = self.joints[joint].place
        return x * self.length, y * self.length

    def _link(self, given: LinkRecord) -> None:
        link = self.sketch.link(self.bodies[given.id])
        for joint in given.joints:
            if joint in self.joints:
                link.points.setdefault(self.labels[joint], self._place(joint))
        if given.mass > 0.0:
            link.mass = given.mass * self.mass
            centre = (given.x, given.y) if given.has_centre else self._middle(given)
            link.centre = (centre[0] * self.length, centre[1] * self.length)
            link.inertia = given.inertia * self.inertia if given.has_inertia else None

    def _middle(self, link: LinkRecord) -> Place:
        places = [self.joints[joint].place for joint in link.joints if joint in self.joints]
        return sum(x for x, _ in places) / len(places), sum(y for _, y in places) / len(places)

    def _guide(self, joint: JointRecord) -> str | None:
        """Return the body that has the slot; None if the address names none."""
        if joint.carrier:
            return self.bodies.get(joint.carrier)
        return GROUND if joint.is_grounded else None

    def _slot(self, joint: JointRecord) -> tuple[float, Place]:
        """Return the direction of a slot, and a place in it."""
        if not joint.carrier:
            return joint.angle, self._place(joint.id)
        (x0, y0), (x1, y1) = (self.records.joints[end].place for end in joint.slot)
        if math.hypot(x1 - x0, y1 - y0) < 1e-12:
            raise UserError(f"the slot of slider {joint.id} has no direction: its ends are at one place")
        return math.atan2(y1 - y0, x1 - x0), (x0 * self.length, y0 * self.length)

    def _slide(self, joint: JointRecord) -> None:
        """Add a slot and its slider; a block that has a mass is a body between them."""
        label, guide, place = self.labels[joint.id], self._guide(joint), self._place(joint.id)
        riders = [rider for rider in self.on[joint.id] if rider != guide]
        if guide is None or not riders:
            if guide is None or not self.on[joint.id]:  # else guide and rider are welded into one
                self.sketch.left_out.append(f"slider {label}: it has no slot, or no link rides in it")
            return
        angle, along = self._slot(joint)
        turns, mass = not joint.is_welded, joint.mass * self.mass
        if mass > 0.0 and turns:
            block = Link(f"block {label}", {label: place}, mass=mass, centre=place, inertia=0.0)
            self.sketch.links[block.name] = block
            riders.insert(0, block.name)
        elif mass > 0.0:
            self.sketch.left_out.append(f"mass of slider {label} ({mass:g} kg), which is welded to what rides on it")
        self.sketch.joints.append(Slide(label, guide, riders[0], place, angle, turns and mass <= 0.0, along))
        if turns:
            self.sketch.pin_all(f"{label} pin" if len(riders) > 1 else label, riders, place)
        if joint.is_traced:
            self.sketch.traces[label] = (riders[-1], place)
        for rider in riders[1:] if not turns else ():
            self.sketch.joints.append(Weld(f"{label} weld", riders[0], rider, place))

    def _pin(self, joint: JointRecord) -> None:
        label, carriers, place = self.labels[joint.id], self.on[joint.id], self._place(joint.id)
        if len(carriers) > 1:
            self.sketch.pin_all(label, carriers, place)
        elif not carriers:
            self.sketch.left_out.append(f"joint {label}: no link is on it")
        moving = [carrier for carrier in carriers if carrier != GROUND]
        if moving and (joint.is_traced or len(carriers) == 1):
            self.sketch.traces[label] = (moving[0], place)

    def _drives(self) -> None:
        """Add motors and pushes: for the first input joint of each machine."""
        machines = _Groups(self.sketch)
        driven: dict[str, str] = {}
        for joint in self.joints.values():
            if not joint.is_input:
                continue
            label = self.labels[joint.id]
            bodies = self._driven(joint)
            if isinstance(bodies, str):
                self.sketch.left_out.append(f"input {label}: {bodies}")
                continue
            machine = machines.group_of(bodies[1])
            if machine in driven:
                self.sketch.left_out.append(f"input {label}: PMKS+ moves that machine by its input {driven[machine]}")
                continue
            driven[machine] = label
            self._drive(joint, *bodies)

    def _driven(self, joint: JointRecord) -> tuple[str, str] | str:
        """Return the two bodies that an input moves against each other, or why it moves none."""
        bodies = self.on[joint.id]
        if joint.is_slider:
            guide = self._guide(joint)
            riders = [rider for rider in bodies if rider != guide]
            return (guide, riders[0]) if guide is not None and riders else "nothing slides there"
        if bodies == [GROUND]:
            return "its link is of the ground, as it is pinned to it twice"
        return (
            (bodies[0], bodies[1])
            if len(bodies) == 2
            else f"it needs two links that meet there, and there are {len(bodies)}"
        )

    def _drive(self, joint: JointRecord, first: str, second: str) -> None:
        label, records = self.labels[joint.id], self.records
        if joint.is_slider:
            angle, along = self._slot(joint)
            rate = (joint.speed or records.linear_speed or USUAL_RATE) * self.length
            self.sketch.pushes.append(Push(f"drive {label}", first, second, self._place(joint.id), angle, rate, along))
            self.sketch.left_out.append(
                f"input {label}: PMKS+ turns it round at the ends of its travel, here it goes on"
            )
            return
        rpm = joint.speed or (-records.speed if records.is_clockwise else records.speed)
        self.sketch.motors.append(Motor(f"motor {label}", first, second, rpm * math.tau / 60.0))

    def _loads(self) -> None:
        """Add forces on links that move."""
        for force in self.records.forces:
            body = self.bodies.get(force.link, GROUND)
            (x0, y0), (x1, y1) = force.start, force.end
            if body == GROUND or (x0, y0) == (x1, y1):
                self.sketch.left_out.append(f"force {force.name or force.id}: it is on the ground, or has no direction")
                continue
            sign = 1.0 if force.is_outwards else -1.0
            angle = math.atan2(sign * (y1 - y0), sign * (x1 - x0))
            newtons = force.magnitude * (POUND if self.records.length == 0 else 1.0)
            place = (x0 * self.length, y0 * self.length)
            self.sketch.loads.append(Load(force.name or force.id, body, place, newtons, angle, force.is_local))

    def _freedom(self, roots: list[LinkRecord]) -> int:
        """Return 3 for each moving link and block, less what the joints remove."""
        moving = {self.bodies[link.id] for link in roots} - {GROUND}
        freedom = 3 * len(moving)
        for joint in self.joints.values():
            links = {self.bodies[link.id] for link in roots if joint.id in link.joints}
            if not joint.is_slider:
                freedom -= 2 * (len(links | {GROUND} if joint.is_grounded else links) - 1) if links else 0
                continue
            riders = links - {self._guide(joint)}
            if riders and self._guide(joint) is not None:
                freedom -= 1 + 2 * (len(riders) - 1) if not joint.is_welded else 2 + 3 * (len(riders) - 1)
        return freedom

    def _name_left_out(self) -> None:
        left_out, records = self.sketch.left_out, self.records
        if records.gears:
            left_out.append("its gears; m.gear_pair says them")
        for joint in self.joints.values():
            if joint.has_friction:
                left_out.append(f"friction at joint {self.labels[joint.id]}; m.friction says it")
        for link in records.links.values():
            if link.is_block and link.id not in self.blocks:
                left_out.append(f"block {link.id}, which is of no slot and pin")


class _Groups:
    """Groups of links that are connected by joints, not by the ground alone."""

    def __init__(self, sketch: Sketch) -> None:
        self._above: dict[str, str] = {}
        for joint in sketch.joints:
            first, second = self.group_of(joint.first), self.group_of(joint.second)
            if first != second and GROUND not in (first, second):
                self._above[first] = second

    def group_of(self, link: str) -> str:
        """Return the link that stands for the group of a link."""
        while link in self._above:
            link = self._above[link]
        return link
