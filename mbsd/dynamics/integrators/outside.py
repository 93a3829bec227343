"""Integrators of other libraries, to check the solver's own: they know the model by its rates alone.

    y = (q, v, w)        y' = (v, a(t, q, v), P)                        methods of one step
                         y' = (v_p, a(t, q_p, v_p), P) - k (y - y_p)    multistep methods

w is the work of loads and drivers (J), P their power; w steers no step. Methods of one step are projected onto the
constraints after each step, as the solver's own. Multistep methods live on states of the past and cannot be moved:
their rates are those of the projected state y_p, towards which y is drawn with the rate k (option ``pull``, 10/s if not
given). y_p is the output. A larger k asks for shorter steps, a smaller one leaves larger errors; between 3 and 30/s
it hardly matters to mechanisms that swing about once a second.

Relative tolerances hold for angles too, so theirs are looser after many turns.

Source: Eich 1993, SIAM J. Numer. Anal. 30 (projection); Baumgarte 1972, Comp. Meth. Appl. Mech. Eng. 1 (the pull).

Those of scipy:

``scipy-dop853``: explicit Runge-Kutta of order 8. ``scipy-radau``: Radau IIA of order 5, implicit. ``scipy-lsoda``:
Adams and BDF methods of variable order; it finds by itself where the motion is stiff.

They run in Python, and cost many times what the solver's own methods do.

Source: scipy.integrate (DOP853, Radau, LSODA); Hairer, Norsett, Wanner, Solving ODEs I, II; Petzold 1983, SIAM J. Sci.
Stat. Comput. 4 (LSODA).
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

import numpy as np

from mbsd.dynamics import state as run_state
from mbsd.dynamics.formulation import derivative, project, record_output
from mbsd.dynamics.integrators.kind import Integrator, Option, register
from mbsd.dynamics.reference.arrays import Dynamics, Scratch
from mbsd.dynamics.state import Output, Settings, State, record_here

STAGES = 1
BRIEF = 1e-12
"""Spans below this part of the longest step are gone by one straight line: libraries refuse them."""
FREE = 1e10
"""Tolerance of the work, which has none."""
PULL = {"pull": Option(10.0, 0.0, 1e6)}
"""Option of multistep methods."""


class RatesNotFiniteError(Exception):
    """Multistep methods go on with numbers that are not finite, some for ever; methods of one step shorten the step."""


class Stepper(Protocol):
    """A solver of another library under way."""

    t: float
    """s"""
    y: np.ndarray
    """(2 n + 1,) q and v without ground, work."""

    def step(self) -> bool:
        """Take one step, not beyond the end; False if it fails."""
        ...

    def between(self, t: float) -> np.ndarray:
        """Return y at a time (s) within the last step."""
        ...


class Rates:
    """Right side y'(t, y) with the signature that other libraries expect."""

    def __init__(self, dyn: Dynamics, scratch: Scratch) -> None:
        self.dyn, self.scratch = dyn, scratch
        self.pull: float | None = None
        """k (1/s) of multistep methods."""
        self.trial, self.slope = np.zeros_like(scratch.state), np.zeros_like(scratch.state)
        self.lam = np.zeros_like(scratch.ws.phi)
        self.count = 0

    def __call__(self, t: float, y: np.ndarray) -> np.ndarray:
        """Return y' (2 n + 1,) at y and t (s)."""
        self.trial[:, 3:] = y[:-1].reshape(2, -1)
        if self.pull is not None:
            project(self.dyn, self.scratch, t, self.trial, 2)
        power = derivative(self.dyn, self.scratch, t, self.trial, self.slope, self.lam)
        self.count += 1
        out = np.append(self.slope[:, 3:], power)
        if self.pull is not None:
            out[:-1] += self.pull * (self.trial[:, 3:].ravel() - y[:-1])
        if self.pull is not None and not np.isfinite(out).all():
            raise RatesNotFiniteError
        return out

    def projected(self, t: float, y: np.ndarray) -> np.ndarray:
        """Return y (2 n + 1,) on the constraints."""
        self.trial[:, 3:] = y[:-1].reshape(2, -1)
        project(self.dyn, self.scratch, t, self.trial, 2)
        return np.append(self.trial[:, 3:], y[-1])


