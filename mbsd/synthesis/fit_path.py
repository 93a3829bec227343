"""Path synthesis: the lengths with which a traced point of a mechanism follows given points."""

from __future__ import annotations

import copy
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from mbsd.base.arguments import checked, finite_number, number_array, switch, users_progress, whole_number
from mbsd.base.errors import MechanismError, ModelError
from mbsd.base.names import Suggesting, no_such, shown
from mbsd.base.quantity import counted
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model, Start, new_name, own_body
from mbsd.synthesis.designs import Build, Designs
from mbsd.synthesis.search import Search
from mbsd.synthesis.target import Target
from mbsd.synthesis.variables import Value, refuse_build, refuse_names, varied

COARSE, FINE = 120, 360
"""Steps of a motion in the search and in the fit."""
FEWEST = 12
"""Steps of the search at least."""
TRACE = "fitted"
"""Name of the traced point where a marker is given."""


class SynthesisError(MechanismError):
    """No design within the bounds does what is asked for."""


@dataclass(frozen=True, eq=False)
class PathFit(Suggesting):
    """Result of :func:`fit_path`. Lengths in m, times in s, angles in rad."""

    mechanism: Any
    """The fitted Mechanism."""
    values: dict[str, Value]
    """Varied numbers by name: a length, or a place (x, y)."""
    distances: np.ndarray
    """(N,) of the points from the path; with times, from where the traced point is at its time."""
    path: np.ndarray
    """(T, 2) of the traced point."""
    shift: float
    """The time that was added to the given times; 0 where none is free."""
    least_transmission: float
    """Least transmission angle over the motion; pi/2 where no pin has one."""
    history: np.ndarray
    """Best root mean square distance after each step of the search, of all starts one after the other."""
    starts: list[float]
    """Root mean square distance that each start ended with; infinite where none of its designs served."""
    evaluations: int
    """Designs that were swept."""

    @property
    def mean(self) -> float:
        """Mean distance."""
        return float(self.distances.mean())

    @property
    def largest(self) -> float:
        """Largest distance."""
        return float(self.distances.max())

    def __repr__(self) -> str:
        return f"<PathFit of {self.mechanism.name}: mean {self.mean:.3g} m, largest {self.largest:.3g} m>"


