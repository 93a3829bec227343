"""Five steps of RATTLE as one of order 4: symplectic, time-reversible, for long runs without friction.

    h p, h p, h (1 - 4 p), h p, h p,      p = 1 / (4 - 4^(1/3)) = 0.4145

The third goes back in time. Errors are far smaller than those of the composition of three.

Source: Suzuki 1990, Phys. Lett. A 146; Hairer, Lubich, Wanner, Geometric Numerical Integration, II.4; see rattle.py.
"""

from __future__ import annotations

from mbsd.compiling.jit import kernel
from mbsd.dynamics.integrators.kind import Integrator, register, without_sliding
from mbsd.dynamics.integrators.rattle import STAGES, march


@kernel
def advance(dyn, scratch, state, out, settings, end, max_steps):
    """Go on to ``end`` (s), ``max_steps`` steps at most, writing the outputs passed. Returns a status."""
    return march(dyn, scratch, state, out, settings, end, max_steps, 5)


SYMPLECTIC = register(Integrator("symplectic", advance, STAGES, order=4, fixed_step=True, refusal=without_sliding))
