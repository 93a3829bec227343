"""Velocities that drivers impose, as kernels give them.

They have a file of their own, so that no other edit recompiles it.
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.equations.assembly import evaluate_nu


@kernel
def fill_nu(system, drive, nu):
    """Fill nu (m,) for the values, rates and accelerations ``drive`` (motions, 3) of the laws."""
    evaluate_nu(system, drive, nu)
