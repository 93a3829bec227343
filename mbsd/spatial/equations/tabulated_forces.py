"""Forces along a motion, for callers in Python."""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.spatial.equations.evaluation import evaluate_position
from mbsd.spatial.equations.forces import apply_forces


@kernel
def tabulate_forces(system, laws, times, drives, q, v, turns, ws, load, lam):
    """Fill load (T, 3 + 6 n) and lam (T, m) with all forces along q (T, 3 + 7 n) and v (T, 3 + 6 n)."""
    for k in range(q.shape[0]):
        for n in range(ws.guess.shape[0]):
            ws.guess[n] = turns[k, n]
        evaluate_position(system, q[k], drives[k], ws)
        apply_forces(system, laws, times[k], v[k], ws, load[k], lam[k])
