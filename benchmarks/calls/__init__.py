"""Sweeps of a four-bar, and calls as users make them, over and over on a model made once.

A crank-rocker through 1000 crank angles of one turn, by the solver alone. The same at 360 steps by whole calls, from
names to results: again, and after a change of the motor's speed. Error: the worst angle of coupler or rocker (rad). A
rod of 1 m and 1 kg, released from the horizontal, for 10 s with its motion at 1000 times or more; error: the largest
drift of its energy (J).
"""

from __future__ import annotations

import math

import numpy as np

FOUR_BAR = "four-bar sweep of 1000 angles"
SWEEP = "call of a sweep, four-bar, 360 steps, again"
CHANGED = "call of a sweep, four-bar, 360 steps, after a change of the motor"
SIMULATION = "call of a simulation, pendulum, 10 s, again"
GROUND, CRANK, COUPLER, ROCKER = 4.0, 1.0, 3.5, 3.0
ANGLES = np.arange(1000) * 2 * np.pi / 1000
STEPS = 360
LENGTH, MASS, GRAVITY, DURATION, OUTPUTS = 1.0, 1.0, 9.81, 10.0, 1000
LIMIT = 1e-3
"""rad, J: with more, a code did not solve the problem."""


def exact(phi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return coupler and rocker angle (rad, open branch) at crank angles phi, from triangles."""
    bx, by = CRANK * np.cos(phi), CRANK * np.sin(phi)
    dx, dy = GROUND - bx, -by
    diagonal = np.hypot(dx, dy)
    bend = np.arccos((COUPLER**2 + diagonal**2 - ROCKER**2) / (2 * COUPLER * diagonal))
    coupler = np.arctan2(dy, dx) + bend
    cx, cy = bx + COUPLER * np.cos(coupler), by + COUPLER * np.sin(coupler)
    return coupler, np.arctan2(cy, cx - GROUND)


START = tuple(float(angle[0]) for angle in exact(np.zeros(1)))
"""Angles of coupler and rocker (rad) where the crank is at 0."""
POSES = (
    (CRANK / 2, 0.0, 0.0, CRANK),
    (CRANK + COUPLER / 2 * math.cos(START[0]), COUPLER / 2 * math.sin(START[0]), START[0], COUPLER),
    (GROUND + ROCKER / 2 * math.cos(START[1]), ROCKER / 2 * math.sin(START[1]), START[1], ROCKER),
)
"""Middles (m), angles (rad) and lengths (m) of crank, coupler and rocker at the start."""
PINS = (
    (-1, (0.0, 0.0), 0, (-CRANK / 2, 0.0)),
    (0, (CRANK / 2, 0.0), 1, (-COUPLER / 2, 0.0)),
    (1, (COUPLER / 2, 0.0), 2, (ROCKER / 2, 0.0)),
    (-1, (GROUND, 0.0), 2, (-ROCKER / 2, 0.0)),
)
"""Body and place on it (m) of both sides of each pin, frames at the middles; body -1 is ground."""


def worst(angles: np.ndarray, expected: np.ndarray) -> float:
    """Return the largest difference of angles (rad), whole turns aside."""
    return float(np.abs(np.angle(np.exp(1j * (angles - expected)))).max())


def rocker_error(crank: np.ndarray, rocker: np.ndarray) -> float:
    """Return the worst of the rocker's angles (rad) at these angles of the crank (rad)."""
    return worst(rocker, exact(crank)[1])


def energy_drift(angle: np.ndarray, speed: np.ndarray) -> float:
    """Return the drift (J) from the start's energy, 0.

    The angle (rad) is that of the rod from the horizontal.
    """
    inertia = MASS * LENGTH**2 / 3
    energy = 0.5 * inertia * speed**2 + MASS * GRAVITY * LENGTH / 2 * np.sin(angle)
    return float(np.abs(energy).max())
