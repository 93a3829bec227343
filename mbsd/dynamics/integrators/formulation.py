"""What explicit integrators call, for either formulation: reference coordinates (Dynamics) or independent (Embedding).

Which one is meant is known when a loop is compiled, from the type of its first argument: nothing is asked at run time.
"""

from __future__ import annotations

from typing import Any

from numba.extending import overload

from mbsd.compiling.jit import inlined
from mbsd.dynamics import state as run_state
from mbsd.dynamics.embedding import equations, records
from mbsd.dynamics.embedding.arrays import Embedding
from mbsd.dynamics.reference import acceleration, projection
from mbsd.dynamics.state import EVALUATIONS, POWER, STARTED, TIME


def accelerate(dyn: Any, scratch: Any, t: float, state: Any, a: Any, lam: Any) -> float:
    """Fill a (n,) and, in reference coordinates, lam (m,) at a state (2, n) and time (s).

    Returns the power of loads and drivers (W); not a number where independent coordinates have no clear pose.
    """
    return (equations if isinstance(dyn, Embedding) else acceleration).accelerate(dyn, scratch, t, state, a, lam)


def derivative(dyn: Any, scratch: Any, t: float, state: Any, out: Any, lam: Any) -> float:
    """out (2, n) = d(state)/dt; otherwise as ``accelerate``."""
    return (equations if isinstance(dyn, Embedding) else acceleration).derivative(dyn, scratch, t, state, out, lam)


def project(dyn: Any, scratch: Any, t: float, state: Any, passes: int) -> None:
    """Bring a state onto its constraints; independent coordinates are never off them."""
    if not isinstance(dyn, Embedding):
        projection.project(dyn, scratch, t, state, passes)


def settle(dyn: Any, scratch: Any, t: float, state: Any, fresh: bool) -> bool:
    """Take a state as accepted; ``fresh`` if it was the last to be evaluated.

    Returns whether other independent coordinates should be looked for.
    """
    return bool(equations.settle(dyn, scratch, t, state, fresh)) if isinstance(dyn, Embedding) else False


def record(dyn: Any, scratch: Any, out: Any, k: int, t: float, work: float) -> bool:
    """Write output k from scratch.state at t (s); returns whether its pose is clear."""
    if isinstance(dyn, Embedding):
        return bool(records.record(dyn, scratch, out, k, t, work))
    run_state.record(dyn, scratch, out, k, work)
    return True


def keep_row(dyn: Any, scratch: Any, out: Any, k: int) -> None:
    """Keep output k as the pose before an unclear one."""
    if isinstance(dyn, Embedding):
        records.keep_row(scratch, out, k)


def join_rows(dyn: Any, scratch: Any, out: Any, k: int, apart: float) -> None:
    """Put output k in the middle between the pose kept and its own, ``apart`` seconds later."""
    if isinstance(dyn, Embedding):
        records.join_rows(scratch, out, k, apart)


def record_here(dyn: Any, scratch: Any, state: Any, out: Any) -> None:
    """Write the next output from the state itself, which stands at its time."""
    if isinstance(dyn, Embedding):
        records.record_here(dyn, scratch, state, out)
    else:
        run_state.record_here(scratch, state, out)


@inlined
def begin(dyn, scratch, state):
    """Make dy valid at a start or restart."""
    if state.count[STARTED] == 0:
        state.clock[POWER] = derivative(dyn, scratch, state.clock[TIME], state.y, state.dy, state.lam)
        settle(dyn, scratch, state.clock[TIME], state.y, True)
        state.count[EVALUATIONS] += 1
        state.count[STARTED] = 1


@overload(accelerate, inline="always")
def _accelerate(dyn, scratch, t, state, a, lam):
    # the function itself: handing both tuples on to another one costs more than the work
    return (equations if dyn.instance_class is Embedding else acceleration).accelerate.py_func


@overload(derivative, inline="always")
def _derivative(dyn, scratch, t, state, out, lam):
    chosen = (equations if dyn.instance_class is Embedding else acceleration).derivative
    return lambda dyn, scratch, t, state, out, lam: chosen(dyn, scratch, t, state, out, lam)


@overload(project, inline="always")
def _project(dyn, scratch, t, state, passes):
    if dyn.instance_class is Embedding:
        return lambda dyn, scratch, t, state, passes: None
    chosen = projection.project
    return lambda dyn, scratch, t, state, passes: chosen(dyn, scratch, t, state, passes)


@overload(settle, inline="always")
def _settle(dyn, scratch, t, state, fresh):
    if dyn.instance_class is Embedding:
        return equations.settle.py_func
    return lambda dyn, scratch, t, state, fresh: False


@overload(record, inline="always")
def _record(dyn, scratch, out, k, t, work):
    if dyn.instance_class is Embedding:
        chosen = records.record
        return lambda dyn, scratch, out, k, t, work: chosen(dyn, scratch, out, k, t, work)
    plain = run_state.record

    def run(dyn, scratch, out, k, t, work):
        plain(dyn, scratch, out, k, work)
        return True

    return run


@overload(keep_row, inline="always")
def _keep_row(dyn, scratch, out, k):
    if dyn.instance_class is Embedding:
        chosen = records.keep_row
        return lambda dyn, scratch, out, k: chosen(scratch, out, k)
    return lambda dyn, scratch, out, k: None


@overload(join_rows, inline="always")
def _join_rows(dyn, scratch, out, k, apart):
    if dyn.instance_class is Embedding:
        chosen = records.join_rows
        return lambda dyn, scratch, out, k, apart: chosen(scratch, out, k, apart)
    return lambda dyn, scratch, out, k, apart: None


@overload(record_here, inline="always")
def _record_here(dyn, scratch, state, out):
    if dyn.instance_class is Embedding:
        chosen = records.record_here
        return lambda dyn, scratch, state, out: chosen(dyn, scratch, state, out)
    plain = run_state.record_here
    return lambda dyn, scratch, state, out: plain(scratch, state, out)
