"""Plates of bodies with a slot and little else: a T within the outline that the order of layers is found with."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mechanisms.stages.automatic.body_shapes import ARM, PlacedEye, yoke_shape
from shared.shapes import outline
from shared.shapes.build import extruded
from shared.shapes.link import Eye

WALL, EYE = Eye(13.5, 0.0), Eye(13.0, 8.0)


def placed(points: list[tuple[float, float, Eye]], turn: float, x: float, y: float) -> list[PlacedEye]:
    c, s = math.cos(turn), math.sin(turn)
    return [(x + c * u - s * v, y + s * u + c * v, eye) for u, v, eye in points]


def slot_along_y(half: float, *others: tuple[float, float, Eye]) -> list[tuple[float, float, Eye]]:
    return [(0.0, -half, WALL), (0.0, half, WALL), *others]


@pytest.mark.parametrize(
    ("half", "others", "turn"),
    [
        (33.0, [(102.0, 0.0, EYE), (122.0, 0.0, EYE)], 0.0),
        (33.0, [(-80.0, 7.0, EYE)], 2.1),
        (21.0, [(60.0, -10.0, Eye(12.5, 8.0, above=3.0))], -0.7),
    ],
)
def test_it_is_one_lighter_piece_within_the_plate_round_all_its_eyes(
    half: float, others: list[tuple[float, float, Eye]], turn: float
):
    eyes = placed(slot_along_y(half, *others), turn, 5.0, -9.0)
    shape = yoke_shape(eyes, [eye[:2] for eye in eyes[:2]], 7.0)
    assert shape is not None
    [solid] = shape.solids().vals()
    assert solid.isValid()
    corners = [(x, y, eye.radius) for x, y, eye in eyes[:3]]
    middle = np.mean([corner[:2] for corner in corners], axis=0)
    corners.sort(key=lambda corner: math.atan2(corner[1] - middle[1], corner[0] - middle[0]))
    hull = extruded(outline.hull(corners), 12.0, -1.0)
    if len(others) == 2:
        hull = hull.union(extruded(outline.hull([(x, y, eye.radius) for x, y, eye in eyes[2:]]), 12.0, -1.0))
    outside = shape.cut(hull)
    assert sum(piece.Volume() for piece in outside.solids().vals()) < 1e-6 * solid.Volume()
    plate = 7.0 * extruded(outline.hull(corners), 1.0).val().Volume()
    assert solid.Volume() < 0.85 * plate
    box = [extruded(outline.circle(x, y, 0.9 * eye.radius), 5.0, 1.0) for x, y, eye in eyes if not eye.bore]
    for disc in box:  # the wall round the slot's ends is whole
        assert sum(piece.Volume() for piece in disc.cut(shape).solids().vals()) < 1e-6


@pytest.mark.parametrize(
    "others",
    [
        [],
        [(20.0, 0.0, EYE)],  # too near for an arm
        [(90.0, 30.0, EYE)],  # past the slot's end
        [(90.0, 0.0, EYE), (90.0, 20.0, EYE), (120.0, 0.0, EYE)],
        [(0.0, 80.0, EYE)],  # in line with the slot: a lever
        [(90.0, 0.0, EYE), (-90.0, 0.0, EYE)],  # on both sides
    ],
)
def test_where_a_t_is_no_better_a_plate_is_made(others: list[tuple[float, float, Eye]]):
    eyes = placed(slot_along_y(33.0, *others), 0.4, 0.0, 0.0)
    assert yoke_shape(eyes, [eye[:2] for eye in eyes[:2]], 7.0) is None
    assert 0.5 < ARM < 1.0
