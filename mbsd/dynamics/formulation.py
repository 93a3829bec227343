"""Operations of a formulation, which integrators and events call for any choice of coordinates.

    q' = N(q) v        M a + J^T lam = Q        J a = gamma

A state is an array y (2, n): n coordinates q, then the velocities v behind one another; where there are fewer of these
their last entries stay zero. Three idle entries, those of ground, stand in front. M is diagonal. In the plane q' = v;
in space four Euler parameters change by three rates.

A loop is written once, in the operations below, and compiled for each formulation with its kernels in their place, as
its first argument says (mbsd/compiling/alternatives.py). ``dyn`` is Dynamics (reference coordinates), Embedding
(independent coordinates), or a class of named tuples that :func:`add_formulation` has added. It has the fields of
Dynamics that a loop reads: inertia, inverse, weight, schur.rows, sliding.table, loads.switch, per_size.

What every formulation has:

    accelerate(dyn, scratch, t, state, a, lam)    fill a (n,) and, in reference coordinates, lam (m,) at a state (2, n)
                                                  and time (s); returns the power of loads and drivers (W), not a
                                                  number where independent coordinates have no clear pose
    project(dyn, scratch, t, state, passes)       bring a state onto its constraints; the largest changes in the first
                                                  and last pass go to scratch.report[1:3]

What has a default, which is that of the plane:

    derivative(dyn, scratch, t, state, out, lam)  fill out (2, n) with d(state)/dt; otherwise as accelerate
    rates(dyn, q, v, out)                         out (n,) = q' = N(q) v
    bends(dyn, state, dy, out)                    out (n,) = q'' where d(state)/dt is dy (2, n)
    speeds(dyn, q, rate)                          rate (n,), which is q', becomes v
    shift(dyn, q, c, way, out)                    fill out (n,) with q (n,) moved by about ``way`` along its c-th
                                                  velocity; returns the way itself
    settle(dyn, scratch, t, state, fresh)         take a state as accepted, ``fresh`` if it was the last to be
                                                  evaluated; returns whether other coordinates should be looked for
    record(dyn, scratch, out, k, t, work)         write output k from scratch.state; returns whether its pose is clear
    record_all(dyn, scratch, out, k, t, work)     the same for loops over many outputs, which contain the evaluation
    keep_row(dyn, scratch, out, k)                keep output k as the pose before an unclear one
    join_rows(dyn, scratch, out, k, apart)        put output k between the pose kept and its own
    record_here(dyn, scratch, state, out)         write the next output from the state itself, which stands at its time
    observe(dyn, state, part, c)                  the number of a state (2, n) that a measure of many runs waits for

What functions of the user read of a state is chosen by the class of their arrays (events/users.py).

What the loop of events needs beside (reference coordinates):

    measure(dyn, scratch, t, q)                   fill scratch.ws.phi (m,) and J at q and t
    measure_gaps(dyn, scratch, t, q)              the same of the rows that events switch alone; copied into its caller
    along(dyn, scratch, row, u)                   the row of J times u (n,)
    push(dyn, scratch, row, size, force)          add J^T to force (n,), of this row alone and ``size`` times
    respond(dyn, scratch, force, moving, a, lam)  fill a, lam under ``force``, which is overwritten, after derivative;
                                                  gamma, which stands in scratch.ws.right[0], is taken ``moving`` times
    without_contacts(dyn, contacts)               dyn while all contacts are open

Derivatives of a run (mbsd/derivatives/formulations.py) read per_size and call ``derivative`` alone, and at events what
the loop of events calls.
"""

from __future__ import annotations

from typing import Any

from mbsd.compiling.alternatives import Alternatives, alternatives
from mbsd.compiling.jit import inlined, shared
from mbsd.dynamics.independent import equations
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.reference import acceleration, projection, refinement
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.dynamics.reference.arrays import without_contacts as without_contacts_in_plane
from mbsd.dynamics.state import EVALUATIONS, POWER, STARTED, TIME
from mbsd.dynamics.state import record_here as record_state

OPEN, CONTRACTION = 1e-4, 0.1
"""A second pass that moves coordinates by less (sizes, rad) leaves the square of that; one that moves them by more,
and by more than this part of the first pass, does not lead to a pose near the step's."""


@inlined
def _copy_velocities(dyn, q, v, out):
    for c in range(3, q.shape[0]):
        out[c] = v[c]


@inlined
def _copy_accelerations(dyn, state, dy, out):
    for c in range(3, state.shape[1]):
        out[c] = dy[1, c]


@inlined
def _keep_rate(dyn, q, rate):
    pass


