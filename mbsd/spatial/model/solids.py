"""Uniform solids: moments about the centre of mass, the solid's axis as x axis (kg m^2)."""

from __future__ import annotations

import math

import numpy as np

from mbsd.spatial.model.rotation import euler_parameters, frame


def cylinder(mass: float, radius: float, length: float) -> tuple[float, float, float]:
    """Return the moments of a solid cylinder: a rod at radius 0, a thin disc at length 0."""
    cross = mass * (3.0 * radius**2 + length**2) / 12.0
    return 0.5 * mass * radius**2, cross, cross


def cylinder_mass(density: float, radius: float, length: float) -> float:
    """Return the mass of a solid cylinder (kg)."""
    return density * math.pi * radius**2 * length


def ball(mass: float, radius: float) -> tuple[float, float, float]:
    """Return the moments of a solid ball."""
    moment = 0.4 * mass * radius**2
    return moment, moment, moment


def along_x(axis: np.ndarray) -> tuple[float, ...]:
    """Return Euler parameters of a frame whose x axis is the unit ``axis`` (3,)."""
    axes = frame(axis)
    return tuple(euler_parameters(np.column_stack([axis, axes[:, 0], axes[:, 1]])).tolist())
