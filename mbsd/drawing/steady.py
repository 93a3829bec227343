"""Constants of all pictures of a motion: extent, size of symbols, sides of ground's signs, turns of springs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from mbsd.drawing.canvas import Canvas
from mbsd.drawing.pose import Pose
from mbsd.drawing.skeleton import draw_on, measure_all, steady_sides
from mbsd.model.mechanism import Model


@dataclass(frozen=True, eq=False)
class Steady:
    """Found from some poses of a motion, the first one first."""

    low: np.ndarray
    high: np.ndarray
    """(2,) extent of the machine over the whole motion (m)."""
    unit: float
    """Unit of its symbols (m)."""
    sides: dict[str, np.ndarray]
    coils: dict[str, int]
    wheels: dict[tuple[str, float], tuple[int, float]]
    """Teeth and phase (rad) of gears in the first pose, by body and radius."""

    def ready(self, canvas: Canvas, turned: Mapping[str, float]) -> None:
        """Tell a canvas the turns of springs, and how gears stand whose bodies have turned by angles (rad)."""
        canvas.coils.update(self.coils)
        for (body, radius), (teeth, phase) in self.wheels.items():
            canvas.turned[body, radius] = teeth, phase + teeth * turned[body]


def steady_of(m: Model, poses: Sequence[Pose], colours: dict[str, str], recorder: type[Canvas]) -> Steady:
    """Return the constants of these poses; ``recorder`` is a canvas that needs no axes."""
    low, high, unit = measure_all(m, poses)
    sides = steady_sides(m, poses, unit)
    turns: dict[str, list[int]] = {}
    wheels: dict[tuple[str, float], tuple[int, float]] = {}
    for k, pose in enumerate(poses):
        canvas = recorder(None, unit)
        draw_on(canvas, m, pose, colours, False, sides)
        for name, count in canvas.coils.items():
            turns.setdefault(name, []).append(count)
        if k == 0:
            wheels = dict(canvas.wheels)
    coils = {name: int(np.median(counts)) for name, counts in turns.items()}
    return Steady(low, high, unit, sides, coils, wheels)
