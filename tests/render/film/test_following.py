"""What goes away is followed by a damped camera; what stays where it is, swings or comes back is not."""

from __future__ import annotations

from pathlib import Path

import msgspec
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from render.film import composing
from render.film.film import Film
from render.film.framing import project
from shared.contract import Mount, mounted, read_motion, read_parts
from shared.contract.shot import Camera, Shot
from tools.fixtures import film_fixture

TIME = np.linspace(0.0, 1.0, 61)
BOX = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.05, 0.05) for z in (0.0, 0.02)])


def along(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """A box whose middle is at these places (T,)."""
    return BOX + np.stack([x, y, 0 * x], axis=1)[:, None]


def test_what_travels_and_what_does_not():
    still = 0 * TIME
    car, slow = along(3 * TIME, still), along(0.1 * TIME, still)
    thrown = along(2 * TIME, 4 * TIME * (1 - TIME))
    round_trip = along(np.sin(np.pi * TIME) * 2, still)
    orbiting = along(np.cos(2 * np.pi * TIME), np.sin(2 * np.pi * TIME))
    swinging = np.concatenate([along(2 * TIME, still), along(still, still)], axis=1)  # its pivot stays
    assert composing.travels(car, False)
    assert composing.travels(thrown, False)
    for places in (slow, round_trip, orbiting, swinging):
        assert not composing.travels(places, False)
    assert not composing.travels(car, True)


@given(st.integers(0, 10**6), st.floats(1.0, 20.0))
def test_the_way_is_smooth_stays_within_what_it_follows_and_closes_where_the_film_does(seed: int, width: float):
    values = np.random.default_rng(seed).normal(size=(80, 3)).cumsum(axis=0)
    held, closed = (composing.damped(values, width, repeats) for repeats in (False, True))
    for way in (held, closed):
        assert (way >= values.min(axis=0) - 1e-12).all()
        assert (way <= values.max(axis=0) + 1e-12).all()
    turned = composing.damped(np.roll(values, 17, axis=0), width, True)
    assert turned == pytest.approx(np.roll(closed, 17, axis=0))
    steps = np.abs(np.diff(values, axis=0)).max()
    assert np.abs(np.diff(held, axis=0)).max() <= steps + 1e-12
    even = np.outer(np.arange(200.0), [1.0, 2.0, 3.0])  # what goes evenly is followed without a lag
    assert composing.damped(even, width, False)[90:110] == pytest.approx(even[90:110])


def travelling(out_root: Path, mount: Mount, follow: bool | None = None) -> Film:
    """The four-bar carried along by three metres, seen in its plane."""
    shot = Shot(camera=Camera(follow=follow), seconds_per_turn=2.0, hold=0.5, fps=20)
    out = film_fixture.write(shot, mount=mount)
    motion = msgspec.structs.replace(read_motion(out.motion), period=None)
    time = np.asarray(motion.time)
    for body in (*motion.bodies.values(), *motion.points.values()):
        body.x = (np.asarray(body.x) + 3.0 * time).tolist()
        body.vx = (np.asarray(body.vx) + 3.0).tolist()
    return Film(motion, read_parts(out.parts), shot, out.parts_folder, 4 / 5)


@pytest.mark.parametrize("mount", [mounted((0.0, 0.0)), mounted((0.0, -9.81)), mounted((3.0, 4.0), "wall")])
def test_a_machine_that_goes_away_is_always_in_the_frame_large_and_steady(out_root: Path, mount: Mount):
    film, still = travelling(out_root, mount), travelling(out_root, mount, follow=False)
    frames = range(film.clock.frames)
    seen = []
    for frame in frames:
        at = film.clock.moment(frame)
        points = film.space.places(np.array([at.time]))[0]
        seen.append(project(film.camera(frame), points, 4, 5) / [4, 5])
    parts = np.concatenate(seen)
    assert parts.min() >= 0.09 - 2e-3
    assert parts.max() <= 0.91 + 2e-3
    assert np.ptp(parts, axis=0).max() >= 0.8
    way = np.array([film.camera(frame).position for frame in frames])
    assert np.linalg.norm(way[-1] - way[0]) > 2.0
    jerk = np.abs(np.diff(way, n=3, axis=0)).max()
    assert jerk < 1e-3 * np.ptp(way, axis=0).max()
    steps = np.linalg.norm(np.diff(way[film.clock.moving :], axis=0), axis=1)
    assert (np.diff(steps) <= 1e-12).all()  # it comes to rest while the motion is held
    assert len({film.camera(frame).azimuth for frame in frames}) == 1
    assert len({still.camera(frame) for frame in frames}) == 1
    assert film.size < still.size / 3
    again = travelling(out_root, mount)
    assert [again.camera(frame) for frame in frames] == [film.camera(frame) for frame in frames]
