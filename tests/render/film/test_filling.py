"""How a picture is filled: what stands around is whole, or cut on purpose, never by a sliver."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from render.film.composing import View, area, cut_share, held
from render.film.framing import CameraPose, project

SLIVER = 0.15


def slab(x: tuple[float, float], z: tuple[float, float], y: float = 0.0) -> np.ndarray:
    """Corners of an upright plate that faces the camera."""
    return np.array([[u, y + d, w] for u in x for w in z for d in (0.0, 0.01)])


def view(aspect: float, azimuth: float = -0.4) -> View:
    return View(azimuth, 0.17, 55.0, 0.06, (0.0, 0.0), aspect)


def seen_out(view: View, position: np.ndarray, thing: np.ndarray) -> float:
    """The same share, by points on the thing's hull as the film projects them."""
    pose = CameraPose(position=tuple(position), azimuth=view.azimuth, elevation=view.elevation, lens=view.lens,
                      focus=1.0, fstop=0.0)  # fmt: skip
    rng = np.random.default_rng(3)
    places = project(pose, thing, view.aspect, 1.0) / [view.aspect, 1.0]
    low, high = places.min(axis=0), places.max(axis=0)
    points = low + rng.random((40_000, 2)) * (high - low)
    from scipy.spatial import Delaunay

    inside = points[Delaunay(places).find_simplex(points) >= 0]
    return float(((inside < 0) | (inside > 1)).any(axis=1).mean())


@given(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), st.floats(0.02, 0.6), st.floats(0.02, 0.6), st.floats(0.6, 2.0))
@settings(max_examples=30, deadline=None)
def test_the_part_that_is_cut_is_that_of_points_on_it(x: float, z: float, wide: float, high: float, aspect: float):
    own, thing = view(aspect), slab((x, x + wide), (z, z + high))
    position = own.stand(slab((-0.1, 0.1), (-0.1, 0.1)))[0]
    assert cut_share(own, position, thing) == pytest.approx(seen_out(own, position, thing), abs=0.02)


@given(
    st.floats(0.05, 0.4), st.floats(0.05, 0.4), st.floats(0.0, 0.5), st.floats(0.0, 0.5), st.floats(0.0, 0.5),
    st.floats(0.01, 0.4), st.sampled_from([16 / 9, 1.0, 4 / 5, 9 / 16]),
)  # fmt: skip
@settings(max_examples=60, deadline=None)
def test_plate_and_stand_are_whole_or_cut_on_purpose(
    wide: float, high: float, left: float, right: float, up: float, leg: float, aspect: float
):
    """Unless the plate is so large that the machine would be small beside it, and so shaped that each cut is one."""
    machine = slab((-wide / 2, wide / 2), (-high / 2, high / 2), -0.03)
    plate = slab((-wide / 2 - left, wide / 2 + right), (-high / 2 - 0.04, high / 2 + up))
    foot = slab((-wide / 3, wide / 3), (-high / 2 - 0.06 - leg, -high / 2 - 0.04 - leg), -0.05)
    own, around = view(aspect), np.concatenate([plate, foot])
    points = held(own, machine, around, np.zeros((0, 3)), things=[plate, foot])
    position = own.stand(points)[0]
    assert cut_share(own, position, machine) < 1e-6
    across, upward = own.filled(machine, position)
    assert max(across, upward) >= 0.75 * 0.81 - 0.01 or cut_share(own, position, around) < 1e-3
    plain = own.stand(held(own, machine, around, np.zeros((0, 3))))[0]
    worst, before = (max(_near(own, at, thing) for thing in (plate, foot)) for at in (position, plain))
    assert worst <= before + 1e-6


def _near(own: View, position: np.ndarray, thing: np.ndarray) -> float:
    share = cut_share(own, position, thing, 0.98)
    return min(share, 0.17 - share) if 1e-3 < share < 0.17 else 0.0


@pytest.mark.parametrize("aspect", [16 / 9, 1.0, 9 / 16])
@pytest.mark.parametrize("beyond", [0.01, 0.03, 0.05, 0.08, 0.15, 0.4])
def test_a_plate_a_little_larger_than_the_picture_is_whole(beyond: float, aspect: float) -> None:
    machine = slab((-0.1, 0.1), (-0.1, 0.1), -0.03)
    plate = slab((-0.1 - beyond, 0.1 + beyond), (-0.1 - beyond, 0.1 + beyond))
    own = view(aspect)
    position = own.stand(held(own, machine, plate, np.zeros((0, 3)), things=[plate]))[0]
    share = cut_share(own, position, plate)
    assert share < 1e-3 or share > SLIVER


def test_areas_are_those_of_polygons() -> None:
    turn = np.linspace(0, 2 * math.pi, 400, endpoint=False)
    assert area(np.stack([np.cos(turn), np.sin(turn)], axis=1)) == pytest.approx(math.pi, rel=1e-3)
    assert area(np.array([[0.0, 0.0], [1.0, 1.0]])) == 0.0
