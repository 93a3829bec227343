"""Arrows and arcs of a picture, with their words."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from render.film.clock import Clock
from render.film.scene import ArcSpec, ArrowSpec, LegendRow, Point, across_axes
from render.film.vectors import LONGEST, TINY, UNIT, Torque, Vector, at_time, lifted, scales_of
from render.magnitudes import travels
from shared.contract import AnyMotion, Motion
from shared.contract.quantity import figures, live, written
from shared.contract.shot import Shot
from shared.contract.signals import SIGNALS, rgb
from shared.contract.space import ForceMotion3, columns

# Arrows of a film: how long each is, and its line in the legend. One scale for the whole clip and for each unit.

Array = NDArray[np.float64]
FULL = 0.25
"""Length of the largest arrow, as a part of the size of the swept motion."""
SHAFT, HEAD, POINT = 0.0042, 0.0125, 0.037
"""Radii of shaft and cone and the cone's length, as parts of the size of the swept motion."""


class Arrows:
    """The arrows of one film, ``size`` (m) being that of its swept motion."""

    def __init__(self, time: Array, vectors: Sequence[Vector], size: float) -> None:
        self.time, self.size = time, size
        self.scales = scales_of(vectors)
        self.vectors = [v for v in vectors if self._lengths(v).max() >= TINY * FULL * size]
        """Vectors that are seen at some time."""

    def specs(self) -> list[ArrowSpec]:
        """Return their looks, in the order of ``vectors``."""
        return [
            ArrowSpec(
                name=f"{vector.quantity} {vector.name}",
                colour=rgb(SIGNALS[vector.row].dark),
                tip=SIGNALS[vector.row].head,
                shaft=SHAFT * self.size,
                head=HEAD * self.size,
                point=POINT * self.size,
            )
            for vector in self.vectors
        ]

    def legend(self, width: float) -> list[LegendRow]:
        """Return a row for each quantity, and for weights.

        The picture is ``width`` (m) wide where the machine is.
        """
        rows = []
        for quantity, unit in dict.fromkeys((vector.row, vector.unit) for vector in self.vectors):
            scale = self.scales[unit]
            length = FULL * self.size * scale.reference / scale.largest / width
            cut = any(
                float(vector.size.max()) > LONGEST * scale.largest * (1 + 1e-9)
                for vector in self.vectors
                if vector.row == quantity
            )
            words = f"{quantity}, peaks cut" if cut else quantity
            rows.append(
                LegendRow(
                    number=written(scale.reference, scale.unit),
                    words=words,
                    colour=rgb(SIGNALS[quantity].dark),
                    tip=SIGNALS[quantity].head,
                    length=length,
                    point=POINT * self.size / width,
                )
            )
        return rows

    def ends_at(self, t: float, heights: Sequence[float]) -> list[tuple[Point, Point]]:
        """Return the tail and tip of each at time ``t``; equal where it is left out.

        They lie ``heights`` (m) over the base.
        """
        out = []
        for vector, z in zip(self.vectors, heights, strict=True):
            x, y, z, u, v, w = (float(k) for k in at_time(self.time, np.hstack(vector.lifted(z)), t))
            size = math.hypot(u, v, w)
            length = self._length(size, vector.unit)
            if size == 0 or length < TINY * FULL * self.size:
                length, size = 0.0, 1.0
            out.append(((x, y, z), (x + u / size * length, y + v / size * length, z + w / size * length)))
        return out

    def tips(self, heights: Sequence[float], way: Array | None = None) -> list[Array]:
        """Return where each tip (n, 3; m) is over the whole motion, wherever there is one.

        They are as seen from a ``way`` (T, 3).
        """
        out = []
        for vector, z in zip(self.vectors, heights, strict=True):
            length = self._lengths(vector)
            seen = length >= TINY * FULL * self.size
            place, value = vector.lifted(z)
            tip = place[seen] + value[seen] * (length[seen] / vector.size[seen])[:, None]
            out.append(tip - (0.0 if way is None else way[seen]))
        return out

    def _lengths(self, vector: Vector) -> Array:
        unit = vector.unit
        return np.array([self._length(float(size), unit) for size in vector.size])

    def _length(self, size: float, unit: str) -> float:
        scale = self.scales.get(unit)
        return FULL * self.size * min(size / scale.largest, LONGEST) if scale else 0.0


