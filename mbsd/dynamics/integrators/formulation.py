"""What explicit integrators call, for either formulation: reference coordinates (Dynamics) or independent (Embedding).

A loop is written once, in the words below, and compiled for each formulation with that formulation's kernels in their
place, as its first argument says (mbsd/compiling/alternatives.py).

    accelerate(dyn, scratch, t, state, a, lam)    fill a (n,) and, in reference coordinates, lam (m,) at a state (2, n)
                                                  and time (s); returns the power of loads and drivers (W), not a
                                                  number where independent coordinates have no clear pose
    derivative(dyn, scratch, t, state, out, lam)  out (2, n) = d(state)/dt; otherwise as accelerate
    project(dyn, scratch, t, state, passes)       bring a state onto its constraints; independent coordinates are never
                                                  off them
    settle(dyn, scratch, t, state, fresh)         take a state as accepted, ``fresh`` if it was the last to be
                                                  evaluated; returns whether other coordinates should be looked for
    record(dyn, scratch, out, k, t, work)         write output k from scratch.state; returns whether its pose is clear
    record_all(dyn, scratch, out, k, t, work)     the same for loops over many outputs, which contain the evaluation
    keep_row(dyn, scratch, out, k)                keep output k as the pose before an unclear one
    join_rows(dyn, scratch, out, k, apart)        put output k between the pose kept and its own
    record_here(dyn, scratch, state, out)         write the next output from the state itself, which stands at its time
    begin_run(dyn, scratch, state)                fill dy at a start or restart
"""

from __future__ import annotations

from mbsd.compiling.alternatives import alternatives
from mbsd.compiling.jit import inlined
from mbsd.dynamics import state as run_state
from mbsd.dynamics.independent import equations
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.reference import acceleration, projection
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.state import EVALUATIONS, POWER, STARTED, TIME


@inlined
def _stay(dyn, scratch, t, state, passes):
    pass


@inlined
def _go_on(dyn, scratch, t, state, fresh):
    return False


@inlined
def _record(dyn, scratch, out, k, t, work):
    run_state.record(dyn, scratch, out, k, work)
    return True


@inlined
def _record_here(dyn, scratch, state, out):
    run_state.record_here(scratch, state, out)


@inlined
def _keep_row(dyn, scratch, out, k):
    pass


@inlined
def _join_rows(dyn, scratch, out, k, apart):
    pass


accelerate = alternatives({Dynamics: acceleration.accelerate, Embedding: equations.accelerate})
derivative = alternatives({Dynamics: acceleration.derivative, Embedding: equations.derivative})
project = alternatives({Dynamics: projection.project, Embedding: _stay})
settle = alternatives({Dynamics: _go_on, Embedding: equations.settle})
record = alternatives({Dynamics: _record, Embedding: equations.record})
record_all = alternatives({Dynamics: _record, Embedding: equations.record_all})
keep_row = alternatives({Dynamics: _keep_row, Embedding: equations.keep_row})
join_rows = alternatives({Dynamics: _join_rows, Embedding: equations.join_rows})
record_here = alternatives({Dynamics: _record_here, Embedding: equations.record_here})


@inlined
def begin_run(dyn, scratch, state):
    """Make dy valid at a start or restart."""
    if state.count[STARTED] == 0:
        state.clock[POWER] = derivative(dyn, scratch, state.clock[TIME], state.y, state.dy, state.lam)
        settle(dyn, scratch, state.clock[TIME], state.y, True)
        state.count[EVALUATIONS] += 1
        state.count[STARTED] = 1
