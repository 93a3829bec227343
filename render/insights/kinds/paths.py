"""Insights into paths of traced points: straight stretches, ellipses, cusps, crossings, and steps of a foot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from render.insights.insight import Insight
from render.insights.seen import Array, Seen, amount, body, insight, point

STRAIGHT = 0.01
"""Deviation of a stretch that counts as straight, in parts of its length."""
EXACT = 1e-6
LEAST = 0.3
"""Length of such a stretch at least, in parts of the path's size."""
PARTS = np.arange(1.0, 0.14, -0.05)
"""Parts of the path that are looked at, longest first."""
COARSE = 360
"""Samples of a path that are looked at."""


def paths(seen: Seen) -> Iterator[Insight]:
    """Yield all insights of this chapter."""
    for name, traced in seen.motion.points.items():
        way = np.stack([traced.x, traced.y], axis=1)
        size = float(np.hypot(*np.ptp(way, axis=0)))
        is_held = any(traced.body in each.bodies for each in seen.motion.joints.values())
        if not is_held or size < 1e-2 * seen.size or traced.body in seen.guided:
            continue
        rows = seen.window()
        if not seen.repeats and seen.motion.analysis == "simulation":
            yield from reach(seen, name, way)
            continue
        found = [] if traced.body in seen.pinned else list(straight(seen, name, way[rows], size))
        yield from found
        if any(each.template == "straight_exactly" for each in found):
            continue
        yield from oval(seen, name, way[rows])
        if not seen.repeats or traced.body in seen.pinned:
            continue
        yield from cusps(seen, name, rows)
        yield from crossings(seen, name, way[rows])
        yield from step(seen, name, way[rows])


def reach(seen: Seen, name: str, way: Array) -> Iterator[Insight]:
    """Yield how far a point comes in a motion that does not repeat."""
    wide, high = np.ptp(way, axis=0)
    yield insight(
        "reach", max(wide, high), "m", (float(seen.time[0]), float(seen.time[-1])), 0.2, joints=(name,),
        point=point(name), wide=amount(wide, "m"), high=amount(high, "m"),
    )  # fmt: skip


def straight(seen: Seen, name: str, way: Array, size: float) -> Iterator[Insight]:
    """Yield the longest stretch of a path that is straight to within a part of its length."""
    stretch = straightest(way, size, closed=seen.repeats)
    if stretch is None:
        return
    first, count, length, deviation = stretch
    time = seen.time[: len(way)]
    turn = float(time[-1] - time[0])
    start = float(time[first])
    last = first + count - 1
    end = float(time[last]) if last < len(way) else float(time[last - len(way) + 1]) + turn
    if length < LEAST * size:
        return
    if deviation < EXACT * length:
        yield insight(
            "straight_line", deviation, "m", (start, end), 1.0, "straight_exactly", joints=(name,),
            bodies=(seen.motion.points[name].body,), point=point(name), length=amount(length, "m"),
        )  # fmt: skip
        return
    share = (end - start) / turn
    values: dict[str, Any] = {"point": point(name), "length": amount(length, "m"), "off": amount(deviation, "m", 2)}
    strength = 0.35 + 0.5 * length / size + 0.2 * share - 10 * deviation / length
    template = "straight_line"
    if seen.input is not None and seen.input.turns:
        template = "straight_between"
        values |= {
            "crank": body(seen.input.body),
            "begin": amount(seen.angle_at(start), "place"),
            "to": amount(seen.angle_at(end % _end(seen)), "place"),
        }
    yield insight(
        "straight_line", deviation, "m", (start, end), strength, template, joints=(name,),
        bodies=(seen.motion.points[name].body,), **values,
    )  # fmt: skip


def _end(seen: Seen) -> float:
    return seen.span + 1e-12 if seen.time[0] == 0 else math.inf