# Curved arrows of a film: how far each reaches round its pivot, and its line in the legend.

FULL_TURN = 1.25 * math.pi
"""Sweep (rad) of the largest torque."""
RADIUS, APART = 0.066, 0.022
"""Radius of an arc, and how much wider each further one about the same point is, as parts of the size."""
WORDS = {"forces": "torques", "reactions": "torques of joints"}
SIGNAL = {"forces": "torques", "reactions": "reactions"}
"""Whose colour they have."""
STOUT = 1.3
"""Thickness of an arc in that of an arrow: it stands on parts, not beside them."""


class Arcs:
    """The curved arrows of one film.

    ``size`` (m) is that of its swept motion; ``least`` (N m) is rounding.
    """

    def __init__(self, time: Array, torques: Sequence[Torque], size: float, least: float = 0.0) -> None:
        self.time, self.size = time, size
        self.scale = scales_of(torques, {UNIT: least}).get(UNIT)
        self.torques = [torque for torque in torques if abs(self._sweeps(torque)).max() >= TINY * FULL_TURN]
        """Torques that are seen at some time."""

    def specs(self) -> list[ArcSpec]:
        """Return their looks, in the order of ``torques``; those about one point lie around each other."""
        return [
            ArcSpec(
                name=f"{torque.quantity} {torque.name}",
                colour=rgb(SIGNALS[SIGNAL[torque.quantity]].dark),
                radius=self._radius(k),
                shaft=STOUT * SHAFT * self.size,
                head=STOUT * HEAD * self.size,
                point=POINT * self.size,
            )
            for k, torque in enumerate(self.torques)
        ]

    def legend(self) -> list[LegendRow]:
        """Return a row for each quantity, with an arc as long as that torque's in the picture."""
        scale = self.scale
        if scale is None:
            return []
        return [
            LegendRow(
                number=written(scale.reference, scale.unit),
                words=f"{WORDS[quantity]}, peaks cut" if scale.cut else WORDS[quantity],
                colour=rgb(SIGNALS[SIGNAL[quantity]].dark),
                sweep=FULL_TURN * scale.reference / scale.largest,
            )
            for quantity in dict.fromkeys(torque.quantity for torque in self.torques)
        ]

    def sweeps_at(self, t: float, heights: Sequence[float]) -> list[tuple[Point, float, Point]]:
        """Return the centre, the sweep (rad, counter-clockwise) and the axis of each at time ``t``.

        They lie ``heights`` (m) over the base.
        """
        out = []
        for torque, z in zip(self.torques, heights, strict=True):
            rows = np.column_stack([lifted(torque.place, z), torque.value, torque.axes])
            x, y, z, value, *axis = (float(k) for k in at_time(self.time, rows, t))
            long = math.hypot(*axis)
            about = (axis[0] / long, axis[1] / long, axis[2] / long) if long > 0.0 else (0.0, 0.0, 1.0)
            sweep = float(self._sweep(np.array([value]))[0])
            out.append(((x, y, z), sweep if abs(sweep) >= TINY * FULL_TURN else 0.0, about))
        return out

    def rims(self, heights: Sequence[float], way: Array | None = None) -> list[Array]:
        """Return points (8 T, 3) around each over the whole motion (m), as seen from a ``way`` (T, 3)."""
        turn = math.tau * np.arange(8) / 8
        out = []
        for k, (torque, z) in enumerate(zip(self.torques, heights, strict=True)):
            reach = self._radius(k) + STOUT * HEAD * self.size
            x, y = across_axes(torque.axes)
            rim = np.cos(turn)[None, :, None] * x[:, None] + np.sin(turn)[None, :, None] * y[:, None]
            ring = (lifted(torque.place, z)[:, None] + reach * rim).reshape(-1, 3)
            out.append(ring - (0.0 if way is None else np.repeat(way, 8, axis=0)))
        return out

    def _radius(self, k: int) -> float:
        """Return the radius of arc number ``k`` (m): wider than those before it about the same point."""
        mine = self.torques[k].place
        inside = sum(bool(np.abs(torque.place - mine).max() < RADIUS * self.size / 4) for torque in self.torques[:k])
        return (RADIUS + APART * inside) * self.size

    def _sweeps(self, torque: Torque) -> Array:
        return self._sweep(torque.value)

    def _sweep(self, values: Array) -> Array:
        """Return (T,) rad of torques (T,) in N m."""
        if self.scale is None:
            return np.zeros(len(values))
        return FULL_TURN * np.clip(values / self.scale.largest, -LONGEST, LONGEST)