@checked
def fit_path(
    m: Any,
    points: Sequence[Sequence[float]] | np.ndarray,
    vary: Mapping[str, Any],
    *,
    point: str | Marker | None = None,
    times: Sequence[float] | np.ndarray | None = None,
    free_start: bool = False,
    closed: bool = False,
    ordered: bool = False,
    build: Build | None = None,
    grashof: bool = False,
    least_transmission: float = 0.0,
    starts: int = 3,
    seed: int = 0,
    generations: int = 200,
    duration: float | None = None,
    steps: int = FINE,
    progress: Callable[[float, float], object] | None = None,
    better: Callable[[dict[str, Value], float], object] | None = None,
) -> PathFit:
    """Fit lengths and positions of a driven mechanism to a path through points (N, 2) (m).

    A traced point then passes through them. ``vary``: names of bars or rods and the bounds of their lengths, ``(low,
    high)``; names of joints or traced points and the bounds of their places, ``((low, high), (low, high))``, which mean
    what they mean in :meth:`mbsd.mechanism.Mechanism.batch`. With ``build``, a function that returns the mechanism,
    names are those of its arguments, which it gets as numbers, or tuples where there are several bounds. ``point``: the
    traced point by name, or a marker; it may be left out where there is one.

    Without ``times`` a point counts by its distance from the path, wherever that is and in any order; ``closed`` says
    that the points are a closed curve that is the whole path, so the path must not leave it either. With ``ordered``
    the points are reached one after the other, in the sense of the motion, on a path that returns from a start anywhere
    and within one turn. ``times`` (N,) (s) are those at which the points are to be reached (of a crank that turns
    evenly: its angle by its rate); with ``free_start`` a time common to all may be added to them.

    Conditions: the links close over the whole motion, so a crank that is driven round turns fully; ``grashof`` holds a
    four-bar of four pins to s + l <= p + q; ``least_transmission`` (rad) is what the transmission angle keeps at each
    pin between two links that are not driven.

    The search sweeps a low-discrepancy spread of designs and goes down from the best side by side by least squares;
    where none comes near the points, differential evolution goes on with at most ``generations``. It is made anew
    ``starts`` times with seeds that follow from ``seed``. Equal arguments give equal results.
    All designs are on the branch (assembly) of ``m``; mechanisms that are not made of driven bodies and dyads are swept
    one by one, a hundred times slower. ``progress`` is called with the part done (0 .. 1) and the best
    root mean square distance (m), ``better`` with the values of the best design so far, by the names of ``vary``, and
    its root mean square distance (m), whenever there is a better one; what they raise ends the fit.

    Raises ModelError for arguments that cannot be, SynthesisError where no design closes and meets the conditions,
    and what the mechanism's sweep raises.
    """
    if not isinstance(m, Model):
        raise ModelError(f"fit_path: the mechanism is {shown(m)}; give a Mechanism")
    target_points = _points(m, points)
    given = varied(m.name, vary)
    refuse_names(m, given) if build is None else refuse_build(f"{m.name}: fit_path", build, list(given.sizes))
    m, trace = _traced(m, point, build)
    starts = whole_number(f"{m.name}: fit_path: starts", starts)
    generations = whole_number(f"{m.name}: fit_path: generations", generations)
    fine = _grid(m, duration, whole_number(f"{m.name}: fit_path: steps", steps, FEWEST))
    limit = finite_number(f"{m.name}: fit_path: least_transmission (rad)", least_transmission)
    if not 0 <= limit < np.pi / 2:
        raise ModelError(f"{m.name}: fit_path: least_transmission is {limit:g} rad; it must be from 0 to below pi/2")
    grids = {True: fine, False: np.linspace(fine[0], fine[-1], min(COARSE, len(fine) - 1) + 1)}
    designs = Designs(m, given, build, trace, grids, switch(f"{m.name}: fit_path: grashof", grashof))
    target = _target(m, target_points, times, closed, ordered, fine)
    shifts = switch(f"{m.name}: fit_path: free_start", free_start)
    if shifts and target.times is None:
        raise ModelError(f"{m.name}: fit_path: free_start adds a time to those that are given; give times=, too")
    search = Search(designs, target, shifts, limit, generations, _told(m.name, "progress", progress))
    if better is not None:
        tell = _told(m.name, "better", better)
        search.better = lambda x, error: tell(given.values(x[: given.count]), error)
    outcome = search.run(starts, whole_number(f"{m.name}: fit_path: seed", seed, 0))
    if outcome is None:
        raise SynthesisError(_nothing(m, search, limit, grashof))
    return _result(search, trace, *outcome)


def _result(search: Search, trace: str, x: np.ndarray, ends: list[float]) -> PathFit:
    """Return the fitted mechanism, swept once more by itself: what is reported is its own motion."""
    designs, target = search.designs, search.target
    shift = float(x[-1]) if search.free_shift else 0.0
    own = x[: designs.varied.count]
    fitted: Any = designs.model(own)
    _start_on_branch(fitted, designs, own)
    grid = designs.grids[True]
    solution = fitted.sweep(times=grid)
    along = solution.point(trace)
    path = np.column_stack([along.x, along.y])
    away = target.reached(path, shift) - target.points
    least = float(designs(own[None], fine=True).transmission[0])
    return PathFit(
        fitted, designs.varied.values(own), np.hypot(*away.T), path, shift, least, np.array(search.history), ends,
        designs.evaluations,
    )  # fmt: skip


def _start_on_branch(fitted: Model, designs: Designs, x: np.ndarray) -> None:
    """Let the fitted mechanism start on the branch of the design, which other lengths may have left."""
    if not designs.at_once:
        return
    from mbsd.kinematics.design_sweeps import DesignSweeps

    values, moved = designs.changes(x[None])
    free = [name for name in fitted.bodies if name != "ground" and not _placed(fitted.starts.get(name))]
    first = designs.grids[True][:1]
    angles = DesignSweeps(designs.m, designs.ready, first, moved, free)(values).angles
    for name in free:
        fitted.starts[name] = Start(float(angles[name][0, 0]))


