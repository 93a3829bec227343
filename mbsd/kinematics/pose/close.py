"""Assembled pose at the start: rough angles, a walk over joints for places, then Gauss-Newton.

Steps are damped (least norm, limited length, halved until the residual falls), so the pose closes near where the
author put it. Bodies without a rough angle are tried at several angles. If none closes, the error names the joint that
stays open, and a link that is longer than the others of its loop together.

Starts of many rows (dynamics/batch/starts.py) and of large mechanisms (dynamics/prepare/large.py) have loops of their
own: the first solves all rows in one call, the second by sparse factors. Held values are as here.
"""

from __future__ import annotations

import heapq
import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.starts import take_force_phases
from mbsd.base.errors import AssemblyError
from mbsd.base.running import Kept
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics.pose.held_values import held_values, is_choice, places_of
from mbsd.kinematics.pose.ideal_joints import closed_ideally
from mbsd.kinematics.pose.phases import let_phases_go, refuse_impossible, take_phases
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model

CLOSED = 1e-10
"""Largest residual of a closed pose, in sizes (m) and rad."""
ATTEMPTS = 24
MANY_ROWS = 100
"""Number of rows from which on the shortest step is found without singular values where rows are well apart."""
WELL_CONDITIONED = 1e-4
LONGEST_STEP = 0.5
"""Longest Gauss-Newton step, in sizes and rad."""


class _Nearest(NamedTuple):
    """Nearest pose to a closed one in all attempts, with the open ones, as they take longest."""

    q: np.ndarray
    """(3 nb,)"""
    offsets: np.ndarray
    """System.angle_offset that goes with it: the turns of welds are taken to suit the pose."""
    closes: bool


_NEAREST: Kept[_Nearest] = Kept()


def assemble(m: Model, packed: Packed, time: float) -> np.ndarray:
    """Return the (3 nb,) closed pose at ``time``. Raises AssemblyError naming the open joint.

    Coordinates are those of centres of mass.

    Forces that take the place of joints stand as these do.
    """
    q, _ = closed_ideally(m, packed, lambda own, whole: _assemble(own, whole, time))
    take_force_phases(packed, q)
    return q


def _assemble(m: Model, packed: Packed, time: float) -> np.ndarray:
    """Return the closed pose of a mechanism whose joints all hold."""
    drive = packed.drives(np.array([time]))[0]
    numbers = packed.numbers()
    if numbers is None:
        start = _nearest(m, packed, drive)
    else:
        key = (*numbers, tuple(packed.body_names), repr(m.starts), drive[:, 0].tobytes())
        start = _NEAREST.get(key, lambda: _nearest(m, packed, drive))
    if start.offsets is not packed.system.angle_offset:
        packed.system = packed.system.changed(angle_offset=start.offsets)
    if not start.closes:
        raise AssemblyError(why_open(m, packed, start.q, drive, time))
    return start.q.copy()


def _nearest(m: Model, packed: Packed, drive: np.ndarray) -> _Nearest:
    """Return the pose nearest to a closed one, found anew; drive (motions + 1, 3)."""
    best: tuple[float, np.ndarray] | None = None
    for attempt in range(ATTEMPTS):
        q = rough_pose(m, packed, drive, attempt)
        unwind_angles(packed, q)
        q, worst = close_with_phases(m, packed, q, drive)
        if worst <= CLOSED:
            refuse_impossible(packed, q)
            return _Nearest(q, packed.system.angle_offset, True)
        if best is None or worst < best[0]:
            best = worst, q
    assert best is not None
    packed.specials.check()
    return _Nearest(best[1], packed.system.angle_offset, False)


def close_with_phases(m: Model, packed: Packed, q: np.ndarray, drive: np.ndarray) -> tuple[np.ndarray, float]:
    """Close rows of places, with bodies turned as given; the others mesh as bodies then stand."""
    let_phases_go(packed)
    q, worst = close(packed, q, drive)
    if worst <= CLOSED and packed.specials.phased:
        q = close_holding(m, packed, q, drive)
    if worst <= CLOSED and take_phases(packed, q, drive):
        q, worst = close(packed, q, drive)
    return q, worst


