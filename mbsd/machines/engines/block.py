"""The block of an engine on its mounts, and its steady vibration at constant speed.

    k = m (2 pi f)^2 / n,   c = 2 zeta m (2 pi f) / n        of each of n mounts; f: natural frequency of the mass

A mount is a bushing: springs and dampers along x and y. The vibration is found order by order, by linear theory:

    M z'' + D z' + K z = B^T F,   F = sum_n Re(F_n e^(i n phi)),   phi = w t         z: small motion on the mounts
    z_n = (K + i n w D - (n w)^2 M)^-1 B^T F_n,   F_n = G_n + w^2 I_n               of gas and of inertia
    T_n = (K + i n w D) z_n                                                         on ground, through the mounts

M, D, K and B are those of the mechanism's linearisation at rest, without its gas, whose stiffness is 0 in the mean of a
cycle. F, force and moment on the block, is what holds it still, reversed. What a motor on the block and the gas do is
within the engine and not in F.

Source: Rao, Mechanical Vibrations, ch. 2, 3 and 6; Maass, Klier 1981, ch. 3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.analyses.modes import Mode
from mbsd.base.arguments import not_negative_number, number_array, number_pair, positive_number
from mbsd.base.errors import ModelError
from mbsd.base.names import shown
from mbsd.mechanism import Mechanism
from mbsd.model.laws.formulas import constant_rate


@dataclass(frozen=True)
class Mount:
    """A place on the block (m) and its springs and dampers along x and y (N/m, N s/m)."""

    at: tuple[float, float]
    stiffness: tuple[float, float]
    damping: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        number_pair("engine: at of a mount (m)", self.at)
        for what, unit in (("stiffness", "N/m"), ("damping", "N s/m")):
            for value in number_pair(f"engine: {what} of a mount", getattr(self, what)):
                not_negative_number(f"engine: {what} of the mount at {self.at}", value, unit)


@dataclass(frozen=True)
class Block:
    """Mass (kg), inertia about its centre of mass (kg m^2) and mounts of what the shaft turns in.

    ``com``: place of its centre of mass against the shaft's axis (m). ``motor_on``: where stands what drives the shaft:
    "block", as a starter does, so that gas and load act within the engine; or "ground", as the drive line of a heavy
    load does, so that the torque of gas and inertia rocks the block.
    """

    mass: float
    inertia: float
    mounts: tuple[Mount, ...]
    com: tuple[float, float] = (0.0, 0.0)
    motor_on: str = "block"

    def __post_init__(self) -> None:
        for what, unit in (("mass", "kg"), ("inertia", "kg m^2")):
            positive_number(f"engine: {what} of the block", getattr(self, what), unit)
        number_pair("engine: com of the block (m)", self.com)
        if self.motor_on not in ("block", "ground"):
            raise ModelError(f"engine: motor_on of the block is {shown(self.motor_on)}; it is 'block' or 'ground'")
        if not self.mounts or not all(isinstance(mount, Mount) for mount in self.mounts):
            raise ModelError("engine: a block needs a list of Mount(...), or it falls")


def mounts_of_frequency(
    mass: float, frequency: float, at: Sequence[tuple[float, float]], damping_ratio: float = 0.1
) -> tuple[Mount, ...]:
    """Return equal mounts at places ``at`` (m) that give a mass (kg) a natural frequency (Hz).

    It is along x and y.

    Raises ModelError for numbers that are not positive.
    """
    positive_number("engine: mass of the mounts", mass, "kg")
    positive_number("engine: frequency of the mounts", frequency, "Hz")
    not_negative_number("engine: damping_ratio of the mounts", damping_ratio)
    if not at:
        raise ModelError("engine: mounts need at least one place")
    omega = 2 * math.pi * frequency
    stiffness, damping = mass * omega**2 / len(at), 2 * damping_ratio * mass * omega / len(at)
    return tuple(Mount(place, (stiffness, stiffness), (damping, damping)) for place in at)


STEPS = 256
"""Number of steps of a turn from which the orders of the forces are taken."""
HIGHEST = 8
"""Highest order where none are given."""
PHASES = np.linspace(0.0, 1.0, 360, endpoint=False)
"""Parts of a cycle among which the largest is sought."""


@dataclass(frozen=True, eq=False)
class MountResponse:
    """Complex amplitudes at each speed (S,) of each order (K,) of Re(sum_k amplitude_k e^(i order_k phi))."""

    speed: np.ndarray
    """(S,) of the shaft (rad/s)."""
    turns: int
    """Turns of the shaft in a cycle."""
    order: np.ndarray
    """(K,) periods in a turn of the shaft."""
    displacement: np.ndarray
    """(S, K, 3) x, y of the shaft's axis in the block (m) and the block's angle (rad)."""
    force: np.ndarray
    """(S, K, 3) of the mounts on ground: Fx, Fy (N) and the moment about the block's centre of mass (N m)."""
    modes: tuple[Mode, ...]
    """Natural frequencies, damping and shapes on the mounts, by rising frequency."""

    def largest_displacement(self) -> np.ndarray:
        """Return (S,) largest distance of the shaft's axis from its mean in a cycle (m).

        All orders count together.
        """
        return np.linalg.norm(self._cycle(self.displacement)[:, :, :2], axis=2).max(axis=1)

    def largest_angle(self) -> np.ndarray:
        """Return (S,) largest angle of the block from its mean in a cycle (rad), all orders together."""
        return np.abs(self._cycle(self.displacement)[:, :, 2]).max(axis=1)

    def largest_force(self) -> np.ndarray:
        """Return (S,) largest force of all mounts on ground about its mean in a cycle (N).

        All orders count together.
        """
        return np.linalg.norm(self._cycle(self.force)[:, :, :2], axis=2).max(axis=1)

    def _cycle(self, amplitude: np.ndarray) -> np.ndarray:
        """Return (S, phases, 3)"""
        turned = np.exp(2j * math.pi * self.turns * np.outer(PHASES, self.order))
        return (turned @ amplitude).real


