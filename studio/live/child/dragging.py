"""Dragging a joint or traced point: the least change of lengths that brings it to the new place.

Of all numbers x with P(x) = to, the one nearest to those x0 at which the drag began, in parts of their sizes s:

    x <- x0 + s^2 J^T (J s^2 J^T)^-1 (to - P(x) + J (x - x0)),    J = dP / dx

Numbers that move a driver (a speed) are left alone, and whole ones. Where drivers decide the motion, P is the place at
the moment of the drag; where forces do, it is that of the start pose, which lengths and start angles decide.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd import Mechanism, MechanismError, fit_path
from mbsd.arrays.packing import pack
from mbsd.kinematics.pose.initial import start_pose
from mbsd.synthesis.designs import Designs
from mbsd.synthesis.variables import Varied
from shared.stage.errors import UserError
from studio.live.child.author import Author
from studio.live.numbers import in_digits, numbers_of

Places = Callable[[np.ndarray], np.ndarray]
"""Numbers (n, k) in, places (n, 2) out (m); NaN where the links do not close."""
DRAGGED = "dragged by the page"
"""The name of the trace that follows what is dragged."""
DIFFERENCE = 1e-6
"""Step, as a fraction of a number's size, for the slopes."""
ROUNDS = 8
NEAR = 1e-7
"""Fraction of the mechanism's size: so near to the place asked for is there."""
LONGEST = 0.3
"""Fraction of its size, by which a number changes in a round at most."""
LEAST = 0.02
"""Fraction of its size at the start, below which a number does not shrink: it keeps its sign."""
STEPS = 60
"""Number of steps of the motion up to the moment of the drag."""


def dragged(
    author: Author, values: dict[str, float], thing: dict[str, str], time: float, to: list[float]
) -> dict[str, float]:
    """Return ``values`` that bring a joint or point nearest to ``to`` (m) at ``time`` (s).

    Raises UserError where it has no place that lengths decide.
    """
    names, start = lengths(author, values)
    base = _traced(author, values, {}, thing)
    if base.mobility().dof > len(base.drivers):
        return _at_start(author, values, thing, time, to, base)
    size = np.where(np.abs(start) > 0, np.abs(start), max(float(np.abs(start).max(initial=0.0)), 1e-6))
    delta = DIFFERENCE * size

    def build(**numbers: Any) -> Mechanism:
        return _traced(author, values, numbers, thing)

    varied = Varied(dict.fromkeys(names, 0), start - delta, start + delta)
    grid = np.linspace(0.0, time, STEPS + 1) if time > 0 else np.zeros(1)
    try:
        designs = Designs(base, varied, build, DRAGGED, {True: grid, False: grid}, grashof=False)
    except MechanismError as error:
        raise UserError(str(error)) from error

    def places(x: np.ndarray) -> np.ndarray:
        traced = designs(x)
        return np.where(traced.closes[:, None], traced.path[:, -1], np.nan)

    x = _nearest(places, designs.ready.packed.size, start, size, delta, np.asarray(to, float))
    return values | _found(names, start, x)


def _at_start(
    author: Author, values: dict[str, float], thing: dict[str, str], time: float, to: list[float], base: Mechanism
) -> dict[str, float]:
    """Return numbers that put the thing at ``to`` in the start pose, if forces move the mechanism."""
    if time > 0:
        raise UserError(
            f"{author.name}: it moves under forces, so its numbers place '{thing['name']}' at the start alone, "
            f"not at {time:g} s; go to the start (Home) and drag it there"
        )
    now = {number.name: number.value for number in numbers_of(author.changed(values)) if not number.whole}
    names, start, extent = list(now), np.array(list(now.values())), pack(base).size
    delta = DIFFERENCE * np.where(start == 0, max(extent, 1.0), np.abs(start))

    def places(x: np.ndarray) -> np.ndarray:
        return np.array(
            [_start_place(author, values | dict(zip(names, map(float, row), strict=True)), thing) for row in x]
        )

    around = places(np.vstack([start, start + np.diag(delta)]))
    moving = np.hypot(*(around[1:] - around[0]).T) > 1e-4 * DIFFERENCE * extent  # masses, springs and dampers do not
    if not moving.any():
        raise UserError(f"{author.name}: no number of Params decides where '{thing['name']}' is at the start")
    names, start, delta = (
        [name for name, moves in zip(names, moving, strict=True) if moves],
        start[moving],
        delta[moving],
    )
    size = np.where(start == 0, max(float(np.abs(start).max()), extent), np.abs(start))
    x = _nearest(places, extent, start, size, delta, np.asarray(to, float))
    return values | _found(names, start, x)


def _found(names: list[str], start: np.ndarray, x: np.ndarray) -> dict[str, float]:
    """Return the changed numbers, in as many digits as are written."""
    changed = np.flatnonzero(np.abs(x - start) > 1e-9 * np.abs(start))
    return in_digits({names[k]: float(x[k]) for k in changed})


def _start_place(author: Author, values: dict[str, float], thing: dict[str, str]) -> np.ndarray:
    try:
        m = _traced(author, values, {}, thing)
        packed = pack(m)
        packed.settle_laws(0.0, 1.0)
        q = start_pose(m, packed, 0.0, packed.drives(np.zeros(1))[0])[0].reshape(-1, 3)
    except (MechanismError, UserError):
        return np.full(2, np.nan)
    marker = m.traces[DRAGGED]
    body = packed.body_names.index(marker.body.name)
    x, y = np.array([marker.x, marker.y]) - packed.com[body]
    c, s = np.cos(q[body, 2]), np.sin(q[body, 2])
    return q[body, :2] + (c * x - s * y, s * x + c * y)


