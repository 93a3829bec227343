"""The compiled loop over states of simulations that are done: their multipliers and Jacobians."""

from __future__ import annotations

from mbsd.compiling.jit import threaded
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.state import REACHED
from mbsd.equations.assembly import position


@threaded
def tabulate_reactions(
    dyn, scratch, block, fresh, place, value, t, over, y, status, rows, jacobians, lam, margin, known
):
    """Fill ``rows`` (k,) of J into compact jacobians (R, T, k, 6) and, unless ``known``, lam (R, T, m), margin (R, T).

    States are y (R, T, 2, 3 nb), at t (T,) (s) or, where that is earlier, at ``over`` (R,).

    Rows of ``block``, ``fresh``, ``place`` and ``value`` are those of run_rows, for Dynamics and its scratch alone.
    """
    for r in range(y.shape[0]):
        if status[r] != REACHED:
            continue
        own = min(r, fresh.shape[0] - 1)
        for i in range(block.shape[0]):
            block[i] = fresh[own, i]
        for i in range(place.shape[0]):
            block[place[i]] = value[r, i]
        for k in range(t.shape[0]):
            if not known:
                derivative(dyn, scratch, min(t[k], over[r]), y[r, k], scratch.stages[0], lam[r, k])
                margin[r, k] = scratch.report[0]
            if rows.shape[0] == 0:
                continue
            position(dyn.system, y[r, k, 0], scratch.drive, scratch.ws)
            for i in range(rows.shape[0]):
                for c in range(6):
                    jacobians[r, k, i, c] = scratch.ws.jac[rows[i], c]
