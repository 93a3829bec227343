"""Flow of energy: the power of joints, drivers and forces, from the giver to the receiver.

P = F . v + T w        on a body; F, T what acts on it at a point that moves with v, w its angular velocity
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.drawing.animation.arrows import Arrow, applied, moving, moving_marker
from mbsd.drawing.pose import Tracks
from mbsd.model.mechanism import Model
from mbsd.results.solution import Solution


@dataclass(frozen=True)
class Balance:
    """Energies and powers of the bars, (T,) J and W."""

    kinetic: np.ndarray
    potential: np.ndarray
    """Potential energy, counted from its least."""
    powers: dict[str, np.ndarray]
    """Powers of drivers and forces, by name; positive: given to the motion."""
    bodies: dict[str, np.ndarray]
    """Kinetic energy of each moving body."""


def flow_arrows(sol: Solution, tracks: Tracks) -> list[Arrow]:
    """Return arrows of power: between bodies through joints, and between bodies, drivers and forces."""
    m, out = sol.mechanism, []
    middles = {name: _middle(m, tracks, name) for name in m.bodies if name != "ground"}
    drivers = set(m.drivers.values())
    for k, joint in enumerate(sol.packed.joints):
        first, second = joint.bodies
        if second == "ground":
            continue
        force, torque = sol.wrench[:, k, :2], sol.wrench[:, k, 2]
        at = moving_marker(tracks.views, joint.j)
        power = (force * at.velocity).sum(axis=1) + torque * tracks.views[second].omega
        passes = first != "ground" and joint not in drivers
        giver = middles[first] if passes else 2 * at.place - middles[second]
        out.append(_arrow(at.place, middles[second] - giver, power, force, middle=passes))
    for action, place in applied(sol):
        frame = tracks.views[action.body]
        arm = place - np.stack([frame.x, frame.y], axis=1)
        speed = np.stack([frame.vx - frame.omega * arm[:, 1], frame.vy + frame.omega * arm[:, 0]], axis=1)
        power = (action.force * speed).sum(axis=1) + action.torque * frame.omega
        out.append(_arrow(place, middles[action.body] - place, power, action.force, middle=False))
    return out


def balance_of(sol: Solution) -> Balance:
    """Return energies and powers of the whole mechanism."""
    m, packed = sol.mechanism, sol.packed
    powers = {name: sol.driver(name).power for name in m.drivers}
    powers |= {name if name not in powers else f"force {name}": view.power for name, view in sol.forces.items()}
    mass, inertia = packed.system.mass, packed.system.inertia
    each = 0.5 * (mass * (sol.v[..., 0] ** 2 + sol.v[..., 1] ** 2) + inertia * sol.v[..., 2] ** 2)
    bodies = {name: each[:, k] for k, name in enumerate(packed.body_names) if name != "ground"}
    potential = sol.energy.potential
    return Balance(sol.energy.kinetic, potential - potential.min(), powers, bodies)


def _middle(m: Model, tracks: Tracks, name: str) -> np.ndarray:
    """Return (T, 2) of a body: its centre of mass, or the middle of its joints where it has none."""
    body = m.bodies[name]
    here = [marker for joint in m.joints.values() for marker in (joint.i, joint.j) if marker.body is body]
    x, y = body.com
    if body.mass == 0 and here:
        x, y = (float(np.mean([getattr(marker, axis) for marker in here])) for axis in "xy")
    return moving(tracks.views[name], x, y).place


def _arrow(place: np.ndarray, way: np.ndarray, power: np.ndarray, force: np.ndarray, middle: bool) -> Arrow:
    """Return an arrow along ``way`` (T, 2) where power is positive.

    It is along the force where the way has no length.
    """
    length = np.hypot(*way.T)
    short = length < 1e-9 * max(float(length.max()), 1e-12)
    way = np.where(short[:, None], force, way)
    length = np.hypot(*way.T)
    unit = np.divide(way, length[:, None], out=np.zeros_like(way), where=length[:, None] > 0)
    return Arrow("energy", place, power[:, None] * unit, middle)
