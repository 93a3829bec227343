"""Reactions of joints and contacts; applied forces, efforts of drivers, weights; each where it acts."""

from __future__ import annotations

import numpy as np

from mbsd.drawing.animation.quantities.arrows import Arc, Arrow, applied, moving
from mbsd.drawing.pose import Tracks
from mbsd.model.joint import Joint
from mbsd.results.acting import acting
from mbsd.results.solution import Solution


def reaction_arrows(sol: Solution) -> list[Arrow | Arc]:
    """What joints and contacts do to their second body; to the first one where the second is ground."""
    out: list[Arrow | Arc] = []
    drivers = set(sol.mechanism.drivers.values())
    for k, joint in enumerate(sol.packed.joints):
        if joint not in drivers:
            out += _wrench(sol, joint, k, "reactions")
    return out


def force_arrows(sol: Solution, tracks: Tracks) -> list[Arrow | Arc]:
    """Forces of the model on each moving body that feels them, efforts of drivers on their second body, weights."""
    m, out = sol.mechanism, []
    for action, place in applied(sol):
        out += [Arrow("forces", place, action.force), Arc("forces", place, action.torque)]
    for k, joint in enumerate(sol.packed.joints):
        if m.drivers.get(joint.name) is joint:
            out += _wrench(sol, joint, k, "forces")
    gravity = np.array(m.gravity, float)
    for name, body in m.bodies.items():
        if name != "ground" and body.mass > 0 and gravity.any():
            centre = moving(tracks.views[name], *body.com).place
            out.append(Arrow("forces", centre, np.broadcast_to(body.mass * gravity, centre.shape), weight=True))
    return out


def _wrench(sol: Solution, joint: Joint, k: int, quantity: str) -> list[Arrow | Arc]:
    """Force and torque of joint number ``k`` on its moving second body, else on its first."""
    on = acting(sol.packed, sol.q, sol.wrench, k)
    sign, place = -1.0 if joint.j.body.name == "ground" else 1.0, np.stack([on.x, on.y], axis=1)
    return [Arrow(quantity, place, sign * on.force), Arc(quantity, place, sign * on.torque)]
