"""Names in, arrays out: a Model as the System the kernels read.

Authors place a body's frame where it is convenient; here alone it is shifted to the centre of mass. Arrays of a small
mechanism are kept for the next solve.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from mbsd.arrays.relative import Specials
from mbsd.base.arguments import law_of, tell_missed
from mbsd.base.running import Kept
from mbsd.equations.products import spread_rows
from mbsd.equations.system import System, Workspace, constant_system, workspace
from mbsd.model.force import Force, Masses
from mbsd.model.joint import ROWS, SPECIALS, ContactKind, Joint
from mbsd.model.joints.ratios import refuse_contradictions
from mbsd.model.laws import Motion
from mbsd.model.mechanism import Model

MOST_KEPT = 60
"""Coordinates of mechanisms whose arrays and start are kept for the next solution."""
SMALLEST_SIZE = 1e-12
"""Size (m) below which all joints sit at the centres of mass, and 1 m serves as size."""


class Arrays(NamedTuple):
    """The arrays of a mechanism; see mbsd.arrays.packing.Packed."""

    system: System
    ws: Workspace
    com: np.ndarray
    first_row: np.ndarray
    markers: np.ndarray
    force_markers: np.ndarray
    size: float
    constant: tuple[bytes, ...] | None


@dataclass(frozen=True)
class Parts:
    """The parts of a model that the arrays are made of."""

    numbers: list[float]
    """Gravity; mass, inertia and com of each body; x, y and angle of each marker; offsets, lengths, extents."""
    bodies: int
    marker_body: tuple[int, ...]
    offsets: int
    lengths: int
    first_row: tuple[int, ...]
    tables: tuple[tuple[str, tuple[tuple[int, int, int, int], ...]], ...]
    """Constraints of each kind: markers i and j, row, motion."""


_ARRAYS: Kept[Arrays] = Kept()


def arrays_of(parts: Parts, specials: Specials, forces: int) -> Arrays:
    """Return arrays whose scratch is the caller's own; the others are shared."""
    numbers = np.array(parts.numbers, float)
    if specials.names or 3 * (parts.bodies - 1) > MOST_KEPT:
        return _build_arrays(parts, numbers, specials, forces)
    own = parts.bodies, parts.marker_body, parts.offsets, parts.lengths, parts.first_row, parts.tables, forces
    kept = _ARRAYS.get((numbers.tobytes(), *own), lambda: _build_arrays(parts, numbers, specials, forces))
    return kept._replace(ws=Workspace(*[part.copy() for part in kept.ws]))


def _build_arrays(parts: Parts, numbers: np.ndarray, specials: Specials, forces: int) -> Arrays:
    body_end = 2 + 4 * parts.bodies
    marker_end = body_end + 3 * len(parts.marker_body)
    body = numbers[2:body_end].reshape(-1, 4)
    marker = numbers[body_end:marker_end].reshape(-1, 3)
    offsets, lengths, extents = np.split(numbers[marker_end:], np.cumsum([parts.offsets, parts.lengths]))
    com = body[:, 2:].copy()
    marker_body, first_row = np.array(parts.marker_body, np.int64), np.array(parts.first_row, np.int64)
    joints = len(first_row) - 1
    markers = np.arange(2 * joints).reshape(-1, 2)
    force_markers = 2 * joints + np.arange(2 * forces).reshape(-1, 2)
    as_table = {name: np.array(rows, np.int64).reshape(-1, 4) for name, rows in parts.tables}
    marker_arm = marker[:, :2] - com[marker_body]
    size = _size(marker_arm, marker_body, [*lengths, *extents])
    special, addresses, special_numbers = specials.arrays(marker_body, size)
    system = System(
        mass=body[:, 0].copy(),
        inertia=body[:, 1].copy(),
        gravity=numbers[:2].copy(),
        marker_body=marker_body,
        marker_arm=marker_arm,
        marker_axis=np.stack([np.cos(marker[:, 2]), np.sin(marker[:, 2])], axis=1),
        moving=np.flatnonzero(marker_body),
        directed=_directed(
            marker_body, as_table["slot"][:, 0], as_table["along"][:, 0], special[:, 0], force_markers[:, 0]
        ),
        special=special,
        address=addresses,
        numbers=special_numbers,
        row_body=marker_body[np.repeat(markers, np.diff(first_row), axis=0)],
        driven=_driven(*as_table.values(), special),
        angle_offset=offsets.copy(),
        distance_length=lengths.copy(),
        **as_table,
    )
    system = constant_system(*system)
    own = None
    if not len(special) and 3 * (parts.bodies - 1) <= MOST_KEPT:
        fixed = [part.tobytes() for name, part in system._asdict().items() if name != "angle_offset"]
        own = (*fixed, com.tobytes(), np.float64(size).tobytes())
    ws = workspace(system, parts.first_row[-1])
    return Arrays(system, ws, com, first_row, markers, force_markers, size, own)


