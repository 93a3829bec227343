"""Many simulations: the door closer of docs/study.md with n closers.

Error: the worst angle at the end (rad).
"""

from __future__ import annotations

import numpy as np

PROBLEM = "many door closers, 20 s each"
LENGTH, MASS = 0.9, 30.0
INERTIA = MASS * LENGTH**2 / 3.0
DURATION = 20.0
OUTPUTS = 400


def doors(count: int) -> np.ndarray:
    """(n, 3) stiffness (N m/rad), damping (N m s/rad) and preload (N m)."""
    random = np.random.default_rng(1)
    return np.column_stack(
        [random.uniform(2.0, 20.0, count), random.uniform(5.0, 40.0, count), random.choice([1.0, 2.0, 4.0], count)]
    )


def exact(values: np.ndarray) -> np.ndarray:
    """(n,) angle at the end: a damped oscillator from 90 degrees, at rest."""
    stiffness, damping, preload = values.T
    rest = -preload / stiffness
    decay = damping / (2.0 * INERTIA)
    omega = np.emath.sqrt(stiffness / INERTIA - decay**2)
    swing = np.cos(omega * DURATION) + decay / omega * np.sin(omega * DURATION)
    return rest + (np.exp(-decay * DURATION) * (np.pi / 2 - rest) * swing).real
