"""What explicit integrators call, for either formulation: reference coordinates (Dynamics) or independent (Embedding).

A loop is written once, in the words below, and compiled for each formulation with that formulation's kernels in their
place: nothing is asked at run time, and no loop contains what the other one needs.

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
    begin(dyn, scratch, state)                    fill dy at a start or restart
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import dataclass
from types import FunctionType
from typing import Any

from mbsd.compiling.jit import inlined
from mbsd.dynamics import state as run_state
from mbsd.dynamics.embedding import equations, records
from mbsd.dynamics.reference import acceleration, projection
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


REFERENCE: dict[str, Any] = {
    "accelerate": acceleration.accelerate,
    "derivative": acceleration.derivative,
    "project": projection.project,
    "settle": _go_on,
    "record": _record,
    "record_all": _record,
    "keep_row": _keep_row,
    "join_rows": _join_rows,
    "record_here": _record_here,
}
INDEPENDENT: dict[str, Any] = {
    "accelerate": equations.accelerate,
    "derivative": equations.derivative,
    "project": _stay,
    "settle": equations.settle,
    "record": records.record,
    "record_all": records.record_all,
    "keep_row": records.keep_row,
    "join_rows": records.join_rows,
    "record_here": records.record_here,
}


@dataclass(frozen=True)
class Both:
    """A kernel for either formulation."""

    reference: Any
    independent: Any

    def __call__(self, *arguments: Any) -> Any:
        """For the eye of a type checker alone: loops call one of the two."""
        raise TypeError("call .reference or .independent")


def for_both(decorate: Callable[[Any], Any]) -> Callable[[Callable[..., Any]], Both]:
    """Decorator: a function in the words above, decorated for each formulation."""

    def twice(function: Any) -> Both:
        return Both(*(_made(decorate, function, formulation) for formulation in ("reference", "independent")))

    return twice


def _made(decorate: Callable[[Any], Any], function: Any, formulation: str) -> Any:
    names = {
        name: getattr(value, formulation) if isinstance(value, Both) else value
        for name, value in function.__globals__.items()
    }
    names |= REFERENCE if formulation == "reference" else INDEPENDENT
    own = FunctionType(function.__code__, names, f"{function.__name__}_{formulation}")
    own.__qualname__, own.__module__, own.__doc__ = own.__name__, function.__module__, function.__doc__
    made = decorate(own)
    setattr(sys.modules[own.__module__], own.__name__, made)  # where the cache finds it
    return made


def _in_place(*_: Any) -> Any:
    """What stands in a loop for a formulation's kernel."""
    raise TypeError("a loop is called for one formulation")


accelerate = derivative = project = settle = record = record_all = keep_row = join_rows = record_here = _in_place


@for_both(inlined)
def begin(dyn, scratch, state):
    """Make dy valid at a start or restart."""
    if state.count[STARTED] == 0:
        state.clock[POWER] = derivative(dyn, scratch, state.clock[TIME], state.y, state.dy, state.lam)
        settle(dyn, scratch, state.clock[TIME], state.y, True)
        state.count[EVALUATIONS] += 1
        state.count[STARTED] = 1