def close(packed: Packed, q: np.ndarray, drive: np.ndarray, rows: int | None = None) -> tuple[np.ndarray, float]:
    """Close the first ``rows`` rows (default: all) by Gauss-Newton from q; return pose and residual.

    The residual is scaled.
    """
    q = q.copy()
    rows = len(packed.ws.phi) if rows is None else rows
    row_scale, column_scale = packed.row_scale()[:rows], packed.column_scale()

    def scaled() -> np.ndarray:
        residual_and_jacobian(packed.system, q, drive, packed.ws)
        return packed.ws.phi[:rows] * row_scale

    phi = scaled()
    if rows == 0:
        return q, 0.0
    for _ in range(200):
        jac = packed.jacobian()[:rows] * row_scale[:, None] * column_scale
        if not (np.isfinite(jac).all() and np.isfinite(phi).all()):
            return q, math.inf
        step = _least(jac, -phi)
        step, longest = damped(step)
        before, old = float(np.linalg.norm(phi)), q.copy()
        for _ in range(12):
            q[3:] = old[3:] + step * column_scale
            phi = scaled()
            if np.linalg.norm(phi) < before or longest < 1e-9:
                break
            step /= 2
        if longest < 1e-13 or not np.linalg.norm(phi) < before:
            break
    return q, float(np.abs(phi).max())


def given_coordinates(m: Model, packed: Packed) -> list[tuple[int, float]]:
    """Return coordinates (index in (3 nb,), value) that start_near gives, in its order."""
    given = []
    number = {name: b for b, name in enumerate(packed.body_names)}
    for name, start in m.starts.items():
        b = number[name]
        given.append((3 * b + 2, start.angle))
        if start.place is not None:
            c, s = math.cos(start.angle), math.sin(start.angle)
            x, y = packed.com[b]
            given += [(3 * b, start.place[0] + c * x - s * y), (3 * b + 1, start.place[1] + s * x + c * y)]
    return given


def nearest_turn(q: np.ndarray, c: int, value: float) -> float:
    """Return ``value`` of coordinate c, for an angle up to whole turns."""
    return value + 2 * math.pi * round((q[c] - value) / (2 * math.pi)) if c % 3 == 2 else value