Maker = Callable[[Rates, float, np.ndarray, float, Settings], Stepper]
"""From rates, time (s), y, end (s) and settings."""


class _Under(threading.local):
    """The solver under way in this thread and where its caller stands: going on from there it keeps its memory."""

    key: tuple[Any, ...] = ()
    y: np.ndarray = np.zeros((2, 0))
    stepper: Any = None
    rates: Any = None


_under = _Under()


def tolerances(settings: Settings) -> tuple[float, np.ndarray]:
    """Return the relative tolerance and the absolute ones (2 n + 1,)."""
    return settings.relative, np.append(settings.absolute[:, 3:], FREE)


def advance_with(
    make: Maker, dyn: Dynamics, scratch: Scratch, state: State, out: Output, settings: Settings, end: float, steps: int
) -> int:
    """Advance an Integrator by the library's solver that ``make`` makes."""
    if state.count[run_state.STARTED] == 0:
        state.clock[run_state.STEP] = 0.0
        _settle(dyn, scratch, state, float(state.clock[run_state.TIME]))
        state.count[run_state.STARTED] = 1
    while (
        state.count[run_state.NEXT] < len(out.t) and out.t[state.count[run_state.NEXT]] <= state.clock[run_state.TIME]
    ):
        record_here(scratch, state, out)
    if state.clock[run_state.TIME] >= end:
        return run_state.REACHED
    if end - state.clock[run_state.TIME] <= BRIEF * settings.longest + 8 * np.spacing(abs(end)):
        return _in_a_line(dyn, scratch, state, out, end)
    try:
        rates, stepper = _going_on(make, dyn, scratch, state, settings, end)
        evaluated = rates.count
        status = _march(scratch, stepper, rates, state, out, end, steps)
    except RatesNotFiniteError:
        _under.key, _under.stepper, _under.rates = (), None, None
        return run_state.NOT_FINITE
    state.count[run_state.EVALUATIONS] += rates.count - evaluated
    if status in (run_state.REACHED, run_state.PAUSED):
        state.y[:, 3:] = stepper.y[:-1].reshape(2, -1)
        state.clock[run_state.WORK] = stepper.y[-1]
        project(dyn, scratch, state.clock[run_state.TIME], state.y, 2)
        _settle(dyn, scratch, state, float(state.clock[run_state.TIME]))
        if (
            state.count[run_state.NEXT] < len(out.t)
            and out.t[state.count[run_state.NEXT]] <= state.clock[run_state.TIME]
        ):
            record_here(scratch, state, out)
    _under.key, _under.stepper, _under.rates = (), None, None
    if status == run_state.PAUSED:
        _under.key, _under.y = _key(make, scratch, settings, state, end), state.y.copy()
        _under.stepper, _under.rates = stepper, rates
    return status


def _march(scratch: Scratch, stepper: Stepper, rates: Rates, state: State, out: Output, end: float, steps: int) -> int:
    """Step, with the outputs between; those at the last time are left to the caller."""
    for _ in range(steps):
        before = float(state.clock[run_state.TIME])
        if not stepper.step():
            state.clock[run_state.STEP] = 10 * np.spacing(abs(before) + 1e-300)
            return run_state.STEP_TOO_SMALL
        done = stepper.t >= end
        state.clock[run_state.TIME] = end if done else stepper.t
        state.clock[run_state.STEP] = state.clock[run_state.TIME] - before
        state.count[run_state.ACCEPTED] += 1
        while (
            state.count[run_state.NEXT] < len(out.t)
            and out.t[state.count[run_state.NEXT]] < state.clock[run_state.TIME]
        ):
            y = stepper.between(float(out.t[state.count[run_state.NEXT]]))
            scratch.state[:, 3:] = y[:-1].reshape(2, -1)
            record_output(rates.dyn, scratch, out, state.count[run_state.NEXT], y[-1])
            rates.count += 1
            state.count[run_state.NEXT] += 1
        if done:
            return run_state.REACHED
    return run_state.PAUSED


