"""Optimisation of a mechanism's numbers: a measure of its motion as small or large as possible.

Every step runs the motion once and has all derivatives with it (mbsd/derivatives); scipy's SLSQP or trust-constr goes
on from there, in parts of the bounds. Source: Kraft, DFVLR-FB 88-28 (1988) (SLSQP); Conn, Gould, Toint, Trust-Region
Methods, SIAM (2000).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.base.arguments import checked, finite_number, positive_number, switch, users_progress, whole_number
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import Suggesting, no_such, shown
from mbsd.base.quantity import counted
from mbsd.model.mechanism import Model
from mbsd.synthesis.evaluation import Bounds, Condition, Moves, Tried, bounds_of, conditions_of

METHODS = ("SLSQP", "trust-constr")
MOST = 100
"""Iterations."""
PRECISE = 1e-8
"""Change of the objective, as part of it, at which an optimisation ends."""
HELD = 1e-6
"""Part of a condition's size by which it may be missed."""


@dataclass(frozen=True, eq=False)
class Optimum(Suggesting):
    """Result of :func:`optimise`."""

    mechanism: Any
    """The Mechanism with the best numbers."""
    values: dict[str, float]
    """Varied numbers by name."""
    objective: float
    conditions: dict[str, float]
    """Conditions by name, with their values."""
    gradient: dict[str, float]
    """Slopes of the objective by each number at the end."""
    met: bool
    """True if all conditions hold and scipy says that it ended at an optimum."""
    message: str
    """scipy's."""
    evaluations: int
    """Motions that were solved, each with all its derivatives."""
    history: np.ndarray
    """Objective after each of them; NaN where there was no motion."""
    solution: Any
    """The Solution of the best."""

    def __repr__(self) -> str:
        numbers = ", ".join(f"{name} {value:.6g}" for name, value in self.values.items())
        ended = "" if self.met else f"; not met: {self.message}"
        motions = counted(self.evaluations, "motion")
        return f"<Optimum of {self.mechanism.name}: {self.objective:.6g} at {numbers}; {motions}{ended}>"


@checked
def optimise(
    m: Any,
    objective: Any,
    vary: Mapping[str, Sequence[float]],
    constraints: Any = (),
    *,
    maximise: bool = False,
    build: Callable[..., Any] | None = None,
    start: Mapping[str, float] | None = None,
    duration: float | None = None,
    steps: int = 360,
    times: Sequence[float] | np.ndarray | None = None,
    simulate: bool | None = None,
    tolerance: float = 1e-9,
    method: str = "SLSQP",
    most: int = MOST,
    precision: float = PRECISE,
    progress: Callable[[int, float], object] | None = None,
) -> Optimum:
    """Find the numbers of a mechanism with which a measure of its motion is least, and conditions hold.

    ``objective``: a measure (``largest("motor.effort")`` of mbsd.measures), a function of a solution that gives a
    number, or the name of one of the numbers. ``maximise`` seeks the largest instead. ``vary``: names of numbers, as
    :meth:`mbsd.mechanism.Mechanism.sensitivities` takes them, and bounds ``(lowest, highest)``; with ``build``, a
    function that returns the mechanism, names are those of its arguments.
    ``constraints``: a list of (what, lowest, highest), or a dict of them by name; what is all that an objective may be,
    None is no end, and equal ends ask for a value.
    The search begins at the mechanism's own numbers, within the bounds, or at those of ``start``, and goes downhill:
    it ends in the nearest optimum, which need not be the best of all.
    A mechanism is swept where its drivers leave no freedom and simulated otherwise; ``simulate`` says which.
    ``duration``, ``steps`` and ``times`` are those of sweep() and simulate(), ``tolerance`` is that of simulate().
    ``method``: "SLSQP" or "trust-constr" of scipy, with at most ``most`` iterations, down to a change of the objective
    by this part (``precision``). ``progress`` is called with the number of motions and the objective; what it raises
    ends the search.

    Raises ModelError for what cannot be asked, before anything runs, and what the first motion raises.
    """
    if not isinstance(m, Model):
        raise ModelError(f"optimise: the mechanism is {shown(m)}; give a Mechanism")
    bounds, conditions = bounds_of(m, vary), conditions_of(m, constraints)
    if method not in METHODS:
        raise ModelError(f"{m.name}: optimise: {no_such('method', method, METHODS)}")
    progress = users_progress(f"{m.name}: optimise: progress", progress, "the number of motions and the objective", 2)
    most = whole_number(f"{m.name}: optimise: most", most)
    precision = positive_number(f"{m.name}: optimise: precision", precision)
    sign = -1.0 if switch(f"{m.name}: optimise: maximise", maximise) else 1.0
    moves = Moves(m, bounds, build, objective, conditions, (duration, steps, times), simulate, tolerance)
    first = _first(m, bounds, moves, start)
    search = _Search(moves, bounds, conditions, sign, progress)
    begun = search.motion_at((first - bounds.low) / bounds.size)  # raises what it cannot do
    search.scale = max(abs(begun.value), float(np.abs(begun.slope * bounds.size).max(initial=0.0))) or 1.0
    message, ended = search.run(method, most, precision)
    return _optimum(search, message, ended)


