"""The state about which a mechanism is linearised, as the start of a copy without input drivers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from mbsd.analyses.efforts import with_efforts
from mbsd.analyses.equilibrium import Equilibrium, equilibrium
from mbsd.analyses.state_space import Linearisation
from mbsd.analyses.state_space import linearise as linearise_start
from mbsd.arrays.starts import copied, started_at
from mbsd.base.errors import ModelError
from mbsd.base.names import no_such, shown
from mbsd.model.mechanism import Model, names_given
from mbsd.results.solution import Solution


def linearise(m: Model, at: Equilibrium | Solution | str, t: float | None, inputs: Sequence[str]) -> Linearisation:
    """See :meth:`mbsd.mechanism.Mechanism.linearise`."""
    inputs = names_given(f"{m.name}: linearise: inputs", inputs)
    for name in inputs:
        if not isinstance(name, str) or (name not in m.drivers and name not in m.forces):
            raise ModelError(f"{m.name}: {no_such('driver or force', name, [*m.drivers, *m.forces])}")
    if isinstance(at, str) and at not in ("equilibrium", "start"):
        raise ModelError(f"{m.name}: linearise: {no_such('state', at, ('equilibrium', 'start'))}, or give a solution")
    if isinstance(at, str) and at == "equilibrium":
        at = equilibrium(m, 0.0 if t is None else float(t), nearest=False)
        t = None
    elif isinstance(at, str):
        model, time = copied(m), 0.0 if t is None else float(t)
        return linearise_start(with_efforts(model, dict.fromkeys(_drivers(m, inputs), 0.0)), time, inputs)
    if isinstance(at, Equilibrium):
        _own(m, at.solution)
        if t is not None:
            raise ModelError(f"{m.name}: an equilibrium has no time; leave t out")
        efforts = {name: float(at.driver(name).effort) for name in _drivers(m, inputs)}
        return linearise_start(with_efforts(at.model, efforts), float(at.solution.t[0]), inputs)
    if not isinstance(at, Solution):
        raise ModelError(
            f"{m.name}: linearise at {shown(at)}; say 'equilibrium', 'start', or give an equilibrium or solution"
        )
    _own(m, at)
    if t is None:
        raise ModelError(f"{m.name}: say at which time of the solution: linearise(sol, t=...)")
    slack = 1e-9 * float(np.ptp(at.t))
    if not at.t[0] - slack <= t <= at.t[-1] + slack:
        raise ModelError(f"{m.name}: t = {t} s is outside of the solution, {at.t[0]:g} .. {at.t[-1]:g} s")
    k = int(np.argmin(np.abs(at.t - t)))
    efforts = {name: float(at.driver(name).effort[k]) for name in _drivers(m, inputs)}
    states = None if at.states is None else at.states[k]
    model = started_at(m, at.packed, at.q[k].ravel(), at.v[k].ravel(), states)
    return linearise_start(with_efforts(model, efforts), float(at.t[k]), inputs)


def _drivers(m: Model, inputs: Sequence[str]) -> list[str]:
    return [name for name in inputs if name in m.drivers]


def _own(m: Model, solution: Solution) -> None:
    if solution.mechanism is not m:
        raise ModelError(f"{m.name}: the state is one of '{solution.mechanism.name}', not of this mechanism")