def _driven(*tables: np.ndarray) -> np.ndarray:
    """Return (drivers, 2) row and motion of the driven rows."""
    rows = np.concatenate([table[:, 2:4] for table in tables])
    return rows[rows[:, 1] > 0]


def _directed(marker_body: np.ndarray, *first_markers: np.ndarray) -> np.ndarray:
    """Return first markers of slots, coordinates, relative poses and forces that are on moving bodies."""
    first = np.concatenate(first_markers)
    return np.unique(first[marker_body[first] > 0])


def _size(marker_arm: np.ndarray, marker_body: np.ndarray, lengths: list[float]) -> float:
    extents = [*lengths, *np.hypot(*marker_arm[marker_body > 0].T)]  # how far away the world's origin is says nothing
    for body in np.unique(marker_body):
        extents.append(float(np.linalg.norm(np.ptp(marker_arm[marker_body == body], axis=0))))
    largest = float(max(extents, default=0.0))
    return largest if largest > SMALLEST_SIZE else 1.0


@dataclass
class Packed:
    """A mechanism as arrays, and where its names are in them."""

    name: str
    body_names: list[str]
    com: np.ndarray
    """(nb, 2) in the author's frames (m)."""
    system: System
    """Closing the start puts another one in its place."""
    ws: Workspace
    joints: list[Joint]
    """Joints, then drivers, then contacts if they were packed."""
    first_row: np.ndarray
    """(joints + 1,) of each joint in J."""
    markers: np.ndarray
    """(joints, 2) marker numbers i, j."""
    forces: list[Force]
    force_markers: np.ndarray
    """(forces, 2) marker numbers i, j."""
    motions: list[Motion]
    """Motions of the drivers, in order; motion k of the tables is ``motions[k - 1]``."""
    contacts: int
    """Number of the joints that are contacts."""
    specials: Specials
    """Constraints of relative pose by name, and the user's functions among them."""
    size: float
    """Characteristic length (m): the largest distance between joints, or joint and centre of mass, of one body."""
    constant: tuple[bytes, ...] | None
    """The bytes of ``numbers`` but for the angle offsets."""
    phases: dict[str, float] = field(default_factory=dict)
    """Constants of meshes with play (m) by the names of their forces; see mbsd/arrays/starts.py."""
    states: int = 0
    """Number of the last bodies that hold states of forces; see mbsd/arrays/states.py."""
    bars: dict[str, float] = field(default_factory=dict)
    """Lengths of the bars by their names (m)."""

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restore a pickle or copy: user equations and functions get their addresses in this process."""
        self.__dict__.update(state)
        self.system = self.specials.connected(self.system, self.size)

    @property
    def masses(self) -> Masses:
        """Masses of the bodies, ground included."""
        end = len(self.body_names) - self.states
        mass, inertia = self.system.mass[:end], self.system.inertia[:end]
        return Masses(self.body_names[:end], self.com[:end], mass, inertia, self.joints, self.name, self.size)

    @property
    def coordinates(self) -> int:
        """Unknowns: three per moving body."""
        return 3 * (len(self.body_names) - 1)

    @property
    def driver_rows(self) -> int:
        """The first row that belongs to a driver."""
        return int(self.first_row[len(self.joints) - self.contacts - len(self.motions)])

    @property
    def contact_rows(self) -> int:
        """The first row that belongs to a contact: all before hold always."""
        return int(self.first_row[len(self.joints) - self.contacts])

    def numbers(self) -> tuple[bytes, ...] | None:
        """Return the system by its numbers; None if it is large or has relative poses.

        These have functions of the user and phases.
        """
        return None if self.constant is None else (*self.constant, self.system.angle_offset.tobytes())

    def contact_gaps(self) -> dict[str, int]:
        """Return contacts by name, and the rows of their gaps; rows that hold joints at rest are none."""
        places = range(len(self.joints) - self.contacts, len(self.joints))
        return {
            self.joints[k].name: int(self.first_row[k]) for k in places if isinstance(self.joints[k].kind, ContactKind)
        }

    def holds_position(self) -> np.ndarray:
        """Return (m,) True for the rows of J that hold a position.

        A row that sticks by friction, and that of a locked one-way clutch, hold a speed of 0.
        """
        out = np.ones(len(self.ws.phi), bool)
        out[self.contact_rows :] = False
        for joint, row in zip(self.joints, self.first_row, strict=False):
            if isinstance(joint.kind, ContactKind) and not joint.kind.always_closed:
                out[row] = True
        return out

    def joint_of_row(self, row: int) -> Joint:
        """Return the joint that owns a row of J."""
        return self.joints[int(np.searchsorted(self.first_row, row, side="right")) - 1]

    def rows_of(self, joint: str | int) -> range:
        """Return the rows of J of a joint, driver or contact, by its name or its place in ``joints``."""
        k = [each.name for each in self.joints].index(joint) if isinstance(joint, str) else joint
        return range(int(self.first_row[k]), int(self.first_row[k + 1]))

    def motion_of(self, number: int) -> int:
        """Return the motion of a joint or driver by its place in ``joints``; 0 for joints."""
        return max(0, number + 1 - (len(self.joints) - len(self.motions)))

    def drives(self, times: np.ndarray) -> np.ndarray:
        """Return (T, motions + 1, 3) values, rates and accelerations of all laws; index 0 is zero."""
        out = np.zeros((len(times), len(self.motions) + 1, 3))
        for k, motion in enumerate(self.motions):
            with law_of(f"{self.name}: driver '{self.driver_names[k]}'"):
                out[:, k + 1] = motion(times)
        return out

    @property
    def drivers(self) -> list[Joint]:
        """Drivers in the order of ``motions``."""
        end = len(self.joints) - self.contacts
        return self.joints[end - len(self.motions) : end]

    @property
    def driver_names(self) -> list[str]:
        """Names of the drivers in the order of ``motions``."""
        return [driver.name for driver in self.drivers]

    @property
    def passive_joints(self) -> list[Joint]:
        """Joints that are neither drivers nor contacts; they come first."""
        return self.joints[: len(self.joints) - self.contacts - len(self.motions)]

    def markers_of(self, force: Force) -> tuple[int, int]:
        """Return the numbers of the markers i and j of a force."""
        i, j = self.force_markers[self.forces.index(force)].tolist()
        return i, j

    def settle_laws(self, start: float, end: float) -> None:
        """Prepare the laws of the drivers for ``start`` .. ``end`` (s). Raises ModelError naming the driver."""
        for k, (name, law) in enumerate(zip(self.driver_names, self.motions, strict=True)):
            with law_of(f"{self.name}: driver '{name}'"):
                self.motions[k] = law.over(start, end)
            tell_missed(f"{self.name}: driver '{name}'", self.motions[k])

    def row_scale(self) -> np.ndarray:
        """Return (m,) what makes residual rows dimensionless: 1 / size for lengths, 1 for angles."""
        scale = np.full(int(self.first_row[-1]), 1.0 / self.size)
        scale[self.system.angle[:, 2]] = 1.0
        scale[self.specials.angular_rows] = 1.0
        return scale

    def column_scale(self) -> np.ndarray:
        """Return (n,) size of a unit step of each coordinate: ``size`` for x and y, 1 for theta."""
        scale = np.ones((len(self.body_names) - 1, 3))
        scale[:, :2] = self.size
        return scale.ravel()

    def jacobian(self) -> np.ndarray:
        """Return (m, n) of the last evaluation, ground's columns left out."""
        return self.spread(self.ws.jac)

    def spread(self, compact: np.ndarray) -> np.ndarray:
        """Return compact Jacobians (..., m, 6) as matrices (..., m, n), ground's columns left out."""
        out = np.zeros((*compact.shape[:-1], self.coordinates + 3))
        shape = math.prod(compact.shape[:-2]), compact.shape[-2]
        whole = np.ascontiguousarray(compact, float).reshape(*shape, 6)
        spread_rows(self.system.row_body, whole, out.reshape(*shape, self.coordinates + 3))
        return out[..., 3:]


