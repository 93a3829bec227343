"""Random mechanisms of shafts, gears, belts, racks, cams, Genevas, relations of users and dyads."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from mbsd import Body, Mechanism, constant_rate, harmonic
from mbsd.cams import Lift, oscillating_flat_cam, oscillating_roller_cam

LIFT = Lift.of(
    (2.1, math.radians(16), "modified_sine"), (0.6, math.radians(16)), (2.1, 0.0, "cycloidal"), (2 * math.pi - 4.8, 0.0)
)


class RandomMachine:
    """Adds parts to shafts that turn in ground; each part brings a new shaft where it can."""

    def __init__(self, seed: int, scale: float = 1.0) -> None:
        self.random = np.random.default_rng(seed)
        self.m = Mechanism("machine")
        self.scale, self.turn = scale, float(self.random.uniform(-math.pi, math.pi))
        self.shift = self.random.uniform(-1.0, 1.0, 2)
        self.count = 0
        self.shafts: list[tuple[Body, float, float]] = []
        shaft = self.shaft(0.0, 0.0)
        rate = float(self.random.choice([1.0, -2.0, 6.0]))
        steady = self.random.uniform() < 0.7
        start = float(self.random.uniform(-3.0, 3.0))
        self.m.drive_angle("motor", shaft, constant_rate(rate, start) if steady else harmonic(1.5, rate, start))
        self.m.start_near(**{shaft.name: math.degrees(start)})

    def on_ground(self, x: float, y: float, angle: float = 0.0):
        """A point of ground in the axes of the machine."""
        c, s = math.cos(self.turn), math.sin(self.turn)
        x, y = x * self.scale, y * self.scale
        return self.m.ground.at(self.shift[0] + c * x - s * y, self.shift[1] + s * x + c * y, self.turn + angle)

    def body(self, angle: float = 0.0) -> Body:
        """A new one, begun near an angle (rad) in the axes of the machine."""
        self.count += 1
        made = self.m.body(f"b{self.count}")
        self.m.start_near(**{made.name: math.degrees(self.turn + angle)})
        return made

    def shaft(self, x: float, y: float, angle: float = 0.0) -> Body:
        """A body pinned to ground."""
        made = self.body(angle)
        self.m.revolute(f"pin {made.name}", self.on_ground(x, y), made.origin)
        self.shafts.append((made, x, y))
        return made

    def some(self) -> tuple[Body, float, float]:
        """One of the shafts so far."""
        return self.shafts[int(self.random.integers(len(self.shafts)))]

    def next_shaft(self, distance: float) -> tuple[Body, Body]:
        """A shaft and a new one at a distance."""
        old, x, y = self.some()
        way = self.random.uniform(0.0, 2 * math.pi)
        return old, self.shaft(x + distance * math.cos(way), y + distance * math.sin(way))

    def gear(self) -> None:
        """Gears, one perhaps far smaller than the other."""
        first, second = self.random.uniform(0.05, 0.5, 2)
        old, new = self.next_shaft(float(first + second))
        radii = {"radius_i": first * self.scale, "radius_j": second * self.scale}
        self.m.gear_pair(f"gear {new.name}", old.origin, new.origin, **radii)

    def belt(self) -> None:
        """Open or crossed."""
        old, new = self.next_shaft(1.5)
        first, second = self.random.uniform(0.1, 0.6, 2) * self.scale
        crossed = bool(self.random.integers(2))
        self.m.belt(f"belt {new.name}", old.origin, new.origin, radius_i=first, radius_j=second, crossed=crossed)

    def planet(self) -> None:
        """A planet on a shaft, rolling on a wheel of ground."""
        arm, x, y = self.some()
        reach, radius = self.random.uniform(0.4, 0.6), self.random.uniform(0.1, 0.3)
        wheel = self.body()
        self.m.revolute(f"pin {wheel.name}", arm.at(reach * self.scale, 0.0), wheel.origin)
        own, rolling = (reach - radius) * self.scale, radius * self.scale
        self.m.gear_pair(f"gear {wheel.name}", self.on_ground(x, y), wheel.origin, radius_i=own, radius_j=rolling)

    def differential(self) -> None:
        """A shaft as sun, a ring of ground, a carrier and one planet."""
        sun, x, y = self.some()
        own, planet = self.random.uniform(0.1, 0.3, 2)
        carrier, wheel = self.shaft(x, y), self.body()
        self.m.revolute(f"pin {wheel.name}", carrier.at((own + planet) * self.scale, 0.0), wheel.origin)
        radii = {"radius_i": own * self.scale, "radius_j": planet * self.scale}
        self.m.gear_pair(f"sun {wheel.name}", sun.origin, wheel.origin, **radii)
        radii = {"radius_i": (own + 2 * planet) * self.scale, "radius_j": planet * self.scale}
        self.m.gear_pair(f"ring {wheel.name}", self.on_ground(x, y), wheel.origin, internal=True, **radii)

    def cam(self) -> None:
        """A flat or a roller follower that swings."""
        cam, x, y = self.some()
        base, roller, pivot = 0.3, 0.12, 1.0
        flat = bool(self.random.integers(2))
        rest = math.asin(base / pivot) if flat else 2 * math.asin((base + roller) / (2 * pivot))
        arm = self.shaft(x + pivot, y, math.pi - rest)
        size = self.scale
        if flat:
            profile = oscillating_flat_cam(LIFT, base * size, pivot * size)
            self.m.cam_flat(f"cam {arm.name}", cam.origin, arm.at(0.0, 0.0, math.pi), profile)
        else:
            profile = oscillating_roller_cam(LIFT, base * size, roller * size, pivot * size, pivot * size)
            self.m.cam_roller(f"cam {arm.name}", cam.origin, arm.at(pivot * size, 0.0), profile)

    def geneva(self) -> None:
        """Three to six slots."""
        slots = int(self.random.integers(3, 7))
        crank, x, y = self.some()
        wheel = self.shaft(x + 1.0, y, math.pi / slots)
        self.m.geneva(f"geneva {wheel.name}", crank.origin, wheel.origin, slots, self.scale * math.sin(math.pi / slots))

    def rack(self) -> None:
        """A rack that a shaft drives, and a pinion that it drives in turn."""
        pinion, x, y = self.some()
        radius = float(self.random.uniform(0.1, 0.4))
        rack = self.body()
        self.m.prismatic(f"guide {rack.name}", self.on_ground(x, y - radius), rack.origin)
        self.m.rack_and_pinion(f"rack {rack.name}", rack.origin, pinion.origin, radius=radius * self.scale)
        other = self.shaft(x + 0.8, y)
        self.m.rack_and_pinion(f"rack {other.name}", rack.origin, other.origin, radius=radius * self.scale)

    def law(self) -> None:
        """A shaft whose angle is a function of another's, by a user's relation."""
        old, x, y = self.some()
        new = self.shaft(x, y)
        part = float(self.random.uniform(0.1, 0.6))
        self.m.constraint(f"law {new.name}", old.origin, new.origin, lambda x, y, a: a + part * np.sin(a) - 0.3)

    def dyad(self) -> None:
        """Two bars from a point of a shaft to ground."""
        shaft, x, y = self.some()
        way = self.random.uniform(0.0, 2 * math.pi)
        gap, crank, size = float(self.random.uniform(0.9, 1.1)), float(self.random.uniform(0.1, 0.25)), self.scale
        first, second = (self.body(float(self.random.uniform(-3.0, 3.0))) for _ in range(2))
        near, far = self.random.uniform(0.7, 0.9, 2) * size
        self.m.revolute(f"A {first.name}", shaft.at(crank * size, 0.0), first.origin)
        self.m.revolute(f"B {first.name}", first.at(near, 0.0), second.at(far, 0.0))
        px, py = x + gap * math.cos(way), y + gap * math.sin(way)
        self.m.revolute(f"C {first.name}", self.on_ground(px, py), second.origin)
        self.shafts.append((second, px, py))

    KINDS: dict[str, Callable[[RandomMachine], None]] = {
        "gear": gear, "belt": belt, "planet": planet, "differential": differential, "cam": cam, "geneva": geneva,
        "rack": rack, "law": law, "dyad": dyad,
    }  # fmt: skip
