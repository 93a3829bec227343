"""Times at which steps of a simulation end: where loads or laws jump, and around what is short against a step.

An error estimate sees a short pulse only if a stage falls into it. So what depends on time alone is looked at before:
the laws of drivers (f''), of forces, and the functions of user forces with the bodies as they start. Where the pieces
that meet them (fitting/leaves.py) shrink to an eighth and less of those beside, each change of width is a stop, so that
steps shrink with them. Kinks are stops too if they matter within a long step. At a jump a step ends right before it,
and the next one begins right after it with new derivatives.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from mbsd.arrays.laws import LAW_STEP, disagreeing
from mbsd.base.codes import CYCLOIDAL, PIECES
from mbsd.base.errors import ModelError, ModelWarning
from mbsd.dynamics.state import ACCEPTED, PAUSED, REACHED, STARTED, STEP, TIME, State
from mbsd.equations.laws import Laws, tabulate_law
from mbsd.equations.loads import Loads, tabulate_loads
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve
from mbsd.model.laws.fitting.fit import Fit, fit
from mbsd.model.laws.fitting.leaves import BESIDE, ROOTS, Cut, finest, given_cuts
from mbsd.model.laws.fitting.sampling import FORCE_LOOKS, Sampled, look_times
from mbsd.results.rows import Jumps

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed

TOLERANCE, FUNCTION_TOLERANCE = 1e-4, 1e-9
"""Tolerances of laws (of their size: enough to see where they are short) and of functions, whose jumps and kinks are
sought."""
LAW_KINK = 1e-3
"""Part of its size by which a law's pieces disagree where it bends within a long step."""
PER_STEP = 25
"""Long steps in a simulation."""
SHRUNK = 8.0
"""Pieces that shrink by less than this are no pulse."""
CHANGED = 1.9
NARROWEST = 1e-7
"""Part of the span below which stops are not worth while."""
MOST_CALLS = 20_000
"""Most calls of one function of the user."""
CHUNK = 300_000
"""Numbers tabulated at once."""
AT_ONCE = 1e-9
"""Part of the span within which what changes is a jump."""


@dataclass(frozen=True)
class Stops:
    """Where steps end (s), in order, and from when (s) they go on: later by rounding where something jumps."""

    before: np.ndarray
    after: np.ndarray
    """(n,)"""
    names: tuple[tuple[str, ...], ...] = ()
    """(n,) of the drivers and forces that a step ends for."""

    @property
    def jumps(self) -> Jumps:
        """Return the stops where something may jump."""
        rows = np.flatnonzero(self.after > self.before)
        return Jumps(self.before[rows], self.after[rows], tuple(self.names[k] for k in rows))

    def through(self, advance: Callable[..., int], arrays: Any, scratch: Any, state: State, *rest: Any) -> int:
        """``advance`` of an Integrator, from stop to stop."""
        out, settings, end, steps = rest
        while True:
            k = int(np.searchsorted(self.before, state.clock[TIME]))
            at_jump = k < len(self.before) and self.before[k] == state.clock[TIME] < self.after[k]
            if at_jump and state.clock[TIME] < end:
                state.clock[TIME] = self.after[k]
                state.clock[STEP] = state.count[STARTED] = 0
            k = int(np.searchsorted(self.before, state.clock[TIME], side="right"))
            if k == len(self.before) or self.before[k] >= end:
                return advance(arrays, scratch, state, out, settings, end, steps)
            taken = int(state.count[ACCEPTED])
            status = advance(arrays, scratch, state, out, settings, float(self.before[k]), steps)
            steps -= int(state.count[ACCEPTED]) - taken
            if status != REACHED or steps <= 0:
                return PAUSED if status == REACHED else status


def stops_of(packed: Packed, loads: Loads, laws: Laws, start: float, end: float, q: np.ndarray, v: np.ndarray) -> Stops:
    """All stops of a simulation from ``start`` to ``end`` (s) that begins at q, v (3 nb,).

    Warns where the function of a user force changes too often to look at all of it.
    """
    if not end > start or not (packed.motions or packed.forces):
        return Stops(np.zeros(0), np.zeros(0))
    stop_intervals: list[tuple[str, list[tuple[float, float]]]] = []
    given: list[tuple[str, Motion | Curve]] = list(zip(packed.driver_names, packed.motions, strict=True))
    drivers = len(given)
    for force in packed.forces:
        given += [(force.name, law) for law in force.laws.values()]
    for k, (name, law) in enumerate(given):
        if isinstance(law, Motion):
            stop_intervals.append((name, [(t, t) for t in getattr(law, "breaks", ())]))
            stop_intervals.append((name, _of_law(laws, k + 1, start, end, 2 if k < drivers else 0)))
    stop_intervals += _of_functions(packed, loads, laws, start, end, q, v)
    names: dict[tuple[float, float], dict[str, None]] = {}
    for name, times in stop_intervals:
        for a, b in times:
            if start < a <= b < end:
                names.setdefault((a, b), {})[name] = None
    kept: list[tuple[float, float]] = []
    before = -np.inf
    for stop in sorted(names):
        if stop[0] - before > finest(start, end) / 64:
            kept.append(stop)
        else:
            names[kept[-1]] |= names[stop]
        before = stop[0]
    rows = np.array(kept).reshape(-1, 2)
    return Stops(rows[:, 0].copy(), rows[:, 1].copy(), tuple(tuple(names[stop]) for stop in kept))