def pack(m: Model, contacts: Sequence[Joint] = ()) -> Packed:
    """Build the arrays of a mechanism, with rows for ``contacts`` after all others."""
    refuse_contradictions(m)
    bodies = list(m.bodies.values())
    number = {body.name: k for k, body in enumerate(bodies)}
    joints = [*m.joints.values(), *m.drivers.values(), *contacts]
    motions: list[Motion] = []
    tables: dict[str, list[tuple[int, int, int, int]]] = {name: [] for name in ROWS if name not in SPECIALS}
    specials = Specials(m.name)
    offsets: list[float] = []
    lengths: list[float] = []
    extents: list[float] = []
    first_row = [0]
    for k, joint in enumerate(joints):
        i, j = 2 * k, 2 * k + 1
        motion = 0
        if joint.motion is not None:
            motions.append(joint.motion)
            motion = len(motions)
        row = first_row[-1]
        for constraint in joint.kind.constraints:
            if constraint in SPECIALS:
                specials.add(constraint, joint, (i, j, row, motion))
            else:
                tables[constraint].append((i, j, row, motion))
            row += ROWS[constraint]
            if constraint == "angle":
                offsets.append(joint.i.angle - joint.j.angle)
            if constraint == "distance":
                lengths.append(joint.params.get("length", 0.0))  # a driver imposes all of it
        extents += joint.kind.extents(joint.params)
        first_row.append(row)
    forces = list(m.forces.values())
    markers = [marker for part in (*joints, *forces) for marker in (part.i, part.j)]
    parts = Parts(
        numbers=[
            *(m.gravity or (0.0, 0.0)),
            *(number for body in bodies for number in (body.mass, body.inertia, *body.com)),
            *(number for marker in markers for number in (marker.x, marker.y, marker.angle)),
            *offsets,
            *lengths,
            *extents,
        ],
        bodies=len(bodies),
        marker_body=tuple([number[marker.body.name] for marker in markers]),
        offsets=len(offsets),
        lengths=len(lengths),
        first_row=tuple(first_row),
        tables=tuple([(name, tuple(rows)) for name, rows in tables.items()]),
    )
    arrays = arrays_of(parts, specials, len(forces))
    return Packed(
        name=m.name,
        body_names=[body.name for body in bodies],
        com=arrays.com,
        system=arrays.system,
        ws=arrays.ws,
        joints=joints,
        first_row=arrays.first_row,
        markers=arrays.markers,
        forces=forces,
        force_markers=arrays.force_markers,
        motions=motions,
        contacts=len(contacts),
        specials=specials,
        size=arrays.size,
        constant=arrays.constant,
        bars={body.name: body.length for body in bodies if body.length is not None},
    )
