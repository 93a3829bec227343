"""Consistent initial conditions: a closed pose and allowed velocities near the given ones.

Pose: what ``start_near`` gives is held exactly as far as the joints leave it free, first given first held; the rest
moves until everything closes. A place of which they leave one direction is as near as it can be, see held_values.py.
Velocities: what ``start_moving`` gives is held likewise,

    J v = nu,   P v = given,   kinetic energy of what was left open as small as it can be.

What could not be kept is reported.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from mbsd.arrays.inertias import inertia_of, least_energy, usual_inertia
from mbsd.arrays.packing import Packed
from mbsd.arrays.starts import take_force_phases
from mbsd.base.running import Kept
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics.pose.close import assemble, close, close_holding, start_targets
from mbsd.kinematics.pose.held_values import held_values
from mbsd.kinematics.pose.ideal_joints import closed_ideally
from mbsd.kinematics.pose.phases import let_phases_go, refuse_impossible, take_phases
from mbsd.model.mechanism import Model

TOLD = 1e-6
"""The smallest change of a given value that is reported: sizes, rad; of speeds relative to the given ones."""
COORDINATES = ("x", "y", "angle")


@dataclass(frozen=True)
class Initial:
    """Consistent conditions and what had to be changed for them."""

    q: np.ndarray
    """(3 nb,) centres of mass (m) and angles (rad)."""
    v: np.ndarray
    """(3 nb,) m/s, rad/s."""
    poses: tuple[str, ...]
    """One sentence for each start_near value that was moved to close the links."""
    velocities: tuple[str, ...]
    """One sentence for each start_moving value that the joints forbid."""


_CONSISTENT: Kept[tuple[Initial, np.ndarray]] = Kept()
"""Initial conditions, and the angle offsets that go with them."""


def consistent(m: Model, packed: Packed, time: float) -> Initial:
    """Return initial conditions at ``time`` (s). Raises AssemblyError where the links cannot be closed."""
    initial, joined = closed_ideally(m, packed, lambda own, whole: _consistent(own, whole, time))
    if joined:
        initial = _driven(m, packed, drive_at(packed, time), initial)
    take_force_phases(packed, initial.q)
    return initial


def drive_at(packed: Packed, time: float) -> np.ndarray:
    """Return (motions + 1, 3) what drivers impose at ``time`` (s)."""
    return packed.drives(np.array([time]))[0]


def _driven(m: Model, packed: Packed, drive: np.ndarray, initial: Initial) -> Initial:
    """Return velocities of the mechanism whose drivers move both sides of a play unlike the joint."""
    residual_and_jacobian(packed.system, initial.q, drive, packed.ws)
    nu = np.zeros(len(packed.ws.phi))
    nu[packed.driver_rows :] = drive[1:, 1]
    jac = packed.jacobian()
    size = np.abs(initial.v[3:] / packed.column_scale()).max(initial=0.0)  # sizes/s, rad/s
    if np.abs((jac @ initial.v[3:] - nu) * packed.row_scale()).max(initial=0.0) <= TOLD * size:
        return initial
    v, slips = _velocities(m, packed, initial.q, drive)
    return replace(initial, v=v, velocities=tuple(slips))


def _consistent(m: Model, packed: Packed, time: float) -> Initial:
    """Return initial conditions of a mechanism whose joints all hold."""
    drive = packed.drives(np.array([time]))[0]

    def started() -> tuple[Initial, np.ndarray]:
        q, deviations = start_pose(m, packed, time, drive)
        v, slips = _velocities(m, packed, q, drive)
        return Initial(q, v, tuple(deviations), tuple(slips)), packed.system.angle_offset

    numbers = packed.numbers()
    if numbers is None:
        return started()[0]
    given = repr(m.starts), repr(m.velocities), drive.tobytes(), inertia_of(packed).tobytes()
    initial, offsets = _CONSISTENT.get((*numbers, tuple(packed.body_names), *given), started)
    if offsets is not packed.system.angle_offset:
        packed.system = packed.system.changed(angle_offset=offsets)
    return replace(initial, q=initial.q.copy(), v=initial.v.copy())


def start_pose(m: Model, packed: Packed, time: float, drive: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Return a (3 nb,) closed pose that holds start_near where joints allow, and sentences if not.

    drive (motions + 1, 3) at ``time`` (s). Raises AssemblyError.
    """
    (q, deviations), joined = closed_ideally(m, packed, lambda own, whole: _start_pose(own, whole, time, drive))
    if joined:
        take_force_phases(packed, q)
    return q, deviations