def lengths(author: Author, values: dict[str, float]) -> tuple[list[str], np.ndarray]:
    """Return names and values (n,) of numbers of Params that move no driver.

    Numbers that the model does not take are left out.
    """
    p = author.changed(values)
    now = {number.name: number.value for number in numbers_of(p) if not number.whole}
    grid = np.linspace(0.0, 1.0, 5)

    def drives(change: dict[str, float]) -> bytes | None:
        try:
            packed = pack(author.build(author.changed(values | change)))
            packed.settle_laws(0.0, 1.0)
            return packed.drives(grid).tobytes()
        except (MechanismError, UserError):
            return None

    if author.steady is None:
        own = drives({})
        author.steady = [name for name, value in now.items() if drives({name: value * 1.01 or 0.01}) == own]
    return author.steady, np.array([now[name] for name in author.steady])


def _nearest(
    places: Places, extent: float, start: np.ndarray, size: np.ndarray, delta: np.ndarray, to: np.ndarray
) -> np.ndarray:
    """Return the numbers (k,) nearest to ``start`` that bring the thing to ``to``."""
    least = np.where(start > 0, LEAST * size, -np.inf)
    most = np.where(start < 0, -LEAST * size, np.inf)
    x = best = start
    off = np.inf
    for _ in range(ROUNDS):
        place = places(np.vstack([x, x + np.diag(delta)]))
        if not np.isfinite(place).all():
            x = (x + best) / 2  # too far: it does not close there
            continue
        gap = to - place[0]
        if np.hypot(*gap) < off:
            best, off = x, float(np.hypot(*gap))
        if off < NEAR * extent:
            break
        slope = ((place[1:] - place[0]) / delta[:, None]).T * size  # (2, k) in sizes
        square = slope @ slope.T
        square += 1e-9 * max(float(np.trace(square)), 1e-300) * np.eye(2)
        wanted = start + size * (slope.T @ np.linalg.solve(square, gap + slope @ ((x - start) / size)))
        x = np.clip(x + np.clip(wanted - x, -LONGEST * size, LONGEST * size), least, most)
    return best


def _traced(author: Author, values: dict[str, float], numbers: dict[str, float], thing: dict[str, str]) -> Mechanism:
    m = author.build(author.changed(values | numbers))
    kind, name = thing["kind"], thing["name"]
    if kind == "joint" and name in m.joints:
        marker = m.joints[name].j
    elif kind == "point" and name in m.traces:
        marker = m.traces[name]
    else:
        raise UserError(f"{author.name}: there is no {kind} '{name}' to drag")
    m.trace(DRAGGED, marker)
    return m


# Fit of the lengths of Params so that a traced point follows a drawn path.


PERIOD = 0.1
"""Seconds between two words on how far it is; the last word always comes."""


def fitted(author: Author, request: dict[str, Any], reply: Callable[..., None]) -> None:
    """Fit, and send progress and result to ``reply``. Raises UserError.

    ``request``: point, path ([[x, y], ...] in m), closed, ordered, vary ({name: [low, high]}, or null for all lengths
    within the ranges of their sliders), starts, generations, seed, grashof, least_transmission (rad); values are where
    it begins.
    """
    values = request.get("values") or {}
    p = author.changed(values)
    m = author.build(p)
    vary = request.get("vary") or _all_lengths(author, values)
    last, leader = 0.0, None

    def build(**numbers: Any) -> Mechanism:
        return author.build(author.changed(values | numbers))

    def progress(done: float, error: float) -> None:
        nonlocal last, leader
        now = time.monotonic()
        if done >= 1.0 or now - last >= PERIOD:
            last = now
            reply({"kind": "progress", "done": done, "error": error, "values": leader})
            leader = None

    def better(values_so_far: dict[str, Any], _: float) -> None:
        nonlocal leader
        leader = values | in_digits(values_so_far)

    try:
        fit = fit_path(
            m, request["path"], {name: tuple(bounds) for name, bounds in vary.items()}, point=request.get("point"),
            closed=bool(request.get("closed")), ordered=bool(request.get("ordered")), build=build,
            grashof=bool(request.get("grashof")),
            least_transmission=float(request.get("least_transmission") or 0.0), starts=int(request.get("starts") or 2),
            seed=int(request.get("seed") or 0), generations=int(request.get("generations") or 60), progress=progress,
            better=better,
        )  # fmt: skip
    except MechanismError as error:
        raise UserError(str(error)) from error
    fitted_values = values | in_digits(fit.values)
    reply(
        {
            "kind": "fitted",
            "values": fitted_values,
            "mean": fit.mean,
            "largest": fit.largest,
            "least_transmission": fit.least_transmission,
            "path": fit.path.round(9).tolist(),
        }
    )


def _all_lengths(author: Author, values: dict[str, float]) -> dict[str, tuple[float, float]]:
    names, _ = lengths(author, values)
    ranges = {number.name: (number.low, number.high) for number in numbers_of(author.changed(values))}
    moving = {name: ranges[name] for name in names if ranges[name][0] < ranges[name][1]}
    if not moving:
        raise UserError(f"{author.name}: Params has no number that changes a length; there is nothing to fit")
    return moving
