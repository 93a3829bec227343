"""Records in an address of PMKS+: settings, joints, links and forces of its query.

They are read as its own decoder reads them.

``[switches].[decimals,].[whole numbers,].[choices].joints..links..forces...selected[.marks]check[*digest]``. Digits are
0-9A-Za-z_-, a leading 0 is a minus, decimals are thousandths. Flags are one digit, lowest bit first.

    joint    [slider, input, ground, weld, curve, sealed]id,name,x,y,angle[,carrier,slot a,slot b[,speed[,mass[,...]]]]
    link     [YAMG0123 root, Namg4567 part of a welded one][R bar, P block]id,name,mass,inertia,x,y,colour,joints,,parts
    force    [local, outwards]id,link,name,x,y,x,y,magnitude

A welded link names its parts, which are links of their own that are no root. The check is the length modulo 62, the
digest FNV-1a. Marks correct a number (``PJ<id>~<field>~<value>``), hold gears, or say how things are shown and edited.

From the sources of PMKS+ (PMKS-Web/Planar-Mechanism-Kinematic-Simulator, MIT, string-transcoder.ts, checksum.ts and
mechanism-builder.ts of 2026; PMKS-Web/PMKSWeb at 84b8d2b for what was written before).
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from urllib.parse import unquote, urlparse

from shared.stage.errors import UserError
from studio.imports.limits import check_count, check_length
from studio.imports.sketch import Place

DIGITS = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_-"
CHECKS = DIGITS[:62]
ROOTS, PARTS = "YAMG0123", "Namg4567"
"""First characters of links that stand for themselves, and of those that are parts of a welded one."""
INERTIA_GIVEN, CENTRE_GIVEN = "YG03Ng47", "YM02Nm46"
"""First characters of links whose author gave the inertia, or the centre of mass; else they follow from the shape."""
MOST_DIGITS = 12
"""Digits of a number; ten hold all that PMKS+ can write exactly."""
JOINT_NUMBERS, LINK_NUMBERS = ("x", "y", "angle", "speed", "mass"), ("mass", "inertia", "x", "y")
"""Numbers that a mark may correct, in its order."""


@dataclass
class JointRecord:
    """Joint in units of the address; a slider has its slot's direction or the link that carries it."""

    id: str
    name: str
    is_slider: bool
    is_input: bool
    is_grounded: bool
    is_welded: bool
    """A slider that is welded holds what rides in its slot from turning."""
    is_traced: bool
    x: float
    y: float
    angle: float
    carrier: str = ""
    slot: tuple[str, str] = ("", "")
    speed: float = 0.0
    """rpm, or units of length a second, of an input that has its own; negative is clockwise."""
    mass: float = 0.0
    has_friction: bool = False

    @property
    def place(self) -> Place:
        """Place of the joint."""
        return self.x, self.y


@dataclass
class LinkRecord:
    """A link with its joints; a welded one names its parts."""

    id: str
    name: str
    is_root: bool
    is_block: bool
    """A slider's block, of a slot and of the pin that rides in it."""
    mass: float
    inertia: float
    x: float
    y: float
    joints: list[str]
    parts: list[str]
    has_inertia: bool
    has_centre: bool


@dataclass
class ForceRecord:
    """Force on a link, from one place towards another or back; a local one turns with its link."""

    id: str
    link: str
    name: str
    is_local: bool
    is_outwards: bool
    start: Place
    end: Place
    magnitude: float
    """Pounds of force with inches, else newtons."""


@dataclass
class Records:
    """All records of an address."""

    joints: dict[str, JointRecord] = field(default_factory=dict)
    links: dict[str, LinkRecord] = field(default_factory=dict)
    forces: list[ForceRecord] = field(default_factory=list)
    is_clockwise: bool = False
    has_gravity: bool = True
    speed: float = 0.0
    """rpm"""
    linear_speed: float = 0.0
    """Units of length a second; 0 where the address is older than the setting."""
    length: int = 1
    """0 inch, 1 centimetre, 2 metre."""
    gears: bool = False


