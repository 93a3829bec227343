"""Mobility of a mechanism of any size."""

from __future__ import annotations

from mbsd.arrays.packing import pack
from mbsd.dynamics.prepare.large import MANY_COORDINATES, mobility_large
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.pose.mobility import joint_mobility
from mbsd.model.mechanism import Model
from mbsd.results.mobility import Mobility


def mobility(m: Model) -> Mobility:
    """Mobility of the joints of ``m`` at its start; raises AssemblyError if it does not close."""
    packed = pack(m)
    if packed.coordinates > MANY_COORDINATES:
        return mobility_large(m, packed)
    q = assemble(m, packed, 0.0)
    return joint_mobility(packed, q)
