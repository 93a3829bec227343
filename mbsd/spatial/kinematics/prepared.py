"""Preparation of a driven motion: a closed start, its mobility, and a plan of elimination."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.arrays.laws import compiled_laws, pack_laws, refuse_bad_laws
from mbsd.base.errors import ModelError
from mbsd.equations.laws import Laws
from mbsd.kinematics.elimination import Elimination, Factors, plan
from mbsd.results.views import Mobility
from mbsd.spatial.arrays.packing import Packed, pack
from mbsd.spatial.kinematics.close import assemble
from mbsd.spatial.kinematics.mobility import choose_rows, joint_mobility, refuse_shared_friction
from mbsd.spatial.model.mechanism import Model


@dataclass
class Prepared:
    """A mechanism that is ready to be swept."""

    packed: Packed
    q0: np.ndarray
    """(3 + 7 n,) closed start pose."""
    turns: np.ndarray
    """Counted turns at the start (rad)."""
    sequence: Elimination
    factors: Factors
    mobility: Mobility
    laws: Laws
    """Laws of drivers and forces; empty where no force has one."""


def prepare(m: Model, start: float = 0.0, end: float = 1.0) -> Prepared:
    """Check mobility and close the start pose of ``m`` for a motion from ``start`` to ``end`` (s)."""
    packed = packed_checked(m)
    packed.settle_laws(start, end)
    same_fields: Any = packed
    refuse_bad_laws(same_fields, start, end)
    rolling = [joint.name for joint in m.joints.values() if joint.kind.holds_rates]
    if rolling:
        raise ModelError(
            f"{m.name}: '{rolling[0]}' rolls, so no value of the drivers says where it is. Call simulate; a sweep "
            "needs joints that hold places"
        )
    q0, turns = assemble(m, packed, start)
    mobility = joint_mobility(packed, q0)
    refuse_shared_friction(packed, mobility)
    kept = choose_rows(packed, q0, start, mobility)
    laws = compiled_laws(same_fields, start, end) if any(force.laws for force in packed.forces) else pack_laws(())
    return Prepared(packed, q0, turns, *planned(packed, kept), mobility, laws)


def packed_checked(m: Model) -> Packed:
    """Return the arrays of a mechanism with a body at least. Raises ModelError."""
    if len(m.bodies) < 2:
        raise ModelError(f"{m.name}: there is no body besides ground; add one with m.body(...) or m.rod(...)")
    return pack(m)


def planned(packed: Packed, kept: np.ndarray) -> tuple[Elimination, Factors]:
    """Return the elimination of rows ``kept`` (6 n,), whose constant entries come first."""
    random = np.random.default_rng(2)
    samples = []
    for _ in range(4):
        q = random.uniform(-2.0, 2.0, len(packed.design)) * packed.size
        samples.append(packed.measured(q)[1])
    return plan(np.array(samples), kept, packed.system.row_body, width=6)


def mobility(m: Model) -> Mobility:
    """Return degrees of freedom and redundant joints at the start, at time 0; see Mechanism.mobility."""
    packed = packed_checked(m)
    packed.settle_laws(0.0, 1.0)
    q0, _ = assemble(m, packed, 0.0)
    return joint_mobility(packed, q0)
