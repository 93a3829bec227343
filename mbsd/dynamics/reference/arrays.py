"""Arrays of forward dynamics: what is constant during a run (Dynamics) and what every evaluation overwrites (Scratch).

A state is an array (2, 3 nb): coordinates, then velocities; ground's entries stay zero.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.compiling.jit import inlined
from mbsd.dynamics.reference.schur import SchurFactors, schur_factors
from mbsd.dynamics.reference.sliding import Sliding
from mbsd.equations.system import System


class Dynamics(NamedTuple):
    """A mechanism as integrators read it."""

    system: Any
    """mbsd.equations.system.System"""
    laws: Any
    """mbsd.equations.laws.Laws: 1 .. drivers are the drivers' laws of time."""
    loads: Any
    """mbsd.equations.loads.Loads"""
    schur: Any
    """mbsd.dynamics.reference.schur.Schur"""
    sliding: Sliding
    """Contacts with friction."""
    inertia: Any
    """(3 nb,) diagonal of M: kg, kg, kg m^2."""
    inverse: Any
    """(3 nb,) of M, lifted a little where M is zero; 0 for ground."""
    metric: Any
    """(3 nb,) inverse of the metric of projections: M, a usual inertia where M is zero; 0 for ground."""
    weight: Any
    """(3 nb,) M g."""
    passes: int
    """Solutions of the equations of motion: 1, or more to refine where bodies lack mass."""
    baumgarte: Any
    """(2,) alpha and beta of the stabilisation (1/s); zero turns it off."""
    per_size: Any
    """(3 nb,) what makes coordinates dimensionless: 1 / size for x and y, 1 for theta."""


class FullMatrices(NamedTuple):
    """Room for k matrices of size N with their right-hand sides."""

    value: Any
    """(k, N, N)"""
    pivot: Any
    """(k, N) row exchanged with each row."""
    side: Any
    """(k, N) right-hand sides, then solutions."""


def full_matrices(count: int, size: int) -> FullMatrices:
    """Room for ``count`` matrices of ``size`` rows."""
    return FullMatrices(np.zeros((count, size, size)), np.zeros((count, size), np.int64), np.zeros((count, size)))


class Scratch(NamedTuple):
    """Scratch of one thread."""

    ws: Any
    """mbsd.equations.system.Workspace"""
    factors: SchurFactors
    drive: Any
    """(drivers + 1, 3) value, rate and acceleration of the laws now."""
    force: Any
    """(3 nb,) what is left of Q."""
    multipliers: Any
    """(m,) that nobody keeps."""
    change: Any
    """(2, 3 nb) of a projection."""
    state: Any
    """(2, 3 nb) trial state of a stage."""
    stages: Any
    """(stages, 2, 3 nb) derivatives."""
    power: Any
    """(stages,) of loads and drivers (W)."""
    dense: Any
    """(8, 2, 3 nb) coefficients of a dense output."""
    dense_work: Any
    """(7,) the same for the work (J)."""
    full: FullMatrices
    """Matrices of implicit methods."""
    report: Any
    """(4,) margin of the last factors; first and last change of the last projection (sizes, rad)."""


@inlined
def without_contacts(dyn, contacts):
    """Return the mechanism without its contacts: a fifth less to do in steps in which all are open."""
    system = dyn.system
    bare = System(
        system.mass,
        system.inertia,
        system.gravity,
        system.marker_body,
        system.marker_arm,
        system.marker_axis,
        system.moving,
        system.directed,
        system.point,
        system.angle,
        system.slot,
        system.along,
        system.distance,
        contacts.special,
        system.address,
        system.numbers,
        system.driven,
        system.row_body,
        system.angle_offset,
        system.distance_length,
    )
    return Dynamics(
        bare,
        dyn.laws,
        dyn.loads,
        contacts.schur,
        contacts.friction.none,
        dyn.inertia,
        dyn.inverse,
        dyn.metric,
        dyn.weight,
        dyn.passes,
        dyn.baumgarte,
        dyn.per_size,
    )


def scratch_for(
    dynamics: Dynamics, workspace: Any, drivers: int, stages: int, matrices: tuple[int, int] = (0, 0)
) -> Scratch:
    """Scratch for one run with an integrator of so many stages and full matrices (and their rows by coordinate)."""
    n3 = len(dynamics.inertia)
    return Scratch(
        ws=workspace,
        factors=schur_factors(dynamics.schur),
        drive=np.zeros((drivers + 1, 3)),
        force=np.zeros(n3),
        multipliers=np.zeros(len(workspace.phi)),
        change=np.zeros((2, n3)),
        state=np.zeros((2, n3)),
        stages=np.zeros((stages, 2, n3)),
        power=np.zeros(stages),
        dense=np.zeros((8, 2, n3)),
        dense_work=np.zeros(7),
        full=full_matrices(matrices[0], matrices[1] * (n3 - 3)),
        report=np.zeros(4),
    )
