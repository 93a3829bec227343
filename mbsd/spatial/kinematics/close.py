"""A closed pose at the start, from the design pose in short steps of drivers and given starts.

    1  joints close alone, drivers released
    2  what start_near gives goes from its value there to the value given, in steps
    3  drivers go from their values to those of their laws: at once after 2, else in steps

Each step is damped Gauss-Newton: the shortest change of pose, of limited length, halved until the residual falls.
"""

from __future__ import annotations

import math

import numpy as np

from mbsd.base.errors import AssemblyError
from mbsd.kinematics.pose.held_values import RANK_TOLERANCE, independent_rows
from mbsd.spatial.arrays.packing import Packed, moved, pack, start_row
from mbsd.spatial.model.mechanism import Model

CLOSED = 1e-10
"""Largest residual of a closed pose, in sizes and rad."""
LONGEST_STEP = 0.5
"""Longest step, in sizes and rad."""
STRIDE = 0.18
"""Step of a driver or a given start, in sizes and rad."""
MOST_STEPS = 4000
MOST_ITERATIONS = 60
EXACT = 1e-14
NEAREST_STEP = 0.2
"""Longest step, in sizes and rad, of a loop that does not close towards its least gap."""


def assemble(m: Model, packed: Packed, time: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the closed pose (3 + 7 n,) at ``time`` (s) and its counted turns. Raises AssemblyError."""
    drive = packed.drives(np.array([time]))[0]
    joints = np.arange(packed.driver_rows)
    packed.ws.guess[:] = 0.0
    q, _ = close(packed, packed.design, drive, joints)
    if m.starts:
        q = _held_start(m, packed, q)
        closed, worst = close(packed, q, drive)
        if worst <= CLOSED:
            return _counted(packed, closed, drive)
    q, worst = _driven(packed, q, drive)
    if worst > CLOSED:
        raise AssemblyError(why_open(packed, q, drive, time))
    return _counted(packed, q, drive)


def _counted(packed: Packed, q: np.ndarray, drive: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    packed.measured(q, drive)
    return q, packed.ws.turn.copy()


def _driven(packed: Packed, q: np.ndarray, drive: np.ndarray) -> tuple[np.ndarray, float]:
    """Return the pose that drivers lead to from q, and its residual in sizes and rad."""
    none = np.zeros_like(drive)
    phi, _ = packed.measured(q, none)
    known = none.copy()
    for row, law in packed.system.driven:
        known[law, 0] = phi[row]
    scale = [STRIDE * (1.0 if driver.kind.angular else packed.size) for driver in packed.drivers]
    way = np.abs(drive[1:, 0] - known[1:, 0]) / np.array(scale) if scale else np.zeros(1)
    steps = min(MOST_STEPS, max(1, math.ceil(way.max(initial=0.0))))
    worst = np.inf
    for k in range(1, steps + 1):
        q, worst = close(packed, q, known + (drive - known) * (k / steps))
        if worst > 1e-3:
            break
    if worst > CLOSED:
        q, worst = close(packed, q, drive)
    return q, worst


def _held_start(m: Model, packed: Packed, q: np.ndarray) -> np.ndarray:
    """Return the pose at which joints hold what start_near gives, as far as they can, drivers released."""
    named = [m.joints[name] for name in m.starts]
    whole = pack(m, [(joint, start_row(joint)) for joint in named])
    first = len(whole.row_joint) - len(named)
    rows = np.concatenate([np.arange(packed.driver_rows), np.arange(first, first + len(named))])
    none = np.zeros((len(packed.motions) + 1, 3))
    whole.ws.guess[: len(packed.ws.guess)] = packed.ws.guess
    begin = whole.measured(q, none)[0][first:]
    target = np.array(list(m.starts.values()))
    scale = STRIDE * np.array([1.0 if joint.kind.turns else packed.size for joint in named])
    steps = min(MOST_STEPS, max(1, math.ceil(float((np.abs(target - begin) / scale).max()))))
    for k in range(1, steps + 1):
        whole.system.value[first:] = begin + (target - begin) * (k / steps)
        q, worst = close(whole, q, none, rows)
        if worst > CLOSED:  # the joints leave less free than was given
            free = independent_rows(whole.scaled(q)[rows])
            q, _ = close(whole, q, none, rows[free])
    packed.ws.guess[:] = whole.ws.turn[: len(packed.ws.guess)]
    return q


def close(packed: Packed, q: np.ndarray, drive: np.ndarray, rows: np.ndarray | None = None) -> tuple[np.ndarray, float]:
    """Return the pose near q (3 + 7 n,) at which ``rows`` (default: all) hold, and what is left."""
    rows = np.arange(len(packed.row_joint)) if rows is None else rows
    scale = packed.row_scale[rows]

    def residual(pose: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        phi, jac = packed.measured(pose, drive)
        return phi[rows] * scale, jac[rows] * scale[:, None] * packed.column_scale

    phi, jac = residual(q)
    for _ in range(MOST_ITERATIONS):
        packed.ws.guess[:] = packed.ws.turn
        worst = float(np.abs(phi).max(initial=0.0))
        if worst <= EXACT or not np.isfinite(phi).all():
            break
        step = np.linalg.lstsq(jac, -phi, rcond=1e-10)[0]
        step *= min(1.0, LONGEST_STEP / max(float(np.abs(step).max()), 1e-300))
        part = 1.0
        while part > 1e-3:
            trial = moved(q, part * step * packed.column_scale)
            after, matrix = residual(trial)
            if np.linalg.norm(after) < np.linalg.norm(phi):
                break
            part *= 0.5
        else:
            residual(q)
            break
        q, phi, jac = trial, after, matrix
        if float(np.abs(part * step).max()) <= EXACT:
            break
    return q, float(np.abs(phi).max(initial=0.0)) if np.isfinite(phi).all() else np.inf


def why_open(packed: Packed, q: np.ndarray, drive: np.ndarray, time: float) -> str:
    """Return the error text for a pose q (3 + 7 n,) that does not close: the joint and its gap."""
    phi, _ = packed.measured(q, drive)
    k = int(packed.row_joint[int(np.argmax(np.abs(phi * packed.row_scale)))])
    phi, _ = packed.measured(_least_open(packed, q, drive, k), drive)
    joint = packed.joints[k]
    what = "driver" if joint.kind.driven else "joint"
    return (
        f"{packed.name}: the joints do not close at t = {time:.6g} s: {what} '{joint.name}' stays open by "
        f"{gap_in_words(packed, k, phi)} at best. Check lengths and places, start the drivers within reach, or say "
        "which assembly is meant with start_near."
    )


def _least_open(packed: Packed, q: np.ndarray, drive: np.ndarray, joint: int) -> np.ndarray:
    """Return the pose near q (3 + 7 n,) at which all but one joint hold and its gap is least."""
    own, others = np.flatnonzero(packed.row_joint == joint), np.flatnonzero(packed.row_joint != joint)

    def gap(pose: np.ndarray) -> np.ndarray:
        return packed.measured(pose, drive)[0][own] * packed.row_scale[own]

    q, worst = close(packed, q, drive, others)
    longest = NEAREST_STEP if worst <= CLOSED else 0.0
    while longest > 1e-6:
        jac = packed.measured(q, drive)[1] * packed.row_scale[:, None] * packed.column_scale
        _, singular, v = np.linalg.svd(jac[others], full_matrices=True)
        free = v[int((singular > RANK_TOLERANCE * singular.max(initial=0.0)).sum()) :].T
        step = free @ np.linalg.lstsq(jac[own] @ free, -gap(q), rcond=1e-10)[0]
        step *= min(1.0, longest / max(float(np.abs(step).max(initial=0.0)), 1e-300))
        trial, worst = close(packed, moved(q, step * packed.column_scale), drive, others)
        if worst <= CLOSED and np.linalg.norm(gap(trial)) < np.linalg.norm(gap(q)):
            q = trial
        else:
            longest *= 0.5
    return q


def gap_in_words(packed: Packed, joint: int, phi: np.ndarray) -> str:
    """Return the gap of a joint, by its number: in mm, in degrees, or both."""
    own = packed.row_joint == joint
    metres = np.array([unit == "m" for unit in packed.row_unit])
    parts = []
    if (own & metres).any():
        parts.append(f"{1000.0 * float(np.linalg.norm(phi[own & metres])):.3g} mm")
    if (own & ~metres).any():
        parts.append(f"{math.degrees(float(np.linalg.norm(phi[own & ~metres]))):.3g} degrees")
    return " and ".join(parts)