def _of_law(laws: Laws, k: int, start: float, end: float, order: int) -> list[tuple[float, float]]:
    """Stops of law k, whose derivative of this order counts."""
    own = laws.numbers[laws.first[k] : laws.first[k + 1]]
    if laws.kind[k] == CYCLOIDAL:
        return [(float(own[2]), float(own[2])), (float(own[2] + own[1]), float(own[2] + own[1]))]
    if laws.kind[k] != PIECES:
        return []

    def values(times: np.ndarray) -> np.ndarray:
        out = np.zeros((len(times), 3))
        tabulate_law(laws, k, np.ascontiguousarray(times), out)
        return out[:, order]

    jumps = [t for t in disagreeing(own, order, LAW_STEP) if start < t < end]
    kinks = disagreeing(own, order, LAW_KINK, (end - start) / PER_STEP)
    cuts = [Cut(float(np.nextafter(t, -np.inf)), t, t) for t in jumps]
    looks = look_times(start, end)
    met = fit(Sampled(values), start, end, cuts, looks, True, TOLERANCE)
    smooth = [t for t in kinks + _pulses(met, end - start) if t not in jumps]
    return [(cut.left, cut.right) for cut in cuts] + [(t, t) for t in smooth]


def _pulses(met: Fit, span: float) -> list[float]:
    """Where the width of pieces changes, around those that shrink to an eighth of what is beside, and less."""
    begins, width = met.leaves.begin, np.maximum(met.leaves.width, NARROWEST * span)
    ratio = width[1:] / width[:-1]
    changes = begins[1:][(ratio > CHANGED) | (ratio < 1 / CHANGED)]
    out: list[float] = []
    widest, wide_until, least = span / ROOTS, begins[0], 0.0
    for t, w in zip(begins, width, strict=True):
        if least == 0.0 and w * SHRUNK <= widest:
            least = w
        if least == 0.0:
            wide_until = t + w if w * CHANGED >= widest else wide_until
            widest = max(widest, w)
            continue
        least = min(least, w)
        if w >= SHRUNK * least:
            out += changes[(changes >= wide_until) & (changes <= t)].tolist()
            widest, wide_until, least = w, t + w, 0.0
    return out + (changes[changes >= wide_until].tolist() if least else [])


def _of_functions(
    packed: Packed, loads: Loads, laws: Laws, start: float, end: float, q: np.ndarray, v: np.ndarray
) -> list[tuple[str, list[tuple[float, float]]]]:
    """Stops of the user forces by name, with the bodies as they start."""
    out: list[tuple[str, list[tuple[float, float]]]] = []
    forces = [force for force in packed.forces if "function" in force.params]
    for k, force in enumerate(forces):
        breaks, shortest = force.params.get("breaks", ()), force.params.get("shortest")
        beside = BESIDE * (end - start) + finest(start, end) / 16
        out.append((force.name, [(t - beside, t + beside) for t in breaks]))
        alone = loads._replace(
            element=loads.element[:0], interaction=loads.interaction[:0], user=loads.user[k : k + 1], total=1
        )
        values = _values(packed, alone, laws, force.params["bodies"], q, v)
        looks = look_times(start, end, shortest, FORCE_LOOKS)
        try:
            cuts = given_cuts(breaks, start, end)
            out.append((force.name, _of_function(packed, force.name, Sampled(values), start, end, cuts, looks)))
        except ModelError:
            continue  # it fails at some time: the run reports it when it gets there, if it does
    return out


def _values(
    packed: Packed, alone: Loads, laws: Laws, bodies: Sequence[str], q: np.ndarray, v: np.ndarray
) -> Callable[[np.ndarray], np.ndarray]:
    columns = (3 * np.array([packed.body_names.index(name) for name in bodies])[:, None] + np.arange(3)).ravel()

    def values(times: np.ndarray) -> np.ndarray:
        """(n, 3 k) forces and torques at times (n,)."""
        chunks = []
        for part in np.array_split(times, max(1, len(times) * len(q) // CHUNK)):
            count = len(part)
            out = np.zeros((count, len(q)))
            poses, rates = np.repeat(q[None], count, axis=0), np.repeat(v[None], count, axis=0)
            tabulate_loads(packed.system, alone, laws, part, poses, rates, packed.ws, out, np.zeros(count))
            packed.specials.check()
            chunks.append(out[:, columns])
        return np.concatenate(chunks)

    return values


class _Column:
    """One column of what was sampled."""

    def __init__(self, whole: Sampled, seen: np.ndarray, column: int) -> None:
        self._whole, self._seen, self._column = whole, seen, column

    @property
    def count(self) -> int:
        return self._whole.count

    def once(self, times: np.ndarray) -> np.ndarray:
        """Return the values that were looked at before."""
        return self._seen[:, self._column]

    def __call__(self, times: np.ndarray) -> np.ndarray:
        return self._whole(times)[..., self._column]


def _of_function(
    packed: Packed, name: str, sampled: Sampled, start: float, end: float, cuts: list[Cut], looks: np.ndarray
) -> list[tuple[float, float]]:
    seen = sampled.once(looks)
    out: list[tuple[float, float]] = []
    for column in range(seen.shape[1]):
        if not np.ptp(seen[:, column]) > 0.0:
            continue
        part = _Column(sampled, seen, column)
        met = fit(part, start, end, cuts, looks, True, FUNCTION_TOLERANCE, MOST_CALLS)  # pyright: ignore[reportArgumentType]
        for cut in met.cuts:
            at_once = cut.right - cut.left < AT_ONCE * (end - start)
            out.append((cut.left, cut.right) if at_once else (cut.at, cut.at))
        out += [(t, t) for t in _pulses(met, end - start)]
        if met.overrun:
            warnings.warn(
                f"{packed.name}: force '{name}' changes with time too often to be looked at closely: after "
                f"{sampled.count} values {met.missed:.2g} of it is missed near t = {met.missed_at:.6g} s. If it has "
                "short pulses, give shortest= (s), or breaks= where it jumps",
                ModelWarning,
                stacklevel=6,
            )
            break
    return out
