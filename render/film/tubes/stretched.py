"""Elements that change their shape, as tubes: springs, dampers, linear drivers, ropes.

Springs are coils; dampers and drivers are a cylinder and a rod.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from render.film.poses import Moment, Poses
from render.film.scene import Point, SurfaceSpec, TubeSpec
from shared.contract import Held, Motion, Shape

Array = NDArray[np.float64]
STEEL = SurfaceSpec(colour=(0.78, 0.79, 0.81), finish="polished", roughness=0.24)
BLACK = SurfaceSpec(colour=(0.035, 0.037, 0.042), finish="satin", roughness=0.34)
FIBRE = SurfaceSpec(colour=(0.62, 0.45, 0.24), finish="rubber", roughness=0.8)
COIL, WIRE = 0.026, 0.2
"""Radius of a coil as a part of the size of the swept motion, of its wire as a part of the coil's."""
BROAD = 0.17
"""The most that a coil's radius is of the spring's least length."""
HOOK = 0.13
"""Length of each end as a part of the spring."""
PER_TURN = 20
"""Points of a helix."""
ROPE, ROPE_POINTS = 0.0042, 64
LONG, INSIDE = 0.94, 0.94
"""Length of a cylinder and of each rod that goes far out, in the least distance of the ends; the part of a rod that may
leave what it runs in."""
PIN = 1.5
"""Radius of the pins at the ends, in that of the wire or of the rod."""
FOOT = 3.6
"""Radius of a foot on ground, in that of its pin."""
Path = Callable[[Array, Array], Array]
"""Points (n, 3) between two ends (3,)."""


@dataclass(frozen=True)
class Stretched:
    """One of them: its markers, its height, and its tubes, each with its path between the ends."""

    name: str
    shape: Shape
    z: float
    tubes: list[tuple[TubeSpec, Path]]

    @property
    def specs(self) -> list[TubeSpec]:
        """Description of each tube."""
        return [spec for spec, _ in self.tubes]

    def ends(self, poses: Poses, at: Moment) -> tuple[Array, Array]:
        """Return where it is fixed (3,) at that moment (m)."""
        first, second = (
            placed(poses.body(body, at), marker)
            for body, marker in zip(self.shape.bodies, self.shape.markers, strict=True)
        )
        return np.array([*first, self.z]), np.array([*second, self.z])

    def paths(self, poses: Poses, at: Moment) -> list[list[Point]]:
        """Return the path of each tube."""
        ends = self.ends(poses, at)
        return [[(float(x), float(y), float(z)) for x, y, z in path(*ends)] for _, path in self.tubes]


def stretched(
    motion: Motion,
    size: float,
    height: Callable[[Shape, float], tuple[float, tuple[float, float]]],
    held: Mapping[str, Held],
) -> Iterator[Stretched]:
    """Yield all springs, dampers, cylinders and ropes between two points that move apart or together.

    ``held`` are those whose ends have parts, by name; what acts along an axis (gas) and drivers of a distance are drawn
    only if they are held. Of the others ``height(shape, radius)`` says where one of that radius lies (m), and how far
    down the pin at each end reaches.
    """
    gravity = np.array([*motion.gravity, 0.0])
    strength = float(np.linalg.norm(gravity))
    down = gravity / strength if strength > 0 else np.zeros(3)
    for name, force in motion.forces.items():
        own = held.get(name)
        if force.shape is None or not force.value or not (own or force.measures == "length"):
            continue
        least, most = min(map(abs, force.value)), max(map(abs, force.value))
        if least <= 0:
            continue
        if force.look not in ("coil", "cylinder"):
            continue
        radius = own.radius if own else min(COIL * size, BROAD * least)
        coil = force.look == "coil"
        tubes = coil_tubes(name, radius, least, most) if coil else cylinder_tubes(name, 0.6 * radius, least, most)
        if own:
            yield Stretched(name, force.shape, own.z, tubes)
            continue
        z, feet = height(force.shape, radius)
        yield Stretched(name, force.shape, z, [*tubes, *_pins(name, force.shape, PIN * WIRE * radius, z, feet)])
    for name, driver in motion.drivers.items():
        own = held.get(name)
        if own and driver.look == "cylinder" and driver.shape is not None and min(driver.value) > 0:
            tubes = cylinder_tubes(name, 0.6 * own.radius, min(driver.value), max(driver.value))
            yield Stretched(name, driver.shape, own.z, tubes)
    for name, contact in motion.contacts.items():
        if contact.look == "cord" and contact.shape.length:
            own, length = held.get(name), contact.shape.length
            radius = own.radius if own else ROPE * size
            path: Path = lambda a, b, length=length: sagging(a, b, length, down)  # noqa: E731
            rope = _tube(name, FIBRE, radius, ROPE_POINTS), path
            if own:
                yield Stretched(name, contact.shape, own.z, [rope])
                continue
            z, feet = height(contact.shape, radius)
            yield Stretched(name, contact.shape, z, [rope, *_pins(name, contact.shape, PIN * radius, z, feet)])


