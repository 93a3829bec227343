"""Markers given where they are in the world at the start: ``body.at_world(x, y, angle)``.

The place is taken into the body's own frame at once, by the pose that the body has at the start (time 0) of the model
as it then is: its joints and drivers closed, what start_near gives held, as a simulation begins. From then on it is a
marker as any other. The pose must be known: joints, drivers and start_near leave the body no freedom,

    J and the rows of what start_near gives:   no vector of their null space moves the body

Where the model's start is another one in the end, because start_near or joints came later, the first solution warns.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from mbsd.base.errors import MechanismError, ModelError
from mbsd.model.body import Body, Marker

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed
    from mbsd.model.mechanism import Model

MOVES = 1e-7
"""Share of a body's coordinate in a unit vector of the null space."""
ELSEWHERE = 1e-6
"""A start this far (in sizes, rad) from where a marker was put is another one."""


def marker_in_world(m: Model, body: Body, x: float, y: float, angle: float) -> Marker:
    """See :meth:`mbsd.model.body.Body.at_world`."""
    if m.bodies.get(body.name) is not body:
        raise ModelError(f"{body.owner}: {body.name}.at_world: '{body.name}' belongs to no mechanism; use m.body(...)")
    if body is m.ground:
        return Marker(body, x, y, angle)
    marker = _inside(body, _known_frame(_around(m, body), body.name), x, y, angle)
    m.world_markers = (*m.world_markers, (marker, (x, y, angle)))
    return marker


def moved_markers(m: Model) -> Iterator[tuple[Marker, tuple[float, float, float], tuple[float, float]]]:
    """Yield markers of at_world that start elsewhere: their given place (m, m, rad) and their start (m)."""
    joined = [joint for part in (m.joints, m.drivers, m.forces, m.contacts) for joint in part.values()]
    used = {id(marker) for joint in joined for marker in (joint.i, joint.j)} | {
        id(marker) for marker in m.traces.values()
    }
    markers = [(marker, given) for marker, given in m.world_markers if id(marker) in used]
    if not markers:
        return
    from mbsd.arrays.packing import pack

    try:
        packed = pack(m)  # pyright: ignore[reportArgumentType]
        frames = _frames(packed, _start(m, packed))  # pyright: ignore[reportArgumentType]
    except MechanismError:
        return  # whoever solves it says why
    for marker, (x, y, angle) in markers:
        x0, y0, theta = frames[packed.body_names.index(marker.body.name)]
        c, s = math.cos(theta), math.sin(theta)
        place = x0 + c * marker.x - s * marker.y, y0 + s * marker.x + c * marker.y
        off = math.hypot(place[0] - x, place[1] - y) / packed.size
        turned = abs(math.remainder(theta + marker.angle - angle, 2 * math.pi))
        if max(off, turned) > ELSEWHERE:
            yield marker, (x, y, angle), place


def _around(m: Model, body: Body) -> Model:
    """Return the part of a mechanism that joints and drivers connect with a body other than by ground."""
    from mbsd.arrays.starts import copied

    links = [(joint.i.body.name, joint.j.body.name) for joint in (*m.joints.values(), *m.drivers.values())]
    near: dict[str, set[str]] = {}
    for first, second in links:
        if "ground" not in (first, second):
            near.setdefault(first, set()).add(second)
            near.setdefault(second, set()).add(first)
    reached, queue = {body.name}, [body.name]
    while queue:
        new = near.get(queue.pop(), set()) - reached
        reached |= new
        queue += new
    out = copied(m)  # pyright: ignore[reportArgumentType]
    kept = reached | {"ground"}
    out.bodies = {name: kept_body for name, kept_body in m.bodies.items() if name in kept}
    out.starts = {name: start for name, start in m.starts.items() if name in kept}
    for part in ("joints", "drivers"):
        ends = {name: {joint.i.body.name, joint.j.body.name} for name, joint in getattr(m, part).items()}
        setattr(out, part, {name: joint for name, joint in getattr(m, part).items() if ends[name] & reached})
    out.forces, out.contacts, out.events, out.traces, out.velocities = {}, {}, {}, {}, {}
    return out