def straightest(way: Array, size: float, closed: bool) -> tuple[int, int, float, float] | None:
    """Return first row, count of rows, length and largest deviation (m) of the longest straight stretch; else None.

    ``way`` (n, 2) is closed if its last row is its first again. The deviation is from the line that fits best.
    """
    closed = closed and float(np.abs(way[0] - way[-1]).max()) < EXACT * size
    ring = way[:-1] if closed else way
    n = len(ring)
    step = max(1, n // COARSE)
    for part in PARTS:
        count = max(int(part * (n - 1)) + 1, 8)
        starts = np.arange(0, n if closed and part < 1 else n - count + 1, step)
        if not len(starts):
            continue
        rows = (starts[:, None] + np.arange(0, count, step)[None]) % n
        windows = ring[rows]
        middle = windows - windows.mean(axis=1, keepdims=True)
        spread = np.einsum("sik,sil->skl", middle, middle)
        _, vectors = np.linalg.eigh(spread)
        across = np.abs(np.einsum("sik,sk->si", middle, vectors[:, :, 0])).max(axis=1)
        along = np.ptp(np.einsum("sik,sk->si", middle, vectors[:, :, 1]), axis=1)
        fits = across / np.maximum(along, 1e-300)
        good = (fits < STRAIGHT) & (along >= LEAST * size)
        if good.any():
            k = int(np.where(good, fits, np.inf).argmin())
            first = int(starts[k])
            return first, count, *_fit(ring[(first + np.arange(count)) % n])
    return None


def _fit(points: Array) -> tuple[float, float]:
    """Return length and largest deviation of points from the line that fits them best."""
    middle = points - points.mean(axis=0)
    axes = np.linalg.svd(middle, full_matrices=False)[2]
    return float(np.ptp(middle @ axes[0])), float(np.abs(middle @ axes[1]).max())


def oval(seen: Seen, name: str, way: Array) -> Iterator[Insight]:
    """Yield paths that are an ellipse or a circle, but for circles of bodies pinned on ground."""
    traced = seen.motion.points[name]
    if traced.body in seen.pinned or not seen.repeats:
        return
    axes = ellipse(way)
    if axes is None:
        return
    middle = way - (way.max(axis=0) + way.min(axis=0)) / 2
    if np.ptp(np.unwrap(np.arctan2(middle[:, 1], middle[:, 0]))) < 1.9 * math.pi:
        return  # an arc alone
    large, small = axes
    if large - small < EXACT * large:
        yield insight(
            "ellipse", large, "m", (float(seen.time[0]), float(seen.time[-1])), 0.7, "circle", bodies=(traced.body,),
            joints=(name,), point=point(name), radius=amount(large, "m"), body=body(traced.body),
        )  # fmt: skip
    elif small > 1e-3 * large:
        yield insight(
            "ellipse", large, "m", (float(seen.time[0]), float(seen.time[-1])), 0.9, bodies=(traced.body,),
            joints=(name,), point=point(name), large=amount(2 * large, "m"), small=amount(2 * small, "m"),
        )  # fmt: skip


def ellipse(way: Array) -> tuple[float, float] | None:
    """Return the half axes (m) of the ellipse on which all points lie; None of any other path."""
    middle = way - (way.max(axis=0) + way.min(axis=0)) / 2
    size = float(np.abs(middle).max())
    x, y = (middle / size).T
    rows = np.stack([x * x, x * y, y * y, x, y], axis=1)
    fit, *_ = np.linalg.lstsq(rows, np.ones(len(rows)), rcond=None)
    if np.abs(rows @ fit - 1).max() > EXACT:
        return None
    a, b, c, d, e = fit
    form = np.array([[a, b / 2], [b / 2, c]])
    values = np.linalg.eigvalsh(form)
    if values[0] <= 1e-9:
        return None
    centre = np.linalg.solve(-2 * form, np.array([d, e]))
    level = 1 + centre @ form @ centre
    axes = size * np.sqrt(level / values)
    return float(axes.max()), float(axes.min())


def cusps(seen: Seen, name: str, rows: slice) -> Iterator[Insight]:
    """Yield the cusp of a path: the point all but stands there and leaves the way it came."""
    traced = seen.motion.points[name]
    vx, vy = np.array(traced.vx)[rows], np.array(traced.vy)[rows]
    speed = np.hypot(vx, vy)
    k = int(speed.argmin())
    if speed[k] > 0.02 * speed.max():
        return
    n = len(speed) - 1
    reach = max(2, n // 60)
    before, after = (np.array([vx[(k + s) % n], vy[(k + s) % n]]) for s in (-reach, reach))
    cosine = float(before @ after / max(float(np.hypot(*before) * np.hypot(*after)), 1e-300))
    if cosine < -0.5:
        yield insight(
            "cusp", speed[k], "m/s", seen.at(k), 0.5, bodies=(traced.body,), joints=(name,),
            point=point(name), at=seen.moment(float(seen.time[k])),
        )  # fmt: skip


def crossings(seen: Seen, name: str, way: Array) -> Iterator[Insight]:
    """Yield how often a closed path crosses itself."""
    places = self_crossings(way)
    if 0 < len(places) <= 3:
        traced = seen.motion.points[name]
        first, second = places[0]
        time = seen.time[: len(way)]
        moments = [float(np.interp(at, np.arange(len(time)), time)) for at in (first, second)]
        template = "crossing" if len(places) == 1 else "crossings"
        yield insight(
            "crossing", len(places), "", (moments[0], moments[1]), 0.45, template, bodies=(traced.body,),
            joints=(name,), point=point(name), count=amount(len(places), "count"),
            first=seen.moment(moments[0]), second=seen.moment(moments[1]),
        )  # fmt: skip


def self_crossings(way: Array) -> list[tuple[float, float]]:
    """Return rows (with parts) at which the segments of a path (n, 2) cross each other, in pairs."""
    keep = np.concatenate([[True], np.hypot(*np.diff(way, axis=0).T) > 1e-9 * float(np.ptp(way))])
    at, way = np.flatnonzero(keep).astype(float), way[keep]
    a, d = way[:-1], np.diff(way, axis=0)
    n = len(d)
    out = []
    for i in range(n - 2):
        j = np.arange(i + 2, n - (i == 0))
        cross = d[i, 0] * d[j, 1] - d[i, 1] * d[j, 0]
        gap = a[j] - a[i]
        safe = np.where(np.abs(cross) > 1e-12 * float(np.abs(d).max()) ** 2, cross, np.inf)
        s = (gap[:, 0] * d[j, 1] - gap[:, 1] * d[j, 0]) / safe
        t = (gap[:, 0] * d[i, 1] - gap[:, 1] * d[i, 0]) / safe
        hit = (s > 0) & (s <= 1) & (t > 0) & (t <= 1) & np.isfinite(safe)
        out += [(float(at[i] + s[k]), float(at[j[k]] + t[k])) for k in np.flatnonzero(hit)]
    return out


def step(seen: Seen, name: str, way: Array) -> Iterator[Insight]:
    """Yield the step of a foot: the low part of its path is nearly level, and long."""
    (wide, high), low = np.ptp(way, axis=0), way[:, 1].min()
    on_ground = way[:, 1] < low + 0.06 * high
    share = seen.share(np.concatenate([on_ground, np.zeros(len(seen.time) - len(way), bool)])) * (
        seen.span / float(seen.time[len(way) - 1] - seen.time[0])
    )
    length = float(np.ptp(way[on_ground, 0]))
    if share < 0.3 or length < 0.6 * wide or high < 0.1 * wide or not any(seen.motion.gravity):
        return
    start, end = next(seen.stretches(np.concatenate([on_ground, np.zeros(len(seen.time) - len(way), bool)])))
    yield insight(
        "step", length, "m", (start, end), 1.0, bodies=(seen.motion.points[name].body,), joints=(name,),
        point=point(name), length=amount(length, "m"), high=amount(high, "m"), share=amount(share, "share"),
    )  # fmt: skip
