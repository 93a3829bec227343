"""Assemblies of Ondsel and FreeCAD (.asmt) that move in one plane; a spatial joint is an error.

The plane is that of the pins. A marker stands in a reference point, that in a part, that in the assembly; joints and
motors act along the markers' z axes.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from shared.stage.errors import UserError
from studio.imports.expressions import as_law
from studio.imports.limits import check_count, check_depth, check_length
from studio.imports.sketch import GROUND, Gears, Link, Motor, Pin, Place, Sketch, Slide, Weld

# Text of an .asmt file, read by its tabs: entries with their values and the entries below.


@dataclass
class Entry:
    """One word with the lines indented below it; numbers and texts are entries with nothing below."""

    word: str
    line: int
    below: list[Entry] = field(default_factory=list)

    def all_named(self, word: str) -> Iterator[Entry]:
        """Return the entries below that are called so."""
        return (entry for entry in self.below if entry.word == word)

    def named(self, word: str) -> Entry | None:
        """Return the first entry below of this name, None if there is none."""
        return next(self.all_named(word), None)

    def text(self, word: str) -> str:
        """Return the one line below an entry; raises UserError if it is missing."""
        entry = self.named(word)
        if entry is None or not entry.below:
            raise UserError(f"line {self.line}: {self.word} has no {word}")
        return entry.below[0].word.strip()

    def number(self, word: str, usual: float | None = None) -> float:
        """Return the number below an entry; ``usual`` if it is missing."""
        if usual is not None and self.named(word) is None:
            return usual
        return _numbers(self.text(word), self.line)[0]

    def vector(self, word: str) -> np.ndarray:
        """Return three numbers of a line, zeros if they are missing."""
        entry = self.named(word)
        if entry is None or not entry.below:
            return np.zeros(3)
        return np.array(_numbers(entry.below[0].word, entry.line, 3))

    def matrix(self) -> np.ndarray:
        """Return the rotation matrix; the identity if it is missing."""
        entry = self.named("RotationMatrix")
        if entry is None:
            return np.eye(3)
        if len(entry.below) < 3:
            raise UserError(f"line {entry.line}: RotationMatrix has {len(entry.below)} rows; it needs three")
        return np.array([_numbers(row.word, row.line, 3) for row in entry.below[:3]])


def parsed(text: str) -> Entry:
    """Return the whole file. Raises UserError if it is not indented by tabs."""
    root = Entry("", 0)
    path = [root]
    for number, line in enumerate(text.splitlines(), 1):
        word = line.strip("\t ")
        if not word:
            continue
        depth = len(line) - len(line.lstrip("\t"))
        if depth >= len(path):
            raise UserError(f"line {number} is indented by {depth} tabs below one with {len(path) - 2}")
        check_depth(depth, f"line {number}")
        del path[depth + 1 :]
        entry = Entry(word, number)
        path[-1].below.append(entry)
        path.append(entry)
    return root


def _numbers(text: str, line: int, count: int = 1) -> list[float]:
    """Return ``count`` finite numbers or more. Raises UserError with the line."""
    try:
        numbers = [float(word.replace("d", "e") if word.count("d") == 1 else word) for word in text.split()]
    except ValueError:
        raise UserError(f"line {line}: {text.strip()[:60]!r} are not numbers") from None
    if len(numbers) < count or not all(math.isfinite(number) for number in numbers):
        raise UserError(f"line {line}: {text.strip()[:60]!r} should be {count} finite numbers")
    return numbers[:count]


PINS = ("RevoluteJoint", "SphericalJoint")
SLIDES = ("TranslationalJoint", "CylindricalJoint")
IDLE = ("PlanarJoint", "ParallelAxesJoint", "NoRotationJoint")
"""Joints that a mechanism in their plane keeps anyway, where their axes are normal to it."""
ALIGNED = 1e-6
"""Sine of the angle between axes that count as one direction."""
MOVING = 3
"""Freedoms of a part in its plane."""
ROWS = {"FixedJoint": 3, "TranslationalJoint": 2, "PointInPlaneJoint": 1, "PointInLineJoint": 1, "InLineJoint": 1}
"""Freedoms that a joint takes in the plane: 2 where it is not here, 1 for gears, none for :data:`IDLE`."""


def is_asmt(text: str) -> bool:
    """True if a text is such a file."""
    lines = [line for line in text[:4000].splitlines() if line.strip()]
    return any(line.strip() == "Assembly" for line in lines[:3])


def read(text: str, name: str) -> Sketch:
    """Return the mechanism of such a file.

    Raises UserError, with joint or line, if it is spatial or damaged.
    """
    body = text.partition("\nTimeSeries")[0]
    check_length(body)
    assembly = parsed(body).named("Assembly")
    if assembly is None:
        raise UserError("the file has no Assembly")
    return _Reader(assembly, name).sketch


@dataclass
class _Marker:
    part: str
    origin: np.ndarray
    axes: np.ndarray
    """Columns: x, y, z in the world."""


class _Reader:
    def __init__(self, assembly: Entry, name: str) -> None:
        self.assembly = assembly
        self.sketch = Sketch(name, "an .asmt assembly")
        self.path = f"/{assembly.text('Name')}"
        self.markers: dict[str, _Marker] = {}
        self.parts: dict[str, Entry] = {}
        self._markers_of(assembly, GROUND, np.zeros(3), np.eye(3), self.path)
        parts = assembly.named("Parts")
        check_count(parts.below if parts else [], "parts")
        for part in parts.all_named("Part") if parts else ():
            name = part.text("Name")
            if name in self.parts:
                raise UserError(f"line {part.line}: there are two parts of the name {name}")
            self.parts[name] = part
            self._markers_of(part, name, part.vector("Position3D"), part.matrix(), f"{self.path}/{name}")
        constraints = assembly.named("ConstraintSets")
        joints = constraints.named("Joints") if constraints else None
        self.joints = joints.below if joints else []
        check_count(self.joints, "joints")
        check_count(self._motions(constraints), "motions")
        self.plane = self._plane()
        for part in self.parts:
            self._link(part)
        for joint in self.joints:
            self._joint(joint)
        self.sketch.freedom = MOVING * len(self.parts) - sum(_taken(joint.word) for joint in self.joints)
        for motion in self._motions(constraints):
            self._motion(motion)
        for limits in constraints.all_named("Limits") if constraints else ():
            self.sketch.left_out += [
                f"limit {limit.text('Name')}; limits= of the joint says it" for limit in limits.below
            ]
        forces = assembly.named("ForceTorques")
        for force in forces.below if forces else ():
            self.sketch.left_out.append(f"{force.word} {force.text('Name')}; docs/forces.md has what says it")
        x, y = self._flat_vector(assembly.vector("ConstantGravity"))
        self.sketch.gravity = (x, y) if math.hypot(x, y) > 1e-9 else None
        settings = assembly.named("SimulationParameters")
        if settings is not None:
            duration = settings.number("tend", 0.0) - settings.number("tstart", 0.0)
            self.sketch.duration = duration if duration > 0 else None

    def _markers_of(self, owner: Entry, part: str, origin: np.ndarray, axes: np.ndarray, path: str) -> None:
        points = owner.named("RefPoints")
        for point in points.all_named("RefPoint") if points else ():
            place, turned = origin + axes @ point.vector("Position3D"), axes @ point.matrix()
            markers = point.named("Markers")
            for marker in markers.all_named("Marker") if markers else ():
                name = f"{path}/{marker.text('Name')}"
                where = place + turned @ marker.vector("Position3D")
                self.markers[name] = _Marker(part, where, turned @ marker.matrix())

    def _plane(self) -> np.ndarray:
        """Return rows x, y and normal of the plane of motion.

        Raises UserError if the joints share no plane.
        """
        turning = [joint for joint in self.joints if joint.word in ("RevoluteJoint", "GearJoint", "RackPinionJoint")]
        axes = [(joint, self._ends(joint)[0].axes[:, 2]) for joint in turning]
        if not axes:
            names = ", ".join(f"{joint.word} {joint.text('Name')}" for joint in self.joints[:4]) or "there are none"
            raise UserError(f"no joint gives the plane of motion ({names}): a RevoluteJoint does")
        normal = axes[0][1]
        for joint, axis in axes:
            if np.linalg.norm(np.cross(axis, normal)) > ALIGNED:
                raise UserError(
                    f"{joint.word} {joint.text('Name')} turns about another axis than the others; the file is spatial"
                )
        lead = int(np.argmax(np.abs(normal)))
        normal = normal * np.sign(normal[lead])
        x = np.eye(3)[(0, 2, 0)[lead] if lead != 0 else 1]
        x = x - normal * (x @ normal)
        x /= np.linalg.norm(x)
        return np.array([x, np.cross(normal, x), normal])

    def _flat(self, point: np.ndarray) -> Place:
        return float(self.plane[0] @ point), float(self.plane[1] @ point)

    _flat_vector = _flat

    def _angle(self, direction: np.ndarray) -> float:
        return math.atan2(self.plane[1] @ direction, self.plane[0] @ direction)

    def _in_plane(self, direction: np.ndarray) -> bool:
        return abs(direction @ self.plane[2]) < ALIGNED

    def _ends(self, joint: Entry) -> tuple[_Marker, _Marker]:
        ends = []
        for word in ("MarkerI", "MarkerJ"):
            name = joint.text(word)
            if name not in self.markers:
                raise UserError(f"{joint.word} {joint.text('Name')}: there is no marker {name}")
            ends.append(self.markers[name])
        return ends[0], ends[1]

    def _link(self, name: str) -> None:
        part = self.parts[name]
        origin, axes = part.vector("Position3D"), part.matrix()
        link = Link(name, {f"{name} origin": self._flat(origin)}, angle=self._part_angle(axes))
        mass = part.named("PrincipalMassMarker")
        if mass is not None and mass.number("Mass", 0.0) > 0.0:
            turned = axes @ mass.matrix()
            inertias = mass.vector("MomentOfInertias")
            link.mass = mass.number("Mass")
            link.centre = self._flat(origin + axes @ mass.vector("Position3D"))
            link.inertia = float(np.sum(inertias * (turned.T @ self.plane[2]) ** 2))
        speed, spin = part.vector("Velocity3D"), part.vector("Omega3D")
        velocity = (*self._flat_vector(speed), float(spin @ self.plane[2]))
        link.velocity = velocity if any(abs(value) > 1e-12 for value in velocity) else None
        self.sketch.links[name] = link

    def _part_angle(self, axes: np.ndarray) -> float:
        """Return the angle of the axis that lies best in the plane."""
        across = [abs(axes[:, k] @ self.plane[2]) for k in range(3)]
        return self._angle(axes[:, int(np.argmin(across))])

    def _joint(self, joint: Entry) -> None:
        kind, name = joint.word, joint.text("Name")
        i, j = self._ends(joint)
        order = (i, j) if i.part == GROUND or j.part != GROUND else (j, i)
        first, second = order[0].part, order[1].part
        axis, place = i.axes[:, 2], self._flat(i.origin)
        along = self._in_plane(axis)
        normal = np.linalg.norm(np.cross(axis, self.plane[2])) < ALIGNED
        if (kind in PINS and (normal or kind == "SphericalJoint")) or (kind == "CylindricalJoint" and normal):
            self.sketch.joints.append(Pin(name, first, second, place))
        elif kind in SLIDES and along:
            self._slide(name, order, axis)
        elif kind == "FixedJoint":
            self.sketch.joints.append(Weld(name, first, second, place))
        elif kind == "PointInPlaneJoint" and self._in_plane(j.axes[:, 2]):
            x, y = self._flat_vector(j.axes[:, 2])
            slot = math.atan2(x, -y)  # along the plane, across its normal
            self.sketch.joints.append(
                Slide(name, j.part, i.part, self._flat(i.origin), slot, turns=True, along=self._flat(j.origin))
            )
        elif kind in ("PointInLineJoint", "InLineJoint") and self._in_plane(j.axes[:, 2]):
            self.sketch.joints.append(
                Slide(name, j.part, i.part, self._flat(i.origin), self._angle(j.axes[:, 2]), True, self._flat(j.origin))
            )
        elif kind == "GearJoint" and normal:
            radii = (joint.number("radiusI"), joint.number("radiusJ"))
            self.sketch.joints.append(Gears(name, i.part, j.part, (self._flat(i.origin), self._flat(j.origin)), radii))
        elif not (kind in IDLE and normal):
            raise UserError(f"{kind} {name} cannot be expressed in the plane of the pins")

    def _slide(self, name: str, order: tuple[_Marker, _Marker], axis: np.ndarray) -> None:
        first, second = order
        self.sketch.joints.append(
            Slide(
                name,
                first.part,
                second.part,
                self._flat(second.origin),
                self._angle(axis),
                along=self._flat(first.origin),
            )
        )

    def _motions(self, constraints: Entry | None) -> list[Entry]:
        motions = constraints.named("Motions") if constraints else None
        return motions.below if motions else []

    def _motion(self, motion: Entry) -> None:
        name = motion.text("Name")
        joint_path = motion.text("MotionJoint")
        joint = next(
            (candidate for candidate in self.joints if f"{self.path}/{candidate.text('Name')}" == joint_path), None
        )
        if motion.word != "RotationalMotion" or joint is None:
            self.sketch.left_out.append(f"{motion.word} {name}; m.drive_coordinate says a motion along a line")
            return
        i, j = self._ends(joint)
        sign = 1.0 if i.axes[:, 2] @ self.plane[2] > 0 else -1.0
        law = as_law(motion.text("RotationZ"), f"{motion.word} {name}")
        # The angle of marker j against marker i about i's z axis; the bodies' axes stand off from these.
        offset = self._own(j) - self._own(i)
        first, second, sense = (i.part, j.part, 1.0) if j.part != GROUND else (j.part, i.part, -1.0)
        start = sense * (sign * law.at_zero - offset)
        if law.rate is not None:
            self.sketch.motors.append(Motor(name, first, second, sense * sign * law.rate, start))
        else:
            self.sketch.motors.append(Motor(name, first, second, 0.0, start, law.from_zero(sense * sign)))

    def _own(self, marker: _Marker) -> float:
        """Return the angle of a marker's x axis in the axes of its part."""
        x = self._angle(marker.axes[:, 0])
        if marker.part == GROUND:
            return x
        return x - (self.sketch.links[marker.part].angle or 0.0)


def _taken(kind: str) -> int:
    """Return the degrees of freedom that a joint of the file removes in the plane."""
    return 0 if kind in IDLE else 1 if kind == "GearJoint" else ROWS.get(kind, 2)
