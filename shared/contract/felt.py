"""Reaction on the body that moves: the second one, or the first if the second is ground."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from shared.contract.loads import ContactMotion
from shared.contract.motion import JointMotion

Array = NDArray[np.float64]


class Felt(NamedTuple):
    """Reaction over time."""

    place: Array
    """(T, 2) where it acts (m)."""
    force: Array
    """(T, 2) world axes (N)."""
    torque: Array
    """(T,) about that place (N m), positive counter-clockwise."""


def felt(connection: JointMotion | ContactMotion) -> Felt:
    """Return the reaction with the sign for that body.

    The file data.json has it as the second body feels it.
    """
    at = connection.acts or connection
    sign = -1.0 if connection.bodies[1] == "ground" else 1.0
    place = np.array([at.x, at.y], float).T
    force = np.array([connection.fx, connection.fy], float).T
    return Felt(place, sign * force, sign * np.asarray(at.torque, float))
