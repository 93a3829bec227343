"""Velocities at the start of a simulation: given ones are held as far as joints and drivers allow.

J v = nu,   P v = given,   kinetic energy of what was left open as small as it can be
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from mbsd.kinematics.pose.held_values import held_values
from mbsd.spatial.arrays.packing import Packed, pack, start_row
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rotation import rotation_matrix

REPORTED = 1e-6
"""Least change of a given value that is reported, relative to the largest."""


class StartVelocities(NamedTuple):
    """Velocities, and what had to be changed for them."""

    v: np.ndarray
    """(3 + 6 n,) w in the world."""
    changes: tuple[str, ...]
    """One sentence for each given value that joints and drivers forbid."""


def start_velocities(m: Model, packed: Packed, q: np.ndarray, drive: np.ndarray) -> StartVelocities:
    """Return velocities at the closed pose q (3 + 7 n,) and laws drive (drivers + 1, 3)."""
    v = np.zeros(packed.freedoms + 3)
    _, jac = packed.measured(q, drive)
    nu = np.zeros(len(jac))
    for row, law in packed.system.driven:
        nu[row] = drive[law, 1]
    if not m.velocities and not nu.any():
        return StartVelocities(v, ())
    rows, values, names = _given(m, q)
    scale, columns = packed.row_scale, packed.column_scale
    kept, held = held_values(jac * scale[:, None] * columns, rows * columns, ())
    matrix = np.vstack([jac[kept] * scale[kept, None], held @ rows])
    wanted = np.concatenate([(nu * scale)[kept], held @ values])
    root = np.repeat(1.0 / np.sqrt(np.maximum(packed.system.mass[1:], 1e-300)), 6)
    for b in range(1, len(packed.bodies)):  # about a mean moment: the least energy of what is open, nearly
        moment = float(packed.system.inertia[b].mean())
        root[6 * b - 3 : 6 * b] = 1.0 / np.sqrt(max(moment, 1e-300))
    v[3:] = root * np.linalg.lstsq(matrix * root, wanted, rcond=1e-13)[0]
    fastest = max(float(np.abs(values).max(initial=0.0)), 1e-300)
    changes = [
        f"{name} is {row @ v[3:]:.6g} {unit}, not {value:.6g}"
        for row, value, (name, unit) in zip(rows, values, names, strict=True)
        if abs(row @ v[3:] - value) > REPORTED * fastest
    ]
    return StartVelocities(v, tuple(changes))


def _given(m: Model, q: np.ndarray) -> tuple[np.ndarray, np.ndarray, list[tuple[str, str]]]:
    """Return rows (k, 6 n) of what start_moving gives, values (k,), names and units."""
    number = {name: b for b, name in enumerate(m.bodies)}
    width = 6 * (len(number) - 1)
    rows, values, names = [], [], []
    for name, value in m.velocities.items():
        if name in m.joints:
            joint = m.joints[name]
            whole = pack(m, [(joint, start_row(joint))])
            rows.append(whole.measured(q)[1][-1])
            values.append(value[0])
            names.append((f"the rate of '{name}'", "rad/s" if joint.kind.turns else "m/s"))
            continue
        b = number[name]
        turns = np.zeros((3, width))
        turns[:, 6 * b - 3 : 6 * b] = np.eye(3)
        names += [(f"v{axis} of '{name}'", "m/s") for axis in "xyz"[: len(value) - 3]]
        names += [(f"w{axis} of '{name}'", "rad/s") for axis in "xyz"]
        if len(value) > 3:  # of the frame: that of the centre of mass, and w x arm
            body = m.bodies[name]
            x, y, z = -rotation_matrix(q[7 * b - 1 : 7 * b + 3]) @ body.principal[1].T @ np.array(body.com)
            moves = np.zeros((3, width))
            moves[:, 6 * b - 6 : 6 * b - 3] = np.eye(3)
            moves[:, 6 * b - 3 : 6 * b] = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]]
            rows += [*moves]
        rows += [*turns]
        values += value
    return np.array(rows).reshape(-1, width), np.array(values), names