# Text over the picture: a title, the rate of time, a number that follows the motion.

FIGURES = 3
"""Significant digits."""


def title(motion: AnyMotion, shot: Shot) -> str:
    """Return the shot's title, or the mechanism's name in words; empty where none is asked for."""
    if shot.title is None:
        return ""
    if shot.title.text is not None:
        return shot.title.text
    words = motion.mechanism.replace("_", " ").replace("-", ": ")
    return words[:1].upper() + words[1:]


def rate(clock: Clock, shot: Shot) -> str:
    """Return the words on the film's rate, or none.

    They stand with a title, and always where a motion that does not repeat is not in real time.
    """
    real = abs(clock.rate - 1) < 0.02
    if real:
        return "real time" if shot.title is not None else ""
    if shot.title is None and clock.repeats:
        return ""
    slower = clock.rate < 1
    return f"{figures(1 / clock.rate if slower else clock.rate, FIGURES)} times {'slower' if slower else 'faster'}"


def number(motion: AnyMotion, shot: Shot) -> Callable[[float], str]:
    """Return the number that lives, as a function of time; it stands still."""
    name = shot.title.number if shot.title is not None else ""
    if name is None:
        name = _shown_effort(motion)
    if not name:
        return lambda t: ""
    time = np.asarray(motion.time)
    if name in motion.points:
        point = motion.points[name]
        speeds = np.hypot(np.hypot(point.vx, point.vy), getattr(point, "vz", 0.0))[:, None]
        slow, fast = live(speeds[:, 0].tolist(), "m/s", FIGURES), live((3.6 * speeds[:, 0]).tolist(), "km/h", FIGURES)
        away = isinstance(motion, Motion) and travels(motion, name)

        def speed(t: float) -> str:
            v = float(at_time(time, speeds, t)[0])
            return f"{name}  {slow(v)}   {fast(3.6 * v)}" if away else f"{name}  {slow(v)}"

        return speed
    load = motion.drivers.get(name) or motion.forces[name]
    if isinstance(load, ForceMotion3):
        effort = load.rows[0].effort if load.rows else np.linalg.norm(columns(load, "fx", "fy", "fz"), axis=1)
    else:
        effort = load.effort
    efforts = np.asarray(effort if effort is not None else np.zeros(len(time)), float)[:, None]
    write = live(efforts[:, 0].tolist(), load.effort_unit, FIGURES)
    return lambda t: f"{name}  {write(float(at_time(time, efforts, t)[0]))}"


def _shown_effort(motion: AnyMotion) -> str:
    """Return the first driver with an effort, else of what acts in its place, else of the traced points."""
    drivers = [name for name, driver in motion.drivers.items() if any(driver.effort)]
    acting = [
        name
        for name, force in motion.forces.items()
        if not isinstance(force, ForceMotion3)
        and motion.drivers
        and force.drives
        and force.effort is not None
        and any(force.effort)
    ]
    return next(iter((*drivers, *acting, *motion.drivers, *motion.points)), "")
