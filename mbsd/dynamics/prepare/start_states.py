"""Values at the start for the states of forces: given ones, else those of a steady state, as the kind of force says.

A force whose states do not follow from the motion alone, as the pressures behind a closed valve, carries what is there
to be carried: the effort e at which what it measures would not accelerate,

    x''(e) = 0     for all such forces at once;  x'' is linear in e, so one evaluation for each and one more tell it
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from mbsd.arrays.laws import law_values
from mbsd.arrays.states import columns_of, ones_of
from mbsd.dynamics.formulation import derivative
from mbsd.dynamics.reference.arrays import scratch_for
from mbsd.results.measured import measured, measured_rate

if TYPE_CHECKING:
    from mbsd.dynamics.prepare.prepared import PreparedDynamics
    from mbsd.model.force import Element, Force, States

MOMENT = 1e-5
"""Step of the differences that give x'' (s)."""
USUAL = 10.0
"""An effort (N or N m) that is no rounding, for each kg of the mechanism."""
FAINT = 1e-9
"""Part of the largest change of x'' by an effort below which an effort moves nothing."""


def take_start_states(ready: PreparedDynamics) -> None:
    """Write the states at the start into its velocities."""
    holders = _holders(ready)
    count = len(holders)
    none = _measured_accelerations(ready, holders, np.zeros(count))
    usual = max(1.0, USUAL * float(ready.packed.system.mass.sum()))
    effects = np.array([_measured_accelerations(ready, holders, usual * unit) - none for unit in np.eye(count)]).T
    efforts = np.zeros(count)
    if np.isfinite(none).all() and np.isfinite(effects).all():
        efforts = usual * np.linalg.lstsq(effects, -none, rcond=FAINT)[0]
    _write(ready, holders, efforts)


class _Holder:
    """A force with states, and how it stands at the start."""

    def __init__(self, ready: PreparedDynamics, force: Force, i: int, j: int) -> None:
        assert force.kind.states is not None
        assert force.kind.along is not None
        self.force, self.i, self.j = force, i, j
        self.states: States = force.kind.states
        self.element: Element = force.kind.along(force)
        q, v = ready.initial.q[None], ready.initial.v[None]
        self.value = float(measured(ready.packed, self.element, i, j, q)[0])
        self.rate = float(measured_rate(ready.packed, self.element, i, j, q, v)[0])
        self.model = ready.packed.name
        values = law_values(ready.packed, ready.dynamics.laws, force, np.array([ready.start]))
        self.laws = {name: float(value[0]) for name, value in values.items()}

    def at(self, effort: float) -> list[float]:
        """The states under this effort."""
        return list(self.states.start(self.model, self.force, self.laws, self.value, self.rate, effort))


def _holders(ready: PreparedDynamics) -> list[_Holder]:
    packed = ready.packed
    return [
        _Holder(ready, force, int(i), int(j))
        for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True)
        if force.kind.states is not None
    ]


def _write(ready: PreparedDynamics, holders: list[_Holder], efforts: np.ndarray) -> None:
    states = [value for holder, effort in zip(holders, efforts, strict=True) for value in holder.at(float(effort))]
    ready.initial.v[columns_of(ready.packed)] = np.array(states) / ones_of(ready.packed)


def _measured_accelerations(ready: PreparedDynamics, holders: list[_Holder], efforts: np.ndarray) -> np.ndarray:
    """(n,) x'' of what each holder measures, at the start, under their efforts (n,)."""
    packed = ready.packed
    _write(ready, holders, efforts)
    state = np.stack([ready.initial.q, ready.initial.v])
    out, lam = np.zeros_like(state), np.zeros(len(packed.ws.phi))
    scratch = scratch_for(ready.dynamics, packed.ws, len(packed.motions), 1)
    derivative(ready.dynamics, scratch, ready.start, state, out, lam)
    packed.specials.check()
    steps = MOMENT * np.array([-1.0, 1.0])[:, None]
    q = state[0] + steps * state[1] + 0.5 * steps**2 * out[1]
    v = state[1] + steps * out[1]
    return np.array(
        [
            np.diff(measured_rate(packed, holder.element, holder.i, holder.j, q, v))[0] / (2.0 * MOMENT)
            for holder in holders
        ]
    )