def _key(make: Maker, scratch: Scratch, settings: Settings, state: State, end: float) -> tuple[Any, ...]:
    return (
        make,
        scratch,
        settings,
        float(state.clock[run_state.TIME]),
        float(state.clock[run_state.STEP]),
        float(state.clock[run_state.WORK]),
        end,
    )


def _going_on(
    make: Maker, dyn: Dynamics, scratch: Scratch, state: State, settings: Settings, end: float
) -> tuple[Rates, Stepper]:
    """Return the solver under way if it paused exactly here, else a new one."""
    key = _key(make, scratch, settings, state, end)
    held = _under.key
    same = len(held) > 0 and all(a is b for a, b in zip(held[:3], key[:3], strict=True)) and held[3:] == key[3:]
    if same and state.clock[run_state.STEP] > 0.0 and np.array_equal(_under.y, state.y):
        return _under.rates, _under.stepper
    rates = Rates(dyn, scratch)
    y = np.append(state.y[:, 3:], state.clock[run_state.WORK])
    return rates, make(rates, float(state.clock[run_state.TIME]), y, end, settings)


def _settle(dyn: Dynamics, scratch: Scratch, state: State, t: float) -> None:
    """Make the derivative at the state valid."""
    state.clock[run_state.POWER] = derivative(dyn, scratch, t, state.y, state.dy, state.lam)
    state.count[run_state.EVALUATIONS] += 1


def _in_a_line(dyn: Dynamics, scratch: Scratch, state: State, out: Output, end: float) -> int:
    span = end - state.clock[run_state.TIME]
    state.y[...] += span * state.dy
    state.clock[run_state.WORK] += span * state.clock[run_state.POWER]
    state.clock[run_state.TIME] = end
    project(dyn, scratch, end, state.y, 2)
    _settle(dyn, scratch, state, end)
    state.count[run_state.ACCEPTED] += 1
    while state.count[run_state.NEXT] < len(out.t) and out.t[state.count[run_state.NEXT]] <= end:
        record_here(scratch, state, out)
    return run_state.REACHED


class _Scipy:
    """A solver of scipy under way."""

    def __init__(self, solver: str, rates: Rates, t: float, y: np.ndarray, end: float, settings: Settings) -> None:
        from scipy import integrate

        relative, absolute = tolerances(settings)
        self._rates, self._one_step = rates, solver != "LSODA"
        rates.pull = None if self._one_step else float(settings.options[0])
        limits = {"rtol": relative, "atol": absolute, "max_step": settings.longest}
        with np.errstate(all="ignore"):
            self._solver = getattr(integrate, solver)(rates, t, y, end, **limits)
        self._dense: Callable[[float], np.ndarray] | None = None
        self.t, self.y = t, y

    def step(self) -> bool:
        """See Stepper."""
        with np.errstate(all="ignore"):  # a trial step may overflow, and is taken again
            self._solver.step()
        self._dense = None
        if self._solver.status == "failed":
            return False
        if self._one_step:
            self._solver.y = self._rates.projected(self._solver.t, self._solver.y)
            self._solver.f = self._rates(self._solver.t, self._solver.y)
        self.t, self.y = float(self._solver.t), self._solver.y
        return True

    def between(self, t: float) -> np.ndarray:
        """See Stepper."""
        dense = self._dense = self._dense or self._solver.dense_output()
        return dense(t)


def _maker(solver: str) -> Maker:
    def make(rates: Rates, t: float, y: np.ndarray, end: float, settings: Settings) -> Stepper:
        return _Scipy(solver, rates, t, y, end, settings)

    return make


SCIPY_DOP853, SCIPY_RADAU, SCIPY_LSODA = (
    register(
        Integrator(
            f"scipy-{solver.lower()}",
            partial(advance_with, _maker(solver)),
            STAGES,
            order,
            fixed_step=False,
            options=options,
        )
    )
    for solver, order, options in (("DOP853", 8, {}), ("Radau", 5, {}), ("LSODA", 0, PULL))
)