def _first(m: Model, bounds: Bounds, moves: Moves, start: Mapping[str, float] | None) -> np.ndarray:
    """Return (k,) where the search begins. Raises ModelError for a start that cannot be."""
    first = np.clip(moves.given, bounds.low, bounds.high)
    if start is None:
        return first
    if not isinstance(start, Mapping):
        raise ModelError(f"{m.name}: optimise: start is {shown(start)}; give names and values")
    for name, value in start.items():
        if name not in bounds.names:
            raise ModelError(f"{m.name}: optimise: start: {no_such('number that varies', name, bounds.names)}")
        k = bounds.names.index(name)
        first[k] = finite_number(f"{m.name}: optimise: start of '{name}'", value)
        if not bounds.low[k] <= first[k] <= bounds.high[k]:
            raise ModelError(
                f"{m.name}: optimise: start of '{name}' is {first[k]:g}; it may be from {bounds.low[k]:g} to "
                f"{bounds.high[k]:g}"
            )
    return first


class _Search:
    """Objective and conditions in parts of the bounds, u (k,) in 0 .. 1, each motion solved once."""

    def __init__(
        self, moves: Moves, bounds: Bounds, conditions: list[Condition], sign: float,
        progress: Callable[[int, float], object] | None,
    ) -> None:  # fmt: skip
        self.moves, self.bounds, self.conditions, self.sign, self.progress = moves, bounds, conditions, sign, progress
        self.scale = 1.0
        self.kept: dict[bytes, Tried] = {}
        self.good: tuple[np.ndarray, Tried] | None = None
        self.best: tuple[np.ndarray, Tried] | None = None
        self.history: list[float] = []

    def motion_at(self, u: np.ndarray) -> Tried:
        """Return the motion at u.

        If there is none, return one that is worse the farther u is from the last valid one.
        """
        u = np.clip(u, 0.0, 1.0)
        key = u.tobytes()
        if key in self.kept:
            return self.kept[key]
        try:
            tried = self.moves(self.bounds.low + self.bounds.size * u)
        except MechanismError:
            if self.good is None:
                raise
            tried = self._beyond(u)
        else:
            self.good = u.copy(), tried
            if self.best is None or self._rank(tried) < self._rank(self.best[1]):
                self.best = u.copy(), tried
        self.history.append(tried.value if tried.solve is not None else np.nan)
        if self.progress is not None:
            self.progress(len(self.history), tried.value)
        self.kept[key] = tried
        return tried

    def missed(self, tried: Tried) -> float:
        """Return how far the worst condition is missed, in its size."""
        worst = 0.0
        for condition, value in zip(self.conditions, tried.conditions, strict=True):
            size = _size(condition, value)
            worst = max(worst, (condition.low - value) / size, (value - condition.high) / size)
        return worst

    def _rank(self, tried: Tried) -> tuple[float, float]:
        missed = self.missed(tried)
        return (0.0 if missed <= HELD else missed, self.sign * tried.value)

    def _beyond(self, u: np.ndarray) -> Tried:
        assert self.good is not None
        near, tried = self.good
        away = u - near
        far = float(np.linalg.norm(away))
        push = self.sign * 10.0 * self.scale * away / max(far, 1e-12) / self.bounds.size
        return Tried(tried.value + self.sign * 10.0 * self.scale * (far + 1.0), push, tried.conditions,
                     tried.condition_slopes, None, None)  # fmt: skip

    def run(self, method: str, most: int, precision: float) -> tuple[str, bool]:
        """Go downhill from the first motion: scipy's message, and whether it ended at an optimum."""
        from scipy.optimize import minimize

        assert self.good is not None
        size, factor = self.bounds.size, self.sign / self.scale
        options: dict[str, Any] = {"maxiter": most}
        options |= {"ftol": precision} if method == "SLSQP" else {"xtol": precision, "gtol": precision}
        result = minimize(
            lambda u: factor * self.motion_at(u).value,
            self.good[0],
            jac=lambda u: factor * self.motion_at(u).slope * size,
            method=method,
            bounds=[(0.0, 1.0)] * len(size),
            constraints=self._slsqp() if method == "SLSQP" else self._trust(),
            options=options,
        )
        self.motion_at(result.x)
        return str(result.message), bool(result.success) or result.status in (1, 2)

    def _parts(self, k: int) -> tuple[float, Callable[[Any], float], Callable[[Any], np.ndarray]]:
        size = _size(self.conditions[k], self.good[1].conditions[k] if self.good else 1.0)
        return (
            size,
            lambda u: self.motion_at(u).conditions[k] / size,
            lambda u: self.motion_at(u).condition_slopes[k] * self.bounds.size / size,
        )

    def _slsqp(self) -> list[dict[str, Any]]:
        out: list[dict[str, Any]] = []
        for k, condition in enumerate(self.conditions):
            size, value, slope = self._parts(k)
            low, high = condition.low / size, condition.high / size
            if low == high:
                out.append({"type": "eq", "fun": lambda u, v=value, at=low: v(u) - at, "jac": slope})
                continue
            if np.isfinite(low):
                out.append({"type": "ineq", "fun": lambda u, v=value, at=low: v(u) - at, "jac": slope})
            if np.isfinite(high):
                out.append({
                    "type": "ineq", "fun": lambda u, v=value, at=high: at - v(u), "jac": lambda u, s=slope: -s(u)
                })  # fmt: skip
        return out

    def _trust(self) -> list[Any]:
        from scipy.optimize import BFGS, NonlinearConstraint

        out = []
        for k, condition in enumerate(self.conditions):
            size, value, slope = self._parts(k)
            low, high = condition.low / size, condition.high / size
            out.append(NonlinearConstraint(value, low, high, jac=slope, hess=BFGS()))  # pyright: ignore[reportArgumentType]
        return out


def _size(condition: Condition, value: float) -> float:
    """Return the size by which a condition is measured."""
    ends = [abs(end) for end in (condition.low, condition.high) if np.isfinite(end)]
    return max([*ends, abs(value) * 1e-3]) or 1.0


def _optimum(search: _Search, message: str, ended: bool) -> Optimum:
    assert search.best is not None
    u, tried = search.best
    assert tried.solve is not None
    x = search.bounds.low + search.bounds.size * u
    names = search.bounds.names
    return Optimum(
        search.moves.model(x),
        {name: float(value) for name, value in zip(names, x, strict=True)},
        tried.value,
        {condition.name: value for condition, value in zip(search.conditions, tried.conditions, strict=True)},
        {name: float(value) for name, value in zip(names, tried.slope, strict=True)},
        ended and search.missed(tried) <= 10 * HELD,
        message,
        len(search.history),
        np.array(search.history),
        tried.solve(),
    )
