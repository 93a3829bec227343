"""Reactions of joints and contacts; applied forces, efforts of drivers, weights; each where it acts."""

from __future__ import annotations

import numpy as np

from mbsd.drawing.animation.quantities.arrows import Arc, Arrow, applied, moving
from mbsd.drawing.pose import Tracks
from mbsd.results.acting import felt
from mbsd.results.solution import Solution


def reaction_arrows(sol: Solution) -> list[Arrow | Arc]:
    """Return the reactions of joints and contacts on the moving body."""
    out: list[Arrow | Arc] = []
    drivers = set(sol.mechanism.drivers.values())
    for k, joint in enumerate(sol.packed.joints):
        if joint not in drivers:
            out += _wrench(sol, k, "reactions")
    return out


def force_arrows(sol: Solution, tracks: Tracks) -> list[Arrow | Arc]:
    """Forces of the model on each moving body that feels them, efforts of drivers on their second body, weights."""
    m, out = sol.mechanism, []
    for action, place in applied(sol):
        out += [Arrow("forces", place, action.force), Arc("forces", place, action.torque)]
    for k, joint in enumerate(sol.packed.joints):
        if m.drivers.get(joint.name) is joint:
            out += _wrench(sol, k, "forces")
    gravity = np.array(m.gravity, float)
    for name, body in m.bodies.items():
        if name != "ground" and body.mass > 0 and gravity.any():
            centre = moving(tracks.views[name], *body.com).place
            out.append(Arrow("forces", centre, np.broadcast_to(body.mass * gravity, centre.shape), weight=True))
    return out


def _wrench(sol: Solution, k: int, quantity: str) -> list[Arrow | Arc]:
    """Force and torque of joint number ``k`` on the body that moves."""
    on = felt(sol.packed, sol.q, sol.wrench, k)
    place = np.stack([on.x, on.y], axis=1)
    return [Arrow(quantity, place, on.force), Arc(quantity, place, on.torque)]