def _start_pose(m: Model, packed: Packed, time: float, drive: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """Return the closed pose and sentences for a mechanism whose joints all hold."""
    q = assemble(m, packed, time)
    if not m.starts:
        return q, []
    let_phases_go(packed)
    q = close_holding(m, packed, q, drive)
    wanted, targets = start_targets(m, packed, q)
    if take_phases(packed, q, drive):
        q = close(packed, q, drive)[0]
    refuse_impossible(packed, q)
    return q, tell_coordinates(packed, q, list(zip(wanted, targets, strict=True)))


def tell_coordinates(packed: Packed, q: np.ndarray, given: list[tuple[int, float]]) -> list[str]:
    """Return a sentence for each given (coordinate, value) that the pose q (3 nb,) does not hold."""
    size = np.concatenate([np.ones(3), packed.column_scale()])
    deviations = []
    for c, target in given:
        gap = q[c] - target
        if abs(gap) / size[c] > TOLD:
            body, what = packed.body_names[c // 3], COORDINATES[c % 3]
            if c % 3 == 2:
                deviations.append(
                    f"the angle of '{body}' is {math.degrees(q[c]):.6g} degrees, not {math.degrees(target):.6g}"
                )
            else:
                deviations.append(f"the {what} of the centre of mass of '{body}' is {q[c]:.6g} m, not {target:.6g}")
    return deviations


def _velocities(m: Model, packed: Packed, q: np.ndarray, drive: np.ndarray) -> tuple[np.ndarray, list[str]]:
    residual_and_jacobian(packed.system, q, drive, packed.ws)
    scale = packed.row_scale()
    jac = packed.jacobian() * scale[:, None]
    nu = np.zeros(len(scale))
    nu[packed.driver_rows :] = drive[1:, 1]
    v = np.zeros(len(q))
    if not m.velocities and not nu.any():
        return v, []
    given, values, names = given_velocities(m, packed, q)
    rows = _as_matrix(given, packed.coordinates)
    column_scale = packed.column_scale()
    kept, held = held_values(jac * column_scale, rows * column_scale, velocity_places(m))
    everything = np.vstack([jac[kept], held @ rows])
    wanted = np.concatenate([(nu * scale)[kept], held @ values])
    root = np.sqrt(1.0 / usual_inertia(packed)[3:])
    v[3:] = root * np.linalg.lstsq(everything * root, wanted, rcond=1e-13)[0]
    inertia = inertia_of(packed)[3:]
    if not inertia.all():
        v[3:] = least_energy(v[3:], everything, inertia, column_scale)
    fastest = max(float(np.abs(values).max(initial=0.0)), float(np.abs(nu).max(initial=0.0)), 1e-300)
    deviations = [
        f"{name} is {row @ v[3:]:.6g} {unit}, not {value:.6g}"
        for row, value, (name, unit) in zip(rows, values, names, strict=True)
        if abs(row @ v[3:] - value) > TOLD * fastest
    ]
    return v, deviations


def given_velocities(
    m: Model, packed: Packed, q: np.ndarray
) -> tuple[list[dict[int, float]], np.ndarray, list[tuple[str, str]]]:
    """Return rows {coordinate: factor}, values (k,), names and units of start_moving, in its order.

    The velocity is that of a body's frame, not of its centre of mass.
    """
    rows: list[dict[int, float]] = []
    values, names = [], []
    number = {name: b for b, name in enumerate(packed.body_names)}
    for name, velocity in m.velocities.items():
        b = number[name]
        c, s = math.cos(q[3 * b + 2]), math.sin(q[3 * b + 2])
        x, y = packed.com[b]
        rows.append({3 * b + 2: 1.0})
        values.append(velocity.omega)
        names.append((f"the angular velocity of '{name}'", "rad/s"))
        if velocity.place is None:
            continue
        rows += [{3 * b: 1.0, 3 * b + 2: s * x + c * y}, {3 * b + 1: 1.0, 3 * b + 2: -(c * x - s * y)}]
        values += velocity.place
        names += [(f"vx of '{name}'", "m/s"), (f"vy of '{name}'", "m/s")]
    return rows, np.array(values, float), names


def velocity_places(m: Model) -> list[tuple[int, int]]:
    """Return the pairs vx, vy among the rows of :func:`given_velocities`."""
    pairs, k = list[tuple[int, int]](), 0
    for velocity in m.velocities.values():
        k += 1
        if velocity.place is not None:
            pairs.append((k, k + 1))
            k += 2
    return pairs


def _as_matrix(rows: list[dict[int, float]], coordinates: int) -> np.ndarray:
    out = np.zeros((len(rows), coordinates))
    for k, row in enumerate(rows):
        for c, factor in row.items():
            out[k, c - 3] = factor
    return out