def _start(m: Model, packed: Packed) -> np.ndarray:
    """Return (3 nb,) the closed pose at time 0, with what start_near gives held where the joints leave it."""
    from mbsd.equations.assembly import residual_and_jacobian
    from mbsd.kinematics.pose.close import CLOSED, rough_pose, unwind_angles
    from mbsd.kinematics.pose.ideal_joints import with_ideal_joints
    from mbsd.kinematics.pose.initial import start_pose
    from mbsd.kinematics.pose.phases import let_phases_go

    drive = packed.drives(np.zeros(1))[0]
    rough = rough_pose(m, packed, drive, 0)
    unwind_angles(packed, rough)
    let_phases_go(packed)
    residual_and_jacobian(packed.system, rough, drive, packed.ws)
    if (
        all(joint.params.get("phase") is None for joint in packed.joints)
        and np.abs(packed.ws.phi * packed.row_scale()).max(initial=0.0) <= CLOSED
        and with_ideal_joints(m) is None
    ):
        return rough  # as drawn: nothing to close
    return start_pose(m, packed, 0.0, drive)[0]


def _frames(packed: Packed, q: np.ndarray) -> np.ndarray:
    """Return (nb, 3) place (m) and angle (rad) of the bodies' own frames in pose q (3 nb,)."""
    out = q.reshape(-1, 3).copy()
    c, s = np.cos(out[:, 2]), np.sin(out[:, 2])
    x, y = packed.com.T
    out[:, 0] -= c * x - s * y
    out[:, 1] -= s * x + c * y
    return out


def _inside(body: Body, frame: np.ndarray, x: float, y: float, angle: float) -> Marker:
    """Return the marker at (x, y, angle) of the world on a body whose frame stands there."""
    c, s = math.cos(frame[2]), math.sin(frame[2])
    dx, dy = x - frame[0], y - frame[1]
    return Marker(body, float(c * dx + s * dy), float(c * dy - s * dx), float(angle - frame[2]))


def _known_frame(m: Model, name: str) -> np.ndarray:
    """Return (3,) of a body's frame at the start.

    Raises ModelError if it is unknown, AssemblyError if nothing closes.
    """
    from mbsd.arrays.packing import pack

    packed = pack(m)
    q = _start(m, packed)
    b = packed.body_names.index(name)
    start = m.starts.get(name)
    if start is None or start.place is None:
        free = _free(m, packed, q, b)
        if free:
            say = f"start_near({name}=degrees)" if free == ["angle"] else f"start_near({name}=(x, y, degrees))"
            verb = "is" if len(free) == 1 else "are"
            raise ModelError(
                f"{m.name}: {name}.at_world: the start of '{name}' is not known yet: its {' and '.join(free)} "
                f"{verb} free. First give {say}, or add the joints, drivers and starts that place it"
            )
    return _frames(packed, q)[b]


def _free(m: Model, packed: Packed, q: np.ndarray, b: int) -> list[str]:
    """Return what neither joints and drivers nor start_near tell of body b in the pose q (3 nb,)."""
    from mbsd.equations.assembly import residual_and_jacobian
    from mbsd.kinematics.pose.close import given_coordinates

    residual_and_jacobian(packed.system, q, packed.drives(np.zeros(1))[0], packed.ws)
    rows = packed.jacobian() * packed.row_scale()[:, None] * packed.column_scale()
    given = [c for c, _value in given_coordinates(m, packed)]
    units = np.zeros((len(given), packed.coordinates))
    units[np.arange(len(given)), np.array(given, int) - 3] = 1.0
    _u, size, basis = np.linalg.svd(np.vstack([rows, units]))
    rank = int((size > MOVES * max(size.max(initial=0.0), 1e-300)).sum())
    # (k, 3); the frame's origin rather than the centre of mass
    moves = basis[rank:, 3 * (b - 1) : 3 * b].copy()
    c, s = math.cos(q[3 * b + 2]), math.sin(q[3 * b + 2])
    x, y = packed.com[b] / packed.size
    moves[:, 0] += moves[:, 2] * (s * x + c * y)
    moves[:, 1] -= moves[:, 2] * (c * x - s * y)
    loose = np.abs(moves).max(axis=0, initial=0.0) > MOVES
    return ["place"] * bool(loose[:2].any()) + ["angle"] * bool(loose[2])