def query_of(text: str) -> str:
    """Return the query of an address, or the text itself. Raises UserError for a wrong address."""
    try:
        query = urlparse(text.strip()).query
    except ValueError as error:
        raise UserError(f"{text.strip()[:60]!r} is not an address ({error})") from error
    return unquote(query or text.strip()).removeprefix("mech=").removeprefix("?")


def records_of(query: str) -> Records:
    """Return the records of a query.

    Raises UserError if its checks fail or a record cannot be read.
    """
    check_length(query)
    if query.startswith("pmks2:"):
        raise UserError(
            "it is a document of the new editor of PMKS+ (pmks2:), which has other records; share the old form"
        )
    sections = _checked(query).split(".")
    if len(sections) < 7:
        raise UserError(f"it ends early: {len(sections)} of 7 sections are there; copy all of it, in quotes")
    switches, decimals, whole, choices = sections[:4]
    flags = _whole(switches, signed=False)
    speeds = [_decimal(text) for text in decimals.split(",")]
    read = Records(
        is_clockwise=bool(flags & 1),
        has_gravity=not flags & 1 << 8,
        speed=float(_whole(whole.split(",")[0])),
        linear_speed=speeds[1] if len(speeds) > 1 else 0.0,
        length=int(choices[:1] or 1) if choices[:1] in ("", "0", "1", "2") else 1,
    )
    joints, rest = _until_empty(sections[4:])
    links, rest = _until_empty(rest)
    forces, rest = _until_empty(rest)
    for things, words in ((joints, "joints"), (links, "links"), (forces, "forces")):
        check_count(things, words)
    read.forces = [_force(text) for text in forces]
    for text in joints:
        joint = _joint(text)
        if joint.id in read.joints:
            raise UserError(f"there are two joints {joint.id}")
        read.joints[joint.id] = joint
    for text in links:
        link = _link(text)
        if link.id in read.links:
            raise UserError(f"there are two links {link.id}")
        read.links[link.id] = link
    for mark in ".".join(rest[1:]).split(","):  # in which points are those of numbers
        _take_in(read, mark)
    _check_references(read)
    return read


def _checked(query: str) -> str:
    """Return the query without its checks.

    Raises UserError if they show that it was changed or cut off.
    """
    body, mark, digest = query.rpartition("*")
    if mark and re.fullmatch(r"[0-9A-Za-z]{6}", digest):
        if _digest(body) != digest:
            raise UserError("its digest is wrong: it was changed or cut off; copy all of it, in quotes")
        query = body
    if len(query) < 2 or CHECKS[(len(query) - 1) % len(CHECKS)] != query[-1]:
        raise UserError("its checksum is wrong: it was changed or cut off; copy all of it, in quotes")
    return query[:-1]


def stamped(query: str) -> str:
    """Return a query whose last characters are its checks, so a change leaves it an address."""
    body = query.rpartition("*")[0] or query
    checked = body[:-1] + CHECKS[max(len(body) - 1, 0) % len(CHECKS)]
    return f"{checked}*{_digest(checked)}" if "*" in query else checked


def _digest(text: str) -> str:
    value = 0x811C9DC5
    for letter in text:
        value = (value ^ ord(letter)) * 0x01000193 & 0xFFFFFFFF
    digits = ""
    for _ in range(6):
        value, digit = divmod(value, len(CHECKS))
        digits = CHECKS[digit] + digits
    return digits


def _until_empty(sections: list[str]) -> tuple[list[str], list[str]]:
    """Return the sections before the first empty one, and those after it.

    Raises UserError if none is empty.
    """
    if "" not in sections:
        raise UserError("a list of its records does not end; copy all of it, in quotes")
    end = sections.index("")
    return sections[:end], sections[end + 1 :]


def _joint(text: str) -> JointRecord:
    cells = text.split(",")
    if len(cells) < 5 or len(cells[0]) < 2:
        raise UserError(f"{text[:40]!r} is not a joint")
    flags = _whole(cells[0][0], signed=False)
    cells += [""] * (11 - len(cells))
    return JointRecord(
        id=cells[0][1:],
        name=cells[1],
        is_slider=bool(flags & 1),
        is_input=bool(flags & 2),
        is_grounded=bool(flags & 4),
        is_welded=bool(flags & 8),
        is_traced=bool(flags & 16),
        x=_decimal(cells[2]),
        y=_decimal(cells[3]),
        angle=_decimal(cells[4]),
        carrier=cells[5],
        slot=(cells[6], cells[7]),
        speed=_decimal(cells[8] or "0"),
        mass=_decimal(cells[9] or "0"),
        has_friction=any(cell.strip("0~") for cell in cells[11:]),
    )


