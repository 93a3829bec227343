"""Names in, arrays out: a Model as the System the kernels read.

Authors place a body's frame where it is convenient; here alone it is shifted to the centre of mass.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from mbsd.arrays.relative import Specials
from mbsd.arrays.system_arrays import Parts, arrays_of
from mbsd.base.users_function import law_of, tell_missed
from mbsd.equations.products import spread_rows
from mbsd.equations.system import System, Workspace
from mbsd.model.force import Force, Masses
from mbsd.model.joint import ROWS, SPECIALS, ContactKind, Joint
from mbsd.model.laws import Motion
from mbsd.model.mechanism import Model


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
    """How many of the joints are contacts."""
    specials: Specials
    """Constraints of relative pose by name, and the user's functions among them."""
    size: float
    """Characteristic length (m): the largest distance between joints, or joint and centre of mass, of one body."""
    constant: tuple[bytes, ...] | None
    """What ``numbers`` has of all but the angle offsets."""
    phases: dict[str, float] = field(default_factory=dict)
    """Constants of meshes with play (m) by the names of their forces; see mbsd/arrays/force_phases.py."""
    states: int = 0
    """How many of the last bodies hold states of forces; see mbsd/arrays/states.py."""
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
        """Contacts by name, and the rows of their gaps; rows that hold joints at rest are none."""
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
        """The joint that owns a row of J."""
        return self.joints[int(np.searchsorted(self.first_row, row, side="right")) - 1]

    def rows_of(self, joint: str | int) -> range:
        """Return the rows of J of a joint, driver or contact, by its name or its place in ``joints``."""
        k = [each.name for each in self.joints].index(joint) if isinstance(joint, str) else joint
        return range(int(self.first_row[k]), int(self.first_row[k + 1]))

    def motion_of(self, number: int) -> int:
        """The motion of a joint or driver by its place in ``joints``; 0 for joints."""
        return max(0, number + 1 - (len(self.joints) - len(self.motions)))

    def drives(self, times: np.ndarray) -> np.ndarray:
        """(T, motions + 1, 3) values, rates and accelerations of all laws; index 0 is zero."""
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
        """(m,) what makes residual rows dimensionless: 1 / size for lengths, 1 for angles."""
        scale = np.full(int(self.first_row[-1]), 1.0 / self.size)
        scale[self.system.angle[:, 2]] = 1.0
        scale[self.specials.angular_rows] = 1.0
        return scale

    def column_scale(self) -> np.ndarray:
        """(n,) size of a unit step of each coordinate: ``size`` for x and y, 1 for theta."""
        scale = np.ones((len(self.body_names) - 1, 3))
        scale[:, :2] = self.size
        return scale.ravel()

    def jacobian(self) -> np.ndarray:
        """(m, n) of the last evaluation, ground's columns left out."""
        return self.spread(self.ws.jac)

    def spread(self, compact: np.ndarray) -> np.ndarray:
        """Compact Jacobians (..., m, 6) as matrices (..., m, n), ground's columns left out."""
        out = np.zeros((*compact.shape[:-1], self.coordinates + 3))
        shape = math.prod(compact.shape[:-2]), compact.shape[-2]
        whole = np.ascontiguousarray(compact, float).reshape(*shape, 6)
        spread_rows(self.system.row_body, whole, out.reshape(*shape, self.coordinates + 3))
        return out[..., 3:]


def pack(m: Model, contacts: Sequence[Joint] = ()) -> Packed:
    """Build the arrays of a mechanism, with rows for ``contacts`` after all others."""
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
