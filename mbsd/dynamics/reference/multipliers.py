"""Multipliers and margins of outputs that were found without them."""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.dynamics.reference.acceleration import derivative


@kernel
def fill_multipliers(dyn, scratch, out):
    """Fill out.lam and out.margin from out.t and out.y; accelerations stay."""
    for k in range(out.t.shape[0]):
        derivative(dyn, scratch, out.t[k], out.y[k], scratch.stages[0], out.lam[k])
        out.margin[k] = scratch.report[0]