def _placed(start: Start | None) -> bool:
    return start is not None and start.place is not None


def _points(m: Model, points: object) -> np.ndarray:
    places = number_array(f"{m.name}: fit_path: points", points)
    if places.ndim != 2 or places.shape[1] != 2 or len(places) < 2:
        raise ModelError(f"{m.name}: fit_path: points have shape {places.shape}; give two or more places (x, y)")
    if not np.ptp(places, axis=0).any():
        raise ModelError(f"{m.name}: fit_path: all points are the same place; a path needs some that differ")
    return places


def _target(m: Model, points: np.ndarray, times: object, closed: bool, ordered: bool, fine: np.ndarray) -> Target:
    """Return the target of points (N, 2) for a motion at times ``fine`` (T,) (s). Raises ModelError."""
    target = Target(
        points, _times(m, times, len(points)), switch(f"{m.name}: fit_path: closed", closed),
        _returns(m, fine), (float(fine[0]), float(fine[-1])), switch(f"{m.name}: fit_path: ordered", ordered),
    )  # fmt: skip
    if target.ordered and target.times is not None:
        raise ModelError(f"{m.name}: fit_path: with times the order of the points is theirs; leave out ordered=True")
    return target


def _times(m: Model, times: object, count: int) -> np.ndarray | None:
    if times is None:
        return None
    moments = number_array(f"{m.name}: fit_path: times", times)
    if moments.shape != (count,):
        raise ModelError(f"{m.name}: fit_path: {count} points have times of shape {moments.shape}; give one time each")
    if len(np.unique(moments)) < count:
        raise ModelError(f"{m.name}: fit_path: two points have the same time; the point is at one of them then")
    return moments


def _traced(m: Model, point: str | Marker | None, build: Build | None) -> tuple[Model, str]:
    """Return the mechanism, which traces the point, and the name of the trace. Raises ModelError."""
    if isinstance(point, Marker):
        if build is not None:
            raise ModelError(f"{m.name}: fit_path: with build the point is a name; trace it there: m.trace(...)")
        own_body(m, point.body, "fit_path: point")
        out = copy.deepcopy(m)
        new_name(out, TRACE, "trace", out.traces)
        out.traces[TRACE] = replace(point, body=out.bodies[point.body.name])
        return out, TRACE
    if point is None and len(m.traces) == 1:
        return m, next(iter(m.traces))
    if point is None:
        some = ", ".join(m.traces) or "none; add one by m.trace(...)"
        raise ModelError(f"{m.name}: fit_path: which point? There is: {some}; say point=...")
    if point not in m.traces:
        raise ModelError(f"{m.name}: fit_path: {no_such('traced point', point, m.traces)}")
    return m, point


def _grid(m: Model, duration: float | None, steps: int) -> np.ndarray:
    from mbsd.kinematics.sweep import sweep_times

    return sweep_times(m, duration, steps, None)


def _returns(m: Model, grid: np.ndarray) -> bool:
    """Return True if the motion is whole periods of the drivers."""
    from mbsd.kinematics.period import common_period

    common = common_period(m.drivers.values())
    if common is None:
        return False
    turns = (grid[-1] - grid[0]) / common
    return bool(abs(turns - round(turns)) < 1e-9 and turns > 0.5)


def _told(owner: str, name: str, function: Callable[[Any, float], object] | None) -> Callable[[Any, float], None]:
    own = users_progress(f"{owner}: fit_path: {name}", function, "two arguments", 2)
    return own or (lambda what, error: None)


def _nothing(m: Model, search: Search, limit: float, grashof: bool) -> str:
    asked = [f"a transmission angle of {limit:g} rad"] * bool(limit) + ["Grashof's condition"] * bool(grashof)
    tried = f"{m.name}: fit_path: of {counted(search.designs.evaluations, 'design')} within the bounds "
    if not search.closed:
        return f"{tried}none closes over the whole motion; widen vary, or drive a link that can turn so far"
    closed = (
        "1 closes, and it does not meet" if search.closed == 1 else f"{search.closed} close, and none of them meets"
    )
    return f"{tried}{closed} {' and '.join(asked)}; ask for less, or widen vary"
