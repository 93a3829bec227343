"""Reason of links that do not close: the open joint, and a link longer than the others together."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.model.body import Marker
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model


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
    """In a loop of pinned links: the one that is longer than the others together, if so."""
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
    """The shortest loop of pins through ``joint`` (any loop if it is no pin); None if there is none."""
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
    """``vector`` (2,) turned by ``angle`` (rad)."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * vector[0] - s * vector[1], s * vector[0] + c * vector[1]])
