"""Preparation of a mechanism: mobility, closed start pose, elimination sequence, groups."""

from __future__ import annotations

from mbsd.arrays.driver_laws import refuse_bad_laws
from mbsd.arrays.packing import pack
from mbsd.base.errors import AssemblyError, ModelError
from mbsd.kinematics.elimination import plan
from mbsd.kinematics.groups.blocks import no_blocks
from mbsd.kinematics.groups.parts import plan_parts
from mbsd.kinematics.groups.plan import plan_groups
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.pose.mobility import choose_rows, joint_mobility, refuse_overdriven
from mbsd.kinematics.prepared import Prepared
from mbsd.kinematics.sample_jacobians import sample_jacobians
from mbsd.model.mechanism import Model


def prepare_beside(m: Model, other: Prepared, start: float, end: float) -> Prepared:
    """Return the preparation of ``m``, which differs from that of ``other`` in numbers alone.

    Its mobility and its plan are the same.

    Newton-Raphson solves it as a whole. It takes a fraction of the time where a mechanism is large, and a motion of few
    steps. Raises ModelError and AssemblyError as :func:`prepare` does.
    """
    if other.mobility.redundant_rows:
        return prepare(m, start, end)
    packed = pack(m)
    packed.settle_laws(start, end)
    refuse_bad_laws(packed, start, end)
    q0 = assemble(m, packed, start)
    return Prepared(packed, q0, start, other.sequence, other.factors, other.mobility, None, no_blocks())


def prepare(m: Model, start: float = 0.0, end: float = 1.0) -> Prepared:
    """Check mobility and close the start pose of ``m`` for a motion from ``start`` to ``end`` (s)."""
    if len(m.bodies) < 2:
        raise ModelError(f"{m.name}: there is no body beside ground; add one with m.bar(...) or m.body(...)")
    packed = pack(m)
    packed.settle_laws(start, end)
    refuse_bad_laws(packed, start, end)
    try:
        q0 = assemble(m, packed, start)
    except AssemblyError:
        refuse_overdriven(m, packed, start)
        raise
    mobility = joint_mobility(packed, q0)
    kept = choose_rows(packed, q0, start, mobility)
    samples = sample_jacobians(packed)
    sequence, factors = plan(samples, kept, packed.system.row_body)
    groups, blocks = plan_groups(packed, q0, mobility.redundant_rows), no_blocks()
    if groups is None:
        parts = plan_parts(packed, q0, (samples != 0.0).any(axis=0), kept)
        if parts is not None:
            return Prepared(packed, q0, start, sequence, factors, mobility, *parts)
    return Prepared(packed, q0, start, sequence, factors, mobility, groups, blocks)
