"""States of forces, such as pressures, along a driven motion: first-order equations.

    s' = f(t, q(t), v(t), s)     q, v: quintics through poses;  LSODA, stiff or not, from jump to jump of laws

Poses are those of the outputs, and others between them where quintics would miss the motion. States begin as a kind of
force says, with an effort of 0 where that decides: what is to be carried, the drivers carry.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from mbsd.arrays.laws import compiled_laws, jump_times, law_values
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.packing import Packed
from mbsd.arrays.states import columns_of, ones_of, with_states
from mbsd.base.errors import SimulationError
from mbsd.equations.laws import Laws
from mbsd.equations.loads import tabulate_loads
from mbsd.model.laws.numbers import hermite_coefficients
from mbsd.results.measured import measured, measured_rate

TOLERANCE = 1e-9
"""Relative, and of a state of ``States.one``."""
MISSED = 1e-8
"""Error of quintics, in sizes and rad, with which they are taken as they are."""
FINEST = 1e-4
"""Part of the whole time below which no interval is halved: a law that jumps is met nowhere."""

Motion = tuple[np.ndarray, np.ndarray, np.ndarray]
"""q, v, a (T, 3 nb)."""


def refine_times(packed: Packed, t: np.ndarray, solve: Callable[[np.ndarray], Motion]) -> np.ndarray:
    """Return the times t (T,) of a motion (s) and others, so near that quintics between them miss no pose.

    ``solve`` gives the motion at rising times, which begin with t[0].
    """
    scale, begins = np.concatenate([np.ones(3), packed.column_scale()]), t[:-1]
    while len(begins):
        here = np.searchsorted(t, begins)
        middle = 0.5 * (t[here] + t[here + 1])
        every = np.union1d(t, middle)
        motion, half = np.stack(solve(every), axis=-1), (middle - t[here])[:, None]
        first, last = (motion[np.searchsorted(every, t[row])] for row in (here, here + 1))
        poses = np.einsum("pcx,px->pc", hermite_coefficients(2.0 * half[:, 0], first, last), half ** np.arange(6))
        missed = np.abs(poses - motion[np.searchsorted(every, middle), :, 0]) / scale
        far = (missed.max(axis=1) > MISSED) & (half[:, 0] > float(t[-1] - t[0]) * FINEST)
        begins, t = np.concatenate([begins[far], middle[far]]), np.union1d(t, middle[far])
    return t


def states_along(packed: Packed, t: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray | None:
    """Return (T, n) states (SI) along a motion q, v, a (T, 3 nb) at times (T,); None without states.

    Times rise, and are near each other (``refine_times``).

    Raises SimulationError where they grow without bound.
    """
    wide = with_states(packed)
    if not wide.states:
        return None
    out = np.zeros((len(t), wide.states))
    laws = compiled_laws(packed, float(t[0]), float(t[-1]))
    out[0] = _start(packed, laws, t, q, v) / ones_of(wide)
    flow = _Flow(wide, laws, t, q, v, a)
    for first, last in _stretches(packed, laws, t):
        flow.follow(first, last, out)
    return out * ones_of(wide)


def _start(packed: Packed, laws: Laws, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return (n,) SI."""
    out: list[float] = []
    for force, (i, j) in zip(packed.forces, packed.force_markers, strict=True):
        if force.kind.states is not None:
            assert force.kind.along is not None
            element = force.kind.along(force)
            value = float(measured(packed, element, i, j, q[:1])[0])
            rate = float(measured_rate(packed, element, i, j, q[:1], v[:1])[0])
            own = {name: float(known[0]) for name, known in law_values(packed, laws, force, t[:1]).items()}
            out += force.kind.states.start(packed.name, force, own, value, rate, 0.0)
    return np.array(out)


def _stretches(packed: Packed, laws: Laws, t: np.ndarray) -> list[tuple[float, float]]:
    """Return from jump to jump of the laws (s)."""
    start, end = float(t[0]), float(t[-1])
    if not end > start:
        return []
    edges = [start, *jump_times(packed, laws, start, end), end]
    return list(pairwise(edges))


class _Flow:
    """s' along a motion, in sizes a second."""

    def __init__(self, wide: Packed, laws: Laws, t: np.ndarray, q: np.ndarray, v: np.ndarray, a: np.ndarray) -> None:
        self.wide, self.t = wide, t
        self.loads, self.laws = pack_loads(wide), laws
        samples = np.stack([q, v, a], axis=-1)
        self.quintics = hermite_coefficients(np.diff(t), samples[:-1], samples[1:])
        self.columns, self.width = columns_of(wide), q.shape[1]
        self.q, self.v, self.load = (np.zeros((1, len(wide.body_names) * 3)) for _ in range(3))
        self.time, self.power = np.zeros(1), np.zeros(1)

    def follow(self, first: float, last: float, out: np.ndarray) -> None:
        """Fill the rows of ``out`` (T, n) after ``first`` (s) up to ``last``; earlier ones are known."""
        from scipy.integrate import solve_ivp

        k = int(np.searchsorted(self.t, first, side="right"))
        end = int(np.searchsorted(self.t, last, side="right"))
        begun = out[k - 1] if self.t[k - 1] == first else self.state
        inner = self.t[k:end]
        times = inner if len(inner) and inner[-1] == last else np.append(inner, last)
        size = self.wide.size
        solved = solve_ivp(
            self, (first, last), begun, "LSODA", times, rtol=TOLERANCE, atol=TOLERANCE * size,
            max_step=float(np.diff(self.t).max()),
        )  # fmt: skip
        self.wide.specials.check()
        if not solved.success:
            at = float(solved.t[-1]) if len(solved.t) else first
            raise SimulationError(
                f"{self.wide.name}: the states of its forces ({', '.join(self.wide.body_names[-self.wide.states :])}) "
                f"cannot be followed beyond t = {at:.6g} s of this motion: {solved.message} Find what makes them "
                "grow without bound, such as a closed valve of a driven cylinder"
            )
        out[k:end] = solved.y.T[: end - k]
        self.state = solved.y[:, -1]

    def __call__(self, time: float, state: np.ndarray) -> np.ndarray:
        step = min(max(int(np.searchsorted(self.t, time, side="right")) - 1, 0), len(self.t) - 2)
        ahead = (time - self.t[step]) ** np.arange(6)
        quintic = self.quintics[step]
        self.time[0] = time
        self.q[0, : self.width] = quintic @ ahead
        self.v[0, : self.width] = (quintic[:, 1:] * np.arange(1, 6)) @ ahead[:5]
        self.v[0, self.columns] = state
        self.load[:] = 0.0
        tabulate_loads(
            self.wide.system, self.loads, self.laws, self.time, self.q, self.v, self.wide.ws, self.load, self.power
        )
        return self.load[0, self.columns].copy()
