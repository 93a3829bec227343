"""Joints, contacts and forces whose two sides lie in different planes, though they act in one.

A pin, a guide or a weld may be as long as it must; teeth, cams, rolling bodies and contacts touch in one plane, and a
rod or a spring between two planes would be inclined, which planar equations do not know.
"""

from __future__ import annotations

from collections.abc import Iterator

from mbsd.base.codes import LINE
from mbsd.model.body import Marker
from mbsd.model.force import Force
from mbsd.model.joint import Joint
from mbsd.model.mechanism import Model

SAME = 1e-9
"""Places nearer than this are one plane (m)."""


def apart(m: Model) -> Iterator[tuple[str, str, float, float]]:
    """Name, kind, and places (m) of both sides, where these differ and cannot; a place that was not given fits all."""
    for part in (*m.joints.values(), *m.drivers.values(), *m.contacts.values(), *m.forces.values()):
        i, j = _plane(m, part.i), _plane(m, part.j)
        if i is not None and j is not None and abs(i - j) > SAME and _needs_one(part):
            yield part.name, part.kind.name, i, j


def _plane(m: Model, marker: Marker) -> float | None:
    return None if marker.z is None and marker.body is m.ground else marker.plane


def _needs_one(part: Joint | Force) -> bool:
    if isinstance(part, Force):
        return any(element.kind == LINE for element in part.kind.elements(part))
    return part.kind.touching != "" or bool({"distance", "gear"} & set(part.kind.constraints))
