"""Rows of J at a pose, compiled for the loops over many simulations."""

from __future__ import annotations

from mbsd.compiling.jit import apart
from mbsd.equations.assembly import position
from mbsd.equations.laws import evaluate_laws


@apart
def measure(dyn, scratch, t, q):
    """Fill scratch.ws.phi and scratch.ws.jac at q (3 nb,) and t (s)."""
    if scratch.drive.shape[0] > 1:
        evaluate_laws(dyn.laws, scratch.drive.shape[0], t, scratch.drive)
    position(dyn.system, q, scratch.drive, scratch.ws)
