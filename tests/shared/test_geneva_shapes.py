"""Wheel and locking disc of a Geneva drive: near each other where they lock, never in each other's way."""

from __future__ import annotations

import math

import manifold3d
import numpy as np
import pytest

from mechanisms.stages.clearance.pieces import MeshPiece
from shared.shapes.cams import Geneva

THICK = 7.0


def _mesh(shape) -> manifold3d.Manifold:
    points, triangles = shape.val().tessellate(0.02, 0.05)
    corners = np.array([point.toTuple() for point in points]).round(5)
    return MeshPiece("a", "piece", corners[np.array(triangles)]).manifold


def _wheel_angle(shape: Geneva, crank: float) -> float:
    """Return the angle of the slot that holds the pin, or of the wheel at rest before or after it."""
    half = math.pi / 2 - math.pi / shape.slots
    inside = min(max(crank, -half), half)
    x, y = shape.radius * math.cos(inside) - shape.distance, shape.radius * math.sin(inside)
    return math.atan2(y, x)


@pytest.mark.parametrize(("slots", "distance"), [(3, 187.0), (4, 100.0), (5, 80.0), (6, 105.0), (9, 240.0)])
def test_wheel_passes_the_locking_disc_without_touching_it(slots: int, distance: float) -> None:
    shape = Geneva(slots, distance, distance * math.sin(math.pi / slots), slot=13.2, wall=4.0, gap=0.3)
    wheel, disc = (_mesh(solid) for solid in (shape.wheel(THICK), shape.locking_disc(THICK, 10.2)))
    half = math.pi / 2 - math.pi / slots
    gaps = {}
    for crank in np.concatenate([np.linspace(-half, half, 41), np.linspace(half, 2 * math.pi - half, 9)]):
        turned = disc.rotate((0.0, 0.0, math.degrees(crank)))
        seen = wheel.rotate((0.0, 0.0, math.degrees(_wheel_angle(shape, (crank + math.pi) % (2 * math.pi) - math.pi))))
        gaps[float(crank)] = turned.min_gap(seen.translate((distance, 0.0, 0.0)), 2.0)
    assert min(gaps.values()) > 0.13
    rest = [gap for crank, gap in gaps.items() if half < crank < 2 * math.pi - half]
    assert 0.2 < min(rest) <= max(rest) < 0.33  # it locks


@pytest.mark.parametrize(("slots", "distance"), [(3, 187.0), (4, 100.0), (6, 105.0)])
def test_slots_hold_the_pin_from_rim_to_bottom(slots: int, distance: float) -> None:
    shape = Geneva(slots, distance, distance * math.sin(math.pi / slots), slot=13.2, wall=4.0, gap=0.3)
    wheel = _mesh(shape.wheel(THICK))
    roller = manifold3d.Manifold.cylinder(THICK, 6.5, circular_segments=256)
    half = math.pi / 2 - math.pi / slots
    for crank in np.linspace(-half, half, 15):
        x, y = shape.radius * math.cos(crank) - distance, shape.radius * math.sin(crank)
        seen = wheel.rotate((0.0, 0.0, math.degrees(math.atan2(y, x))))
        gap = seen.min_gap(roller.translate((x, y, 0.0)), 1.0)
        assert 0.08 < gap < 0.11