def helix(a: Array, b: Array, radius: float, turns: int, hook: float = HOOK) -> Array:
    """Return points (n, 3) of a wire from ``a`` to ``b``: straight ends, and ``turns`` round the axis.

    The coils lie about the line between the ends at ``radius`` (m); the wire bends into them within a turn.
    """
    axis = b - a
    length = float(np.linalg.norm(axis))
    along = axis / length
    up = np.array([0.0, 0.0, 1.0])
    side = np.cross(up, along)
    if np.linalg.norm(side) < 0.1:  # nearly upright
        side = np.cross(np.array([0.0, 1.0, 0.0]), along)
    if along[2] != 0.0:
        side /= np.linalg.norm(side)
        up = np.cross(along, side)
    inner = np.linspace(0, 1, PER_TURN * (turns + 2) + 1)
    angle = math.tau * (turns + 2) * inner
    ramp = np.clip(np.minimum(inner, 1 - inner) * (turns + 2), 0, 1)
    ramp = ramp * ramp * (3 - 2 * ramp)
    way = hook + (1 - 2 * hook) * inner
    out = a + np.outer(way * length, along)
    out += radius * ramp[:, None] * (np.outer(np.cos(angle), side) + np.outer(np.sin(angle), up))
    return np.concatenate([a[None], out, b[None]])


def sagging(a: Array, b: Array, length: float, down: Array) -> Array:
    """Return points (ROPE_POINTS, 3) of a rope of ``length`` (m).

    It is straight where taut, else a parabola along ``down``.
    """
    part = np.linspace(0, 1, ROPE_POINTS)
    line = a + part[:, None] * (b - a)
    hang = (4 * part * (1 - part))[:, None] * down
    low, high = 0.0, length if down.any() and length > np.linalg.norm(b - a) * (1 + 1e-9) else 0.0
    for _ in range(60 if high else 0):
        sag = (low + high) / 2
        long = np.linalg.norm(np.diff(line + sag * hang, axis=0), axis=1).sum() > length
        low, high = (low, sag) if long else (sag, high)
    return line + low * hang


def coil_tubes(name: str, radius: float, least: float, most: float) -> list[tuple[TubeSpec, Path]]:
    """Return a coil of as many turns as fill it well in between, and never lie on one another."""
    wire, room = WIRE * radius, 1 - 2 * HOOK
    turns = min(round(room * (least + most) / 2 / (0.95 * radius)), int(room * least / (2.3 * wire)) - 2)
    turns = min(max(turns, 3), 18)
    spec = _tube(name, STEEL, wire, PER_TURN * (turns + 2) + 3)
    return [(spec, lambda a, b: helix(a, b, radius, turns))]


def cylinder_tubes(name: str, radius: float, least: float, most: float) -> list[tuple[TubeSpec, Path]]:
    """Return a cylinder from the first end, and a rod from the second that never leaves it.

    The rod does not reach through. One that goes out by far is longer, and by farther a telescope.
    """
    body, stages = 0.68 * least, 1
    reach = min(0.9 * least, max(0.45 * least, most - 0.9 * body))
    if 0.9 * body + reach < most:
        body, reach = LONG * least, LONG * least
        stages = max(1, math.ceil((most - body) / (INSIDE * reach)))

    def cylinder(a: Array, b: Array) -> Array:
        along = (b - a) / np.linalg.norm(b - a)
        return np.array([a + 0.1 * body * along, a + body * along])

    def rod(stage: int) -> Path:
        def path(a: Array, b: Array) -> Array:
            length = float(np.linalg.norm(b - a))
            along = (b - a) / length
            out = body + (length - body) * stage / stages
            return np.array([a + out * along, a + (out - reach) * along])

        return path

    def eye(a: Array, b: Array) -> Array:
        along = (b - a) / np.linalg.norm(b - a)
        return np.array([a, a + 0.12 * body * along])

    rods = []
    for stage in range(1, stages + 1):
        called = f"{name} rod" if stage == stages else f"{name} stage {stage}"
        thick = 0.42 + 0.43 * (stages - stage) / stages
        rods.append((_tube(called, STEEL, thick * radius, 2), rod(stage)))
    return [
        (_tube(f"{name} cylinder", BLACK, radius, 2), cylinder),
        *rods,
        (_tube(f"{name} eye", STEEL, 0.42 * radius, 2), eye),
    ]


def _pins(name: str, shape: Shape, radius: float, z: float, feet: tuple[float, float]) -> list[tuple[TubeSpec, Path]]:
    """Return the posts, upright at both ends, down to where the bodies are; on ground with a foot."""

    def upright(end: int, low: float, high: float) -> Path:
        return lambda a, b: np.array([[*(a, b)[end][:2], low], [*(a, b)[end][:2], high]])

    out = []
    for end, (body, foot) in enumerate(zip(shape.bodies, feet, strict=True)):
        pin = _tube(f"{name} pin {end + 1}", STEEL, radius, 2)
        out.append((pin, upright(end, foot, z + 1.6 * radius)))
        if body == "ground":
            disc = _tube(f"{name} foot {end + 1}", BLACK, FOOT * radius, 2)
            out.append((disc, upright(end, foot, foot + 0.9 * radius)))
    return out


def _tube(name: str, surface: SurfaceSpec, radius: float, points: int) -> TubeSpec:
    return TubeSpec(name=name, surface=surface, radius=radius, points=points)


def placed(pose: tuple[float, float, float], marker: tuple[float, float, float]) -> tuple[float, float]:
    """Return where a marker (x, y, angle) of a body is, whose frame is at ``pose`` (m)."""
    x, y, theta = pose
    return (
        x + math.cos(theta) * marker[0] - math.sin(theta) * marker[1],
        y + math.sin(theta) * marker[0] + math.cos(theta) * marker[1],
    )