def start_targets(m: Model, packed: Packed, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the coordinates that start_near gives, and values (k,) within half a turn of q."""
    given = given_coordinates(m, packed)
    return np.array([c for c, _ in given], np.int64), np.array([nearest_turn(q, c, value) for c, value in given])


def close_holding(m: Model, packed: Packed, q: np.ndarray, drive: np.ndarray) -> np.ndarray:
    """Return the closed pose (3 nb,) that holds what start_near gives as far as the joints let it.

    ``q``: a closed pose, which is returned where no such pose is near. Directions in which places are held may turn on
    the way.
    """
    wanted, targets = start_targets(m, packed, q)
    row_scale, column_scale = packed.row_scale(), packed.column_scale()
    size = column_scale[wanted - 3]
    if (np.abs(q[wanted] - targets) / size).max(initial=0.0) <= 1e-12:
        return q
    closed, units = q, np.eye(packed.coordinates)[wanted - 3]
    q, held = q.copy(), np.zeros((0, len(wanted)))
    for _ in range(50):
        residual_and_jacobian(packed.system, q, drive, packed.ws)
        rows = packed.jacobian() * row_scale[:, None] * column_scale
        if not len(held) or not is_choice(held):
            held = held_values(rows, units, places_of(wanted.tolist()))[1]
        phi = np.concatenate([packed.ws.phi * row_scale, held @ ((q[wanted] - targets) / size)])
        if np.abs(phi).max() <= 1e-13:
            break
        jac = np.vstack([rows, held @ units])
        step, longest = damped(np.linalg.lstsq(jac, -phi, rcond=1e-10)[0])
        if longest < 1e-15:
            break
        q[3:] += step * column_scale
    residual_and_jacobian(packed.system, q, drive, packed.ws)
    return q if np.abs(packed.ws.phi * row_scale).max(initial=0.0) <= CLOSED else closed


def damped(step: np.ndarray) -> tuple[np.ndarray, float]:
    """Return ``step`` (n,) no longer than ``LONGEST_STEP``, and how far it moves or turns a body.

    The latter is in sizes or rad. The world's axes do not matter.
    """
    x, y, angle = step.reshape(-1, 3).T
    longest = float(np.maximum(np.hypot(x, y), np.abs(angle)).max(initial=0.0))
    return step * (min(1.0, LONGEST_STEP / longest) if longest > 0 else 1.0), longest


def _least(jac: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Return the shortest x with J x nearest to ``right``.

    Singular values below 1e-9 of the largest count as zero.
    """
    if len(jac) >= MANY_ROWS:
        square = jac @ jac.T
        try:
            pivots = np.diag(np.linalg.cholesky(square))
        except np.linalg.LinAlgError:  # rows that repeat others
            pivots = np.zeros(1)
        if pivots.min() > WELL_CONDITIONED * pivots.max():
            step = jac.T @ np.linalg.solve(square, right)
            return step + jac.T @ np.linalg.solve(square, right - jac @ step)
    return np.linalg.lstsq(jac, right, rcond=1e-9)[0]


def rough_pose(m: Model, packed: Packed, drive: np.ndarray, attempt: int) -> np.ndarray:
    """Return a (3 nb,) pose from ``start_near``, drivers and a walk over joints.

    Attempts after the first vary angles.
    """
    return placed_pose(m, packed, _rough_angles(m, packed, drive, attempt))


def placed_pose(m: Model, packed: Packed, angle: np.ndarray) -> np.ndarray:
    """Return (3 nb,) bodies at angles (nb,), placed by ``start_near`` or by a walk over the joints."""
    q = np.zeros((len(packed.body_names), 3))
    q[:, 2] = angle
    placed = {0}
    for name, start in m.starts.items():
        if start.place is not None:
            b = packed.body_names.index(name)
            q[b, :2] = start.place + turned(angle[b], packed.com[b])
            placed.add(b)
    k, reaches = 0, ("point", "distance", "slot", "along", "angle")
    while k < len(reaches):  # what hangs from a slider by pins is placed by them, once the slider is
        before = len(placed)
        _place_along(packed, q, placed, reaches[k])
        k = 0 if len(placed) > before and k > 0 else k + 1
    return q.ravel()


def _rough_angles(m: Model, packed: Packed, drive: np.ndarray, attempt: int) -> np.ndarray:
    random = np.random.default_rng(attempt)
    angle = np.zeros(len(packed.body_names))
    known = {0}
    for b, name in enumerate(packed.body_names):
        if name in m.starts:
            vary = 0.15 * random.standard_normal() if attempt else 0.0
            angle[b] = m.starts[name].angle + vary
            known.add(b)
    system = packed.system
    for _ in packed.body_names:  # angles pass on along welds, sliders and driven angles
        before = len(known)
        for (i, j, _row, motion), offset in zip(system.angle, system.angle_offset, strict=True):
            bi, bj = system.marker_body[i], system.marker_body[j]
            turn = offset + drive[motion, 0]
            if motion and bi == 0:  # a driver's angle is exact, start_near only rough
                angle[bj] = turn
                known.add(bj)
            elif bi in known and bj not in known:
                angle[bj] = angle[bi] + turn
                known.add(bj)
            elif bj in known and bi not in known:
                angle[bi] = angle[bj] - turn
                known.add(bi)
        if len(known) == before:
            break
    for b in range(len(angle)):
        if b not in known and attempt:
            angle[b] = random.uniform(-math.pi, math.pi)
    return angle


def _place_along(packed: Packed, q: np.ndarray, placed: set[int], constraint: str) -> None:
    """Place bodies by joints of a constraint to placed ones, always the first of the table."""
    system = packed.system
    table = getattr(system, constraint)
    pairs = [(int(system.marker_body[i]), int(system.marker_body[j])) for i, j, _row, _motion in table]
    at_body: dict[int, list[int]] = {}
    for k, pair in enumerate(pairs):
        for body in pair:
            at_body.setdefault(body, []).append(k)
    queue = [k for k, (bi, bj) in enumerate(pairs) if (bi in placed) != (bj in placed)]
    heapq.heapify(queue)
    while queue:
        k = heapq.heappop(queue)
        bi, bj = pairs[k]
        if (bi in placed) == (bj in placed):
            continue
        i, j, _row, _motion = table[k]
        base, new = (i, j) if bi in placed else (j, i)
        body = bj if bi in placed else bi
        target = _marker_place(packed, q, base)
        if constraint == "distance":
            target = target + np.array([system.distance_length[k], 0.0])
        q[body, :2] = target - turned(q[body, 2], system.marker_arm[new])
        placed.add(body)
        for other in at_body[body]:
            heapq.heappush(queue, other)


def _marker_place(packed: Packed, q: np.ndarray, marker: int) -> np.ndarray:
    b = packed.system.marker_body[marker]
    return q[b, :2] + turned(q[b, 2], packed.system.marker_arm[marker])


def unwind_angles(packed: Packed, q: np.ndarray) -> None:
    """Take the whole turns of welds and sliders that are nearest to the rough pose."""
    system = packed.system
    turns = np.zeros(len(system.angle))
    for k, (i, j, _row, motion) in enumerate(system.angle):
        if motion == 0:
            gap = q[3 * system.marker_body[j] + 2] - q[3 * system.marker_body[i] + 2] - system.angle_offset[k]
            turns[k] = round(gap / (2 * math.pi))
    if turns.any():
        packed.system = system.changed(angle_offset=system.angle_offset + 2 * math.pi * turns)


def why_open(m: Model, packed: Packed, q: np.ndarray, drive: np.ndarray, time: float) -> str:
    """Return the message for an open pose q (3 nb,): the joint, its gap, and the link too short."""
    residual_and_jacobian(packed.system, q, drive, packed.ws)
    phi = packed.ws.phi
    gaps = [float(np.abs(phi[a:b] * packed.row_scale()[a:b]).max()) for a, b in pairwise(packed.first_row)]
    worst = int(np.argmax(gaps))
    joint = packed.joints[worst]
    rows = packed.rows_of(worst)
    what = "driver" if joint.kind.driven else "joint"
    gap = f"{1000 * float(np.linalg.norm(phi[rows])):.3g} mm"
    if packed.row_scale()[rows][0] == 1.0 and len(phi[rows]) == 1 and joint.kind.angular:
        gap = f"{math.degrees(float(phi[rows][0])):.3g} degrees"
    hint = _short_links(m, packed, joint, drive)
    return (
        f"{m.name}: the links do not close at t = {time:.6g} s: {what} {joint.name} stays open by {gap} at best. "
        + (hint or "Check the lengths and joint places, or give other rough angles with start_near.")
    )


def _short_links(m: Model, packed: Packed, joint: Joint, drive: np.ndarray) -> str:
    """Return in a loop of pinned links: the one that is longer than the others together, if so."""
    loop = _loop_through(m, joint)
    if loop is None:
        return ""
    driven = {
        j.j.body.name: float(drive[k + 1, 0])
        for k, j in enumerate(m.drivers.values())
        if j.kind.angular and j.i.body.name == "ground" and j.motion is not None
    }
    parts: list[tuple[str, np.ndarray, bool]] = []  # bodies, vector in the world if it is fixed, fixed?
    for body, entry, leave in loop:
        vector = np.array([leave.x - entry.x, leave.y - entry.y])
        fixed = body == "ground" or body in driven
        parts.append((body, turned(driven.get(body, 0.0), vector) if fixed else vector, fixed))
    held = [part for part in parts if part[2]]
    spans = [(name, float(np.linalg.norm(vector))) for name, vector, fixed in parts if not fixed]
    if held:
        label = " and ".join(name for name, _, _ in held)
        spans.append((label, float(np.linalg.norm(sum(vector for _, vector, _ in held)))))
    order = list(m.bodies)
    spans.sort(key=lambda span: order.index(span[0]) if span[0] in order else -1)
    longest = max(spans, key=lambda span: span[1])
    others = [span for span in spans if span is not longest]
    reach = sum(length for _, length in others)
    if longest[1] <= reach:
        return ""
    together = " + ".join(name for name, _ in others)
    return (
        f"The links are too short: {together} = {reach:.4g} m must reach {longest[1]:.4g} m "
        f"({'between the ends of ' if longest[0].count(' and ') else ''}{longest[0]})."
    )


class _Crossing(NamedTuple):
    """A body on a loop of pins, with the markers by which the loop enters and leaves it."""

    body: str
    entry: Marker
    exit: Marker


def _loop_through(m: Model, joint: Joint) -> list[_Crossing] | None:
    """Return the shortest loop of pins through ``joint`` (any loop if it is no pin), or None."""
    pins = [j for j in m.joints.values() if j.kind.pair == "pin"]
    if joint not in pins:
        loops = [loop for pin in pins if (loop := _loop_through(m, pin))]
        return min(loops, key=len, default=None)
    reached: list[tuple[list[_Crossing], Marker]] = [([], joint.j)]  # bodies crossed, and the marker now entered by
    seen = {joint.j.body.name}
    for crossed, entry in reached:  # grows while it is walked: breadth first
        name = entry.body.name
        if name == joint.i.body.name:
            return [*crossed, _Crossing(name, entry, joint.i)]
        for pin in pins:
            for here, there in ((pin.i, pin.j), (pin.j, pin.i)):
                if pin is not joint and here.body.name == name and there.body.name not in seen:
                    seen.add(there.body.name)
                    reached.append(([*crossed, _Crossing(name, entry, here)], there))
    return None


def turned(angle: float, vector: np.ndarray) -> np.ndarray:
    """Return ``vector`` (2,) turned by ``angle`` (rad)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])
