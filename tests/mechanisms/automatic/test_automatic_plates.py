"""Plates round odd sets of eyes, and what hunts for parts found once: each is built, or refused in words."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from mechanisms.stages.automatic.body_shapes import body_shape
from mechanisms.stages.automatic.layout.planar import FLAT, convex_hull
from mechanisms.stages.parts.meshes import check_mesh, only_solid
from mechanisms.stages.parts_files import read_mesh, stl_bytes
from shared.shapes.facets import volume_of
from shared.shapes.link import Eye
from tools.hunt.case import drawn
from tools.hunt_parts import case
from tools.hunt_parts.outcome import BUILT, REFUSED

BIG, SMALL = Eye(13.0, 11.0), Eye(9.0, 4.6)
BOSSED = Eye(12.5, 8.0, above=14.4, boss=9.2)


@pytest.mark.parametrize("length", [111.5, 116.0, 121.57835546275788])
def test_rounded_edges_of_a_bar_with_an_eye_beside_its_end_are_sound(length: float) -> None:
    """The kernel calls a shape valid whose fillets overlap: its mesh was open, or had another volume."""
    end = Eye(12.5, 8.02, boss=9.2)
    shape, holes = body_shape([(length / 5, 0.0, Eye(13.0, 11.02)), (0.0, 0.0, end), (length, 0.0, end)], 7.0)
    solid = only_solid(shape, "beam")
    check_mesh(read_mesh(stl_bytes(solid)), volume_of(solid), holes, "beam")


@pytest.mark.parametrize(
    "eyes",
    [
        [(0.0, 0.0, BIG), (71.0, 0.0, BIG), (60.0, 3.3, Eye(4.0, 0.0)), (71.0, 3.0, Eye(9.0, 0.0))],
        [(0.0, 0.0, BIG), (3.0, 1.0, Eye(9.0, 0.0))],
        [(0.0, 0.0, BIG), (2.0, 0.0, Eye(9.0, 0.0)), (0.0, 2.0, Eye(8.0, 0.0))],
        [(0.0, 0.0, BOSSED), (680.0, 0.0, BIG), (490.0, 72.8, BOSSED)],
    ],
    ids=["an eye within another", "two, one within the other", "all within one", "a thin triangle"],
)
def test_one_sound_piece(eyes: list[tuple[float, float, Eye]]) -> None:
    shape, holes = body_shape(eyes, 7.0)
    (solid,) = shape.solids().vals()
    assert solid.isValid()
    assert holes >= sum(eye.bore > 0 for _, _, eye in eyes)
    box = solid.BoundingBox()
    assert box.xmax >= max(x + eye.radius for x, _, eye in eyes) - 1e-6
    assert box.ymin <= min(y - eye.radius for _, y, eye in eyes) + 1e-6


@given(
    count=st.integers(3, 400),
    waves=st.integers(1, 12),
    height=st.floats(0.0, 300.0),
    length=st.floats(20.0, 5000.0),
)
def test_a_plainer_hull_keeps_all_points(count: int, waves: int, height: float, length: float) -> None:
    """Wavy slots of any length: none is left out by more than FLAT."""
    x = np.linspace(0.0, length, count)
    points = np.stack([x, height * np.sin(waves * x * math.pi / length + 0.3)], axis=1)
    hull = convex_hull(points, 1e-4)
    following = np.roll(hull, -1, axis=0) - hull
    normal = np.stack([following[:, 1], -following[:, 0]], axis=1) / np.hypot(*following.T)[:, None]
    outside = ((points[:, None] - hull[None]) * normal).sum(axis=2).max(axis=1)
    assert outside.max() <= FLAT + 1e-6


@pytest.mark.parametrize(
    ("seed", "family", "state", "words"),
    [
        (7000421, "closed linkage, free", REFUSED, "their bores of"),  # a spring's stud beside a pivot
        (7000721, "Geneva wheel", BUILT, ""),  # a Geneva whose crank never comes near its wheel
        (
            7000805,
            "inverted slider-crank, quick return",
            BUILT,
            "",
        ),  # a rail whose end would be in a bushing of its own body
        (7000891, "linkage, cranks swing", BUILT, ""),  # a spring's post beside a link of the lowest layer
    ],
)
def test_what_hunts_found(seed: int, family: str, state: str, words: str) -> None:
    outcome = case.outcome_of(drawn(seed, family, skipped=2)[1])
    assert outcome.state == state, outcome
    assert words in outcome.detail