def _link(text: str) -> LinkRecord:
    cells = text.split(",")
    if len(cells) < 8 or len(cells[0]) < 3 or cells[0][0] not in ROOTS + PARTS or cells[0][1] not in "RP":
        raise UserError(f"{text[:40]!r} is not a link")
    kind, members = cells[0][0], cells[7:]
    end = members.index("") if "" in members else len(members)
    return LinkRecord(
        id=cells[0][2:],
        name=cells[1],
        is_root=kind in ROOTS,
        is_block=cells[0][1] == "P",
        mass=_decimal(cells[2]),
        inertia=_decimal(cells[3]),
        x=_decimal(cells[4]),
        y=_decimal(cells[5]),
        joints=list(dict.fromkeys(members[:end])),
        parts=[part for part in members[end + 1 :] if part],
        has_inertia=kind in INERTIA_GIVEN,
        has_centre=kind in CENTRE_GIVEN,
    )


def _force(text: str) -> ForceRecord:
    cells = text.split(",")
    if len(cells) < 8 or len(cells[0]) < 2:
        raise UserError(f"{text[:40]!r} is not a force")
    flags = _whole(cells[0][0], signed=False)
    x0, y0, x1, y1, magnitude = (_decimal(cell) for cell in cells[3:8])
    return ForceRecord(
        cells[0][1:], cells[1], cells[2], bool(flags & 1), bool(flags & 2), (x0, y0), (x1, y1), magnitude
    )


def _take_in(read: Records, mark: str) -> None:
    """Read a correction of a number, or gears; other marks concern display and editing."""
    if mark.startswith("G1~"):
        read.gears = True
    name, number, value = (*mark[2:].split("~"), "", "")[:3]
    if mark.startswith(("PI~0~", "PD~1~")):
        setattr(read, "speed" if mark[1] == "I" else "linear_speed", float(value))
    if not re.match(r"P[JL]", mark):
        return
    things, numbers = (read.joints, JOINT_NUMBERS) if mark[1] == "J" else (read.links, LINK_NUMBERS)
    if name not in things or not number.isascii() or not number.isdigit() or int(number) >= len(numbers):
        raise UserError(f"{mark[:40]!r} corrects a number that does not exist")
    setattr(things[name], numbers[int(number)], float(value))


def _check_references(read: Records) -> None:
    """Raise UserError for a link of missing joints, or a slot in a missing link."""
    for link in read.links.values():
        if not link.joints:
            raise UserError(f"link {link.id} has no joints")
        for joint in link.joints:
            if joint not in read.joints:
                raise UserError(f"link {link.id} has a joint {joint}, which does not exist")
        for part in link.parts:
            if part not in read.links:
                raise UserError(f"link {link.id} has a part {part}, which does not exist")
    for force in read.forces:
        if force.link not in read.links:
            raise UserError(f"force {force.id} is on link {force.link}, which does not exist")
    for joint in read.joints.values():
        if joint.carrier and (joint.carrier not in read.links or not all(end in read.joints for end in joint.slot)):
            raise UserError(f"slider {joint.id} has a slot in {joint.carrier}, which does not exist")


def _whole(text: str, signed: bool = True) -> int:
    """Return a whole number; a leading 0 is a minus."""
    digits, sign = (text[1:], -1) if signed and text[:1] == "0" else (text, 1)
    if not text or len(digits) > MOST_DIGITS or any(digit not in DIGITS for digit in digits):
        raise UserError(f"{text[:40]!r} is not a number")
    value = 0
    for digit in digits:
        value = value * len(DIGITS) + DIGITS.index(digit)
    return sign * value


def _decimal(text: str) -> float:
    return _whole(text) / 1000.0