@inlined
def _shift(dyn, q, c, way, out):
    for i in range(3, q.shape[0]):
        out[i] = q[i]
    out[c] = q[c] + way
    return out[c] - q[c]


@inlined
def _stay(dyn, scratch, t, state, passes):
    pass


@inlined
def _settle(dyn, scratch, t, state, fresh):
    return False


@inlined
def _record(dyn, scratch, out, k, t, work):
    record_output(dyn, scratch, out, k, work)
    return True


@inlined
def _record_here(dyn, scratch, state, out):
    record_state(scratch, state, out)


@inlined
def _observe(dyn, state, part, c):
    return state[part, c]


@inlined
def _keep_row(dyn, scratch, out, k):
    pass


@inlined
def _join_rows(dyn, scratch, out, k, apart):
    pass


@shared
def _differentiate(dyn, scratch, t, state, out, lam):
    rates(dyn, state[0], state[1], out[0])
    return accelerate(dyn, scratch, t, state, out[1], lam)


accelerate = alternatives({Dynamics: acceleration.accelerate, Embedding: equations.accelerate})
project = alternatives({Dynamics: projection.project, Embedding: _stay})
derivative = alternatives({Embedding: equations.derivative}, _differentiate)
rates = alternatives({}, _copy_velocities)
bends = alternatives({}, _copy_accelerations)
speeds = alternatives({}, _keep_rate)
shift = alternatives({}, _shift)
settle = alternatives({Embedding: equations.settle}, _settle)
record = alternatives({Embedding: equations.record}, _record)
record_all = alternatives({Embedding: equations.record_all}, _record)
keep_row = alternatives({Embedding: equations.keep_row}, _keep_row)
join_rows = alternatives({Embedding: equations.join_rows}, _join_rows)
record_here = alternatives({Embedding: equations.record_here}, _record_here)
observe = alternatives({}, _observe)
measure = alternatives({Dynamics: projection.measure})
measure_gaps = alternatives({Dynamics: projection.measure_gaps})
along = alternatives({Dynamics: projection.along})
push = alternatives({Dynamics: projection.push})
respond = alternatives({Dynamics: refinement.respond})
without_contacts = alternatives({Dynamics: without_contacts_in_plane})

_OPERATIONS: dict[str, Alternatives] = {
    name: kernels for name, kernels in list(globals().items()) if isinstance(kernels, Alternatives)
}


def add_formulation(kind: type, **kernels: Any) -> None:
    """Add a class of named tuples with its kernels by operation; those with a default may be left out.

    Raises TypeError for an unknown operation or a missing one, and ValueError for a class that was added before.
    """
    for name in kernels:
        if name not in _OPERATIONS:
            raise TypeError(f"{kind.__name__}: there is no operation '{name}'")
    for name in ("accelerate", "project"):
        if name not in kernels:
            raise TypeError(f"{kind.__name__}: '{name}' is missing")
    for name, kernel in kernels.items():
        _OPERATIONS[name].add(kind, kernel)


def has_same_rates(kind: type) -> bool:
    """Return True if q' = v in a formulation, as in the plane: it brings no ``rates`` of its own."""
    return rates.kernel_of(kind) is _copy_velocities


@inlined
def begin_run(dyn, scratch, state):
    """Make dy valid at a start or restart."""
    if state.count[STARTED] == 0:
        state.clock[POWER] = derivative(dyn, scratch, state.clock[TIME], state.y, state.dy, state.lam)
        settle(dyn, scratch, state.clock[TIME], state.y, True)
        state.count[EVALUATIONS] += 1
        state.count[STARTED] = 1


@shared
def record_output(dyn, scratch, out, k, work):
    """Write output k from scratch.state, projected first."""
    state = scratch.state
    t = out.t[k]
    project(dyn, scratch, t, state, 2)
    for c in range(state.shape[1]):
        out.y[k, 0, c] = state[0, c]
        out.y[k, 1, c] = state[1, c]
    out.work[k] = work
    if out.lam.shape[0] > 0:
        accelerate(dyn, scratch, t, state, out.a[k], out.lam[k])
        out.margin[k] = scratch.report[0]


@inlined
def close_step(dyn, scratch, t, state):
    """Project a state (2, n) that a step of fixed length has led to, at its end t (s); returns whether it closes.

    Numbers that are none count as closed: they are looked for elsewhere.
    """
    project(dyn, scratch, t, state, 2)
    if scratch.report[2] > OPEN:
        if scratch.report[2] > CONTRACTION * scratch.report[1]:
            return False
        project(dyn, scratch, t, state, 2)
    return not scratch.report[2] > OPEN