def mount_response(
    m: Mechanism, speeds: Sequence[float] | np.ndarray, orders: Sequence[float] | None = None
) -> MountResponse:
    """Return the steady linearised vibration of an engine on its mounts at ``speeds`` (rad/s).

    The engine is an ``engine(..., block=...)``. ``orders``: periods in a turn of the shaft, whole numbers or, with gas
    of four strokes, halves; by default all up to 8. Raises ModelError for an engine without a block or without a motor,
    for speeds that are not positive and orders that its cycle does not have.
    """
    what = f"{m.name}: mount_response"
    if "block" not in m.bodies:
        raise ModelError(f"{what}: the engine stands on ground; make it with block=Block(...)")
    if "motor" not in m.drivers:
        raise ModelError(f"{what}: nothing drives the shaft; make the engine with a speed (rad/s)")
    speed = number_array(f"{what}: speeds", speeds)
    if speed.ndim != 1 or not len(speed) or speed.min() <= 0.0:
        raise ModelError(f"{what}: speeds is {shown(speeds)}; give a list of positive numbers (rad/s)")
    gas = {name: force for name, force in m.forces.items() if "cycle" in force.params}
    turns = max((force.params["cycle"].turns for force in gas.values()), default=1)
    order = _orders(what, orders, turns)
    still = m.with_efforts(**dict.fromkeys(gas))
    still.change("motor", law=constant_rate(0.0))
    linear = still.linearise()
    row = 3 * list(m.bodies).index("block")
    block = linear.c[row : row + 3]
    frequency = np.outer(speed, order)[:, :, None, None]
    held = linear.stiffness + 1j * frequency * linear.damping
    force = _forces(m, speed, order, turns)
    z = np.linalg.solve(held - frequency**2 * linear.mass, (force @ block)[..., None])
    moved, pushed = (block @ z)[..., 0], np.linalg.solve(block.T, held @ z)[..., 0]
    x, y = m.bodies["block"].com
    moved[:, :, 0] += y * moved[:, :, 2]
    moved[:, :, 1] -= x * moved[:, :, 2]
    return MountResponse(speed, turns, order, moved, pushed, linear.modes)


def _orders(what: str, orders: Sequence[float] | None, turns: int) -> np.ndarray:
    """Return (K,) of a cycle of ``turns``."""
    if orders is None:
        return np.arange(1, HIGHEST * turns + 1) / turns
    order = number_array(f"{what}: orders", orders)
    most = STEPS // 4
    parts = order * turns
    if order.ndim != 1 or not len(order) or (parts != np.round(parts)).any() or order.min() <= 0 or order.max() > most:
        raise ModelError(
            f"{what}: orders is {shown(orders)}; a cycle of {turns} turn{'s' * (turns > 1)} has those from "
            f"{1 / turns:g} by {1 / turns:g}; give some of them up to {most}"
        )
    return order


def _forces(m: Mechanism, speed: np.ndarray, order: np.ndarray, turns: int) -> np.ndarray:
    """Return (S, K, 3) complex force (N) and moment about the block's centre of mass (N m) on the block.

    Gas and weight push alike at every speed, inertia with its square: two sweeps tell both.
    """
    fast, slow = float(speed.max()), 0.5 * float(speed.max())
    at_fast, at_slow = (_held(m, rate, order, turns) for rate in (fast, slow))
    inertia = (at_fast - at_slow) / (fast**2 - slow**2)
    return at_fast + (speed[:, None, None] ** 2 - fast**2) * inertia


def _held(m: Mechanism, rate: float, order: np.ndarray, turns: int) -> np.ndarray:
    """Return (K, 3) of the block held still at a speed (rad/s)."""
    held = m.with_efforts()
    block = held.bodies["block"]
    held.weld("held still", held.ground.origin, block.origin)
    held.change("motor", law=constant_rate(rate))
    cycle = held.sweep(duration=2 * math.pi * turns / rate, steps=STEPS * turns)
    weld = cycle.joint("held still")
    x, y = block.com
    moment = weld.torque - x * weld.fy + y * weld.fx
    parts = []
    for quantity in (weld.fx, weld.fy, moment):
        harmonics = cycle.orders(quantity, crank="crank", turns=turns)
        parts.append(-harmonics.amplitude * np.exp(1j * harmonics.phase))
    return np.stack(parts, axis=-1)[np.round(order * turns).astype(int) - 1]
