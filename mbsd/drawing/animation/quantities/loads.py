"""Reactions of joints and contacts; applied forces, efforts of drivers, weights; each where it acts."""

from __future__ import annotations

import math

import numpy as np

from mbsd.drawing.animation.quantities.arrows import Arc, Arrow, acting, moving, moving_marker
from mbsd.drawing.pose import Tracks
from mbsd.model.joint import Joint
from mbsd.results.solution import Solution


def reaction_arrows(sol: Solution, tracks: Tracks) -> list[Arrow | Arc]:
    """What joints and contacts do to their second body; to the first one where the second is ground."""
    out: list[Arrow | Arc] = []
    drivers = set(sol.mechanism.drivers.values())
    for k, joint in enumerate(sol.packed.joints):
        if joint not in drivers:
            out += _wrench(sol, tracks, joint, k, "reactions")
    return out


def force_arrows(sol: Solution, tracks: Tracks) -> list[Arrow | Arc]:
    """Forces of the model on each moving body that feels them, efforts of drivers on their second body, weights."""
    m, out = sol.mechanism, []
    for action, place in acting(sol):
        out += [Arrow("forces", place, action.force), Arc("forces", place, action.torque)]
    for k, joint in enumerate(sol.packed.joints):
        if m.drivers.get(joint.name) is joint:
            out += _wrench(sol, tracks, joint, k, "forces")
    gravity = np.array(m.gravity, float)
    for name, body in m.bodies.items():
        if name != "ground" and body.mass > 0 and gravity.any():
            centre = moving(tracks.views[name], *body.com).place
            out.append(Arrow("forces", centre, np.broadcast_to(body.mass * gravity, centre.shape)))
    return out


def _wrench(sol: Solution, tracks: Tracks, joint: Joint, k: int, quantity: str) -> list[Arrow | Arc]:
    """Force and torque of joint number ``k`` on its moving second body, else on its first."""
    force, torque = sol.wrench[:, k, :2], sol.wrench[:, k, 2]
    place = moving_marker(tracks.views, joint.j).place
    if joint.kind.touching:
        place = touched(tracks, joint, place, force, torque)
        torque = np.zeros(len(torque))
    sign = -1.0 if joint.j.body.name == "ground" else 1.0
    return [Arrow(quantity, place, sign * force), Arc(quantity, place, sign * torque)]


def touched(tracks: Tracks, joint: Joint, place: np.ndarray, force: np.ndarray, torque: np.ndarray) -> np.ndarray:
    """(T, 2) where a force acts that has a torque about the second marker only because it acts beside it."""
    radius = joint.params.get("radius", 0.0)
    if joint.kind.touching == "line":  # a line: below the centre, whatever the friction
        angle = tracks.views[joint.i.body.name].theta + joint.i.angle
        return place - radius * np.stack([-np.sin(angle), np.cos(angle)], axis=1)
    if joint.kind.touching == "curve":
        return place + _toward(force, torque, radius) if force.any() else place
    if joint.kind.touching == "discs":
        gap = moving_marker(tracks.views, joint.i).place - place
        length = np.hypot(*gap.T)[:, None]
        side = -joint.params["radius_j"] if joint.params["inside"] else joint.params["radius_j"]
        return place + side * np.divide(gap, length, out=np.zeros_like(gap), where=length > 0)
    square = (force**2).sum(axis=1)
    off = np.divide(torque, square, out=np.zeros(len(torque)), where=square > 0)
    return place + off[:, None] * np.stack([force[:, 1], -force[:, 0]], axis=1)


def _toward(force: np.ndarray, torque: np.ndarray, radius: float) -> np.ndarray:
    """(T, 2) from a disc's centre to where it is pushed at its rim with this torque: against the normal force."""
    size = np.hypot(*force.T)
    lever = np.divide(torque, size, out=np.zeros(len(torque)), where=size > 0)
    lean = np.arcsin(np.clip(lever / radius, -1.0, 1.0)) if radius > 0 else np.zeros(len(torque))
    angle = np.arctan2(force[:, 1], force[:, 0]) + math.pi + lean
    return radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
