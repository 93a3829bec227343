"""Baumgarte's stabilisation, for teaching: RK4 without projection, errors of the constraints are pulled to zero.

    J a = gamma - 2 alpha (J v - nu) - beta^2 Phi

Errors of the constraints then follow e'' + 2 alpha e' + beta^2 e = what a step adds, critically damped where alpha =
beta. They stay small and are never zero, and there is no best alpha: too small and the joints come open, too large
(alpha times the step above 2.7) and the run blows up. Projection, as all other methods here do it, has neither fault.
Reactions hold the pull of the stabilisation too.

Options: alpha, beta (1/s), both 10 if not given; alpha = 0 shows the bare drift.

Source: Baumgarte 1972, Comp. Meth. Appl. Mech. Eng. 1; Flores et al. 2011, J. Comput. Nonlinear Dyn. 6 (alpha).
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.dynamics.integrators.kind import Integrator, Option, register
from mbsd.dynamics.integrators.rk4 import STAGES, march


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` steps at most, writing the outputs passed. Returns a status."""
    dyn.baumgarte[0] = settings.options[0]
    dyn.baumgarte[1] = settings.options[1]
    status = march(dyn, scratch, state, out, settings, end, max_steps, False)
    dyn.baumgarte[0] = 0.0
    dyn.baumgarte[1] = 0.0
    return status


BAUMGARTE = register(
    Integrator(
        "baumgarte",
        advance,
        STAGES,
        order=4,
        fixed_step=True,
        options={"alpha": Option(10.0, 0.0, 1e9), "beta": Option(10.0, 0.0, 1e9)},
    )
)
