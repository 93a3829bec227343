"""One solution of the equations of motion for what is left of them.

    S y = J (a + W^-1 (Q - M a)) - gamma,   lam += y,   Q -= J^T y,   a += W^-1 (Q - M a)

Q: the loads less J^T lam so far. From a = 0 and lam = 0 this is the solution itself where W is M. What the last
solution left, or what was added to Q since, a further one solves for.
"""

from __future__ import annotations

from mbsd.dynamics.schur import solve_schur, subtract_forces, times_jacobian
from mbsd.jit import inlined


@inlined
def balance(dyn, scratch, gamma, a, lam):
    """Improve a (3 nb,) and lam (m,) after factor_schur; scratch.force is Q, gamma (m,) the right-hand side."""
    schur = dyn.schur
    ws = scratch.ws
    factors = scratch.factors
    force = scratch.force
    y = factors.side
    n3 = a.shape[0]
    for c in range(3, n3):
        ws.pose[c] = a[c] + dyn.inverse[c] * (force[c] - dyn.inertia[c] * a[c])
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[k, s]
            y[k, s, 0] = times_jacobian(factors, schur, k, s, ws.pose) - gamma[r] if r >= 0 else 0.0
    solve_schur(schur, factors, 1)
    subtract_forces(factors, schur, 0, force)
    for c in range(3, n3):
        a[c] += dyn.inverse[c] * (force[c] - dyn.inertia[c] * a[c])
    for k in range(schur.rows.shape[0]):
        for s in range(2):
            r = schur.rows[k, s]
            if r >= 0:
                lam[r] += y[k, s, 0]
