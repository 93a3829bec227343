"""Preparation of a mechanism for motions: mobility, closed start pose, elimination sequence, groups."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.arrays.laws import refuse_bad_laws
from mbsd.arrays.packing import Packed, pack
from mbsd.base.errors import AssemblyError, ModelError
from mbsd.base.running import Kept
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.equations.relative.equation import ACTIVE, ROW
from mbsd.kinematics.elimination import Elimination, Factors, plan
from mbsd.kinematics.groups.blocks import Blocks, no_blocks
from mbsd.kinematics.groups.groups import Groups
from mbsd.kinematics.groups.parts import plan_parts
from mbsd.kinematics.groups.plan import describe, plan_groups
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.pose.mobility import choose_rows, joint_mobility, refuse_overdriven
from mbsd.model.mechanism import Model
from mbsd.results.views import Mobility


@dataclass
class Prepared:
    """A mechanism ready to be solved over and over: arrays, closed start pose, elimination sequence."""

    packed: Packed
    q0: np.ndarray
    """(3 nb,) closed start pose."""
    start_time: float
    sequence: Elimination
    factors: Factors
    mobility: Mobility
    groups: Groups | None
    """Groups and blocks of the mechanism, if it has any; else Newton-Raphson solves it as a whole."""
    blocks: Blocks
    """Blocks that no closed form covers."""
    proved: bool = False
    """True if joints that repeat others are sure to hold where these do not."""

    @property
    def route(self) -> str:
        """How positions are found, as long as no two assemblies meet on the way."""
        if self.groups is None:
            return "Newton-Raphson"
        how = "by parts" if len(self.blocks.head) else "closed form"
        return f"{how}: {describe(self.groups, self.blocks, self.packed.body_names)}"


_SAMPLES: Kept[np.ndarray] = Kept()


def sample_jacobians(packed: Packed) -> np.ndarray:
    """Return (4, m, n) at unrelated poses, to see which entries are constant."""
    numbers = packed.numbers()
    return _sampled(packed) if numbers is None else _SAMPLES.get(numbers, lambda: _sampled(packed))


def _sampled(packed: Packed) -> np.ndarray:
    random = np.random.default_rng(2)
    none = np.zeros((len(packed.motions) + 1, 3))
    samples = []
    special, rows = packed.system.special.copy(), packed.system.special[:, ROW]
    special[:, ACTIVE] = 0  # their entries may be constant here and there, as in the dwell of a Geneva: none counts
    system = packed.system.changed(special=special)
    for _ in range(4):
        q = np.zeros(3 * len(packed.body_names))
        q[3:] = random.uniform(-2.0, 2.0, packed.coordinates) * packed.column_scale()
        residual_and_jacobian(system, q, none, packed.ws)
        packed.ws.jac[rows] = random.uniform(1.0, 2.0, (len(rows), 6))
        samples.append(packed.jacobian())
    return np.array(samples)


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
