"""Velocities and accelerations: of joints that move, of traced points, of bodies that no joint holds."""

from __future__ import annotations

import numpy as np

from mbsd.drawing.animation.quantities.arrows import Arc, Arrow, Moving, moving, moving_marker
from mbsd.drawing.pose import Tracks
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model

SAME = 1e-9
"""Fraction of the size of the motion: points that stay closer than this are one."""


def motion_arrows(m: Model, tracks: Tracks, quantity: str) -> list[Arrow | Arc]:
    """Return arrows of ``velocities`` or ``accelerations``; an arc for a body that turns about a fixed point alone."""
    out: list[Arrow | Arc] = []
    shown: list[Moving] = []
    points = {name: [moving_marker(tracks.views, marker) for marker in _markers(m, name)] for name in m.bodies}
    everywhere = np.concatenate([point.place for several in points.values() for point in several] or [np.zeros((1, 2))])
    slack = SAME * max(float(np.ptp(everywhere, axis=0).max()), 1e-12)
    for name, view in tracks.views.items():
        if name == "ground":
            continue
        moves = [point for point in points[name] if np.ptp(point.place, axis=0).max() > slack]
        for move in moves:
            if any(np.abs(move.place - other.place).max() < slack for other in shown):
                continue
            shown.append(move)
            out.append(Arrow(quantity, move.place, move.velocity if quantity == "velocities" else move.acceleration))
        if not moves and np.ptp(view.theta) > 0:
            pivot = points[name][0] if points[name] else moving(view, *m.bodies[name].com)
            out.append(Arc(quantity, pivot.place, view.omega if quantity == "velocities" else view.alpha))
    return out


def _markers(m: Model, name: str) -> list[Marker]:
    """Where a body has joints and traced points; its centre of mass too, or a bar's end, if these are one place."""
    joints = [*m.joints.values(), *(contact for contact in m.contacts.values() if contact.kind.drawn_as == "rope")]
    out = [marker for joint in joints for marker in (joint.j, joint.i) if marker.body.name == name]
    out += [marker for marker in m.traces.values() if marker.body.name == name]
    body = m.bodies[name]
    if len({(marker.x, marker.y) for marker in out}) < 2:
        out.append(body.end if body.length is not None and body.mass == 0 else body.at(*body.com))
    return out
