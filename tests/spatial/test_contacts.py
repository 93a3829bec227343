"""Forces by functions in space: bushings, contacts by penalty, height fields, tyres, and functions of the user."""

from __future__ import annotations

import math
from typing import Any

import numba
import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from mbsd.base.errors import ModelError
from mbsd.spatial import Body, Mechanism, constant_rate, polynomial

G = 9.81


def two_bodies() -> tuple[Mechanism, Body, Body]:
    """Return two free bodies that tumble without weight."""
    m = Mechanism("pair", gravity=None)
    first = m.body("first", 1.0, com=(0.1, 0, 0), inertia=(0.3, 0.4, 0.5), orientation=(0.9, 0.1, -0.2, 0.3))
    second = m.body("second", 2.0, com=(0.4, 0.3, 0.2), inertia=(0.5, 0.4, 0.3), at=(0.1, 0.2, 0.3))
    m.start_moving({"first": (0.3, 0.2, -0.4), "second": (0.1, -0.5, 0.3)})
    return m, first, second


def test_a_bushing_pushes_by_place_and_rotation_vector() -> None:
    """Against numpy and scipy: s = K (d, phi), and the same energy; momentum and energy stay."""
    m, first, second = two_bodies()
    random = np.random.default_rng(4)
    factor = random.standard_normal((6, 6))
    stiffness = factor @ factor.T + np.eye(6)
    m.bushing("bush", first, second, stiffness=stiffness, at=(0.2, 0.1, 0.1), axis=(1, 2, -1))
    sol = m.simulate(duration=6.0, steps=60, tolerance=1e-11)
    force = m.forces["bush"]
    i, j, view = sol.place(force.i), sol.place(force.j), sol.force("bush")
    turned = Rotation.from_matrix(np.swapaxes(i.rotation, 1, 2) @ j.rotation).as_rotvec()
    moved = np.einsum("tji,tj->ti", i.rotation, j.place - i.place)
    x = np.hstack([moved, turned])
    assert np.abs(turned).max() > 0.2
    pushed = -np.einsum("tij,tj->ti", i.rotation, (x @ stiffness)[:, :3])
    assert np.allclose(view.force, pushed, rtol=0, atol=1e-9)
    assert np.allclose(view.energy, 0.5 * np.einsum("ti,ij,tj->t", x, stiffness, x), rtol=0, atol=1e-10)
    assert np.ptp(sol.energy.total) < 1e-8 * sol.energy.total[0]
    places = [sol.place(body.marker(body.com)) for body in (first, second)]
    momentum = np.sum([b.mass * p.velocity for b, p in zip((first, second), places, strict=True)], axis=0)
    assert np.allclose(momentum, momentum[0], rtol=0, atol=1e-10)
    spin = np.zeros_like(momentum)
    for body, place in zip((first, second), places, strict=True):
        frame = sol.body(body.name)
        inertia = frame.rotation @ np.array(body.inertia) @ np.swapaxes(frame.rotation, 1, 2)
        spin += body.mass * np.cross(place.place, place.velocity) + np.einsum("tij,tj->ti", inertia, frame.w)
    assert np.allclose(spin, spin[0], rtol=0, atol=1e-9)


def test_damping_of_a_bushing_takes_what_energy_is_lost() -> None:
    m, first, second = two_bodies()
    m.bushing(
        "bush", first, second, [30, 40, 50, 3, 4, 5], [0.3, 0.4, 0.5, 0.2, 0.1, 0.3], at=(0.2, 0.1, 0.1), axis=(0, 1, 1)
    )
    sol = m.simulate(duration=2.0, steps=2000, tolerance=1e-10)
    power = sol.force("bush").power
    stored = np.gradient(sol.force("bush").energy, sol.t)
    assert (power + stored)[2:-2].max() < 1e-4
    assert np.allclose(np.gradient(sol.energy.kinetic, sol.t)[2:-2], power[2:-2], rtol=0, atol=1e-3)


def drop(height: float, **more: Any) -> Mechanism:
    """Return a ball of .1 m and 1 kg that falls from ``height`` onto a plane through the origin, normal (1, 2, 2)."""
    normal = np.array([1.0, 2.0, 2.0]) / 3.0
    m = Mechanism("drop", gravity=-G * normal)
    ball = m.ball("ball", (0.1 + height) * normal, radius=0.1, mass=1.0)
    m.contact("floor", m.ground, ball, at=(0, 0, 0), normal=normal, centre=(0.1 + height) * normal, radius=0.1, **more)
    m.trace("middle", ball, at=(0.1 + height) * normal)
    return m


def test_a_ball_bounces_as_high_as_it_fell_and_as_deep_as_energy_says() -> None:
    m = drop(0.5, stiffness=1e6)
    fall = math.sqrt(2 * 0.5 / G)
    sol = m.simulate(duration=3 * fall, steps=3000, tolerance=1e-10)
    height = sol.point("middle").place @ [1, 2, 2] / 3.0 - 0.1
    assert np.ptp(sol.energy.total) < 1e-6
    assert height[-1000:].max() == pytest.approx(0.5, abs=1e-6)
    fine = m.simulate(times=[0.0, *np.linspace(fall - 1e-3, fall + 8e-3, 4001)], tolerance=1e-10)
    depth = -(fine.point("middle").place @ [1, 2, 2] / 3.0 - 0.1).min()
    assert 1e6 * depth**2.5 / 2.5 == pytest.approx(G * (0.5 + depth), rel=1e-5)


def test_hunt_and_crossleys_damping_gives_back_their_speed() -> None:
    """w(v) = v / c - ln(1 + c v) / c^2 of the speeds before and after, without weight."""
    m = drop(0.01, stiffness=1e6, damping=0.2)
    m.gravity = None
    push = m.bodies["ball"].marker((0, 0, 0))
    m.event(
        "push",
        lambda t, moment: t - 1e-6,
        action=lambda moment: moment.set_velocity("ball", -push.axes @ [1, 2, 2], (0, 0, 0)),
    )
    sol = m.simulate(duration=0.05, steps=10, tolerance=1e-11)
    after = sol.body("ball").velocity[-1] @ [1, 2, 2] / 3.0

    def w(v: float) -> float:
        return v / 0.2 - math.log(1 + 0.2 * v) / 0.04

    assert after > 0.0
    assert w(3.0) == pytest.approx(w(-after), rel=1e-6)


@pytest.mark.parametrize(("friction", "wanted"), [(0.5, 2.961346534054473), (0.05, None)])
def test_a_ball_rolls_or_slides_down_an_incline(friction: float, wanted: float | None) -> None:
    """Closed form: 5/7 g sin 25 degrees where it rolls; else g (sin - mu cos)."""
    tilt = math.radians(25)
    normal, down = np.array([math.sin(tilt), 0, math.cos(tilt)]), np.array([math.cos(tilt), 0, -math.sin(tilt)])
    m = Mechanism("incline", gravity=(0, 0, -G))
    sunk = (1.0 * G * math.cos(tilt) / 1e8) ** (1 / 1.5)
    ball = m.ball("ball", (0.1 - sunk) * normal, radius=0.1, mass=1.0)
    m.contact(
        "slope",
        m.ground,
        ball,
        at=(0, 0, 0),
        normal=normal,
        centre=(0.1 - sunk) * normal,
        radius=0.1,
        stiffness=1e8,
        friction=friction,
        slip_speed=1e-4,
    )
    sol = m.simulate(duration=1.0, steps=100, tolerance=1e-9)
    speed = sol.body("ball").velocity @ down
    rate = (speed[-1] - speed[50]) / 0.5
    wanted = G * (math.sin(tilt) - friction * math.cos(tilt)) if wanted is None else wanted
    assert rate == pytest.approx(wanted, rel=5e-4 if friction == 0.5 else 1e-6)


def test_a_tilted_disc_touches_at_its_lowest_point() -> None:
    """Depth and place of the force by numpy, of discs and rings of any lean."""
    random = np.random.default_rng(2)
    for tube in (0.0, 0.05):
        axis = random.standard_normal(3)
        axis /= np.linalg.norm(axis)
        m = Mechanism("disc", gravity=None)
        disc = m.disc("disc", (0.3, 0.1, 0.2), axis, radius=0.4, mass=1.0, thickness=0.1)
        m.contact(
            "floor",
            m.ground,
            disc,
            at=(0, 0, 0),
            normal=(0, 0, 1),
            centre=(0.3, 0.1, 0.2),
            axis=axis,
            ring=0.4,
            radius=tube,
            stiffness=10.0,
            exponent=1.0,
        )
        view = m.simulate(times=[0.0, 1e-6]).force("floor")
        turns = np.linspace(0, 2 * math.pi, 200_001)
        across = np.linalg.svd(axis[None])[2][1:]
        rim = np.array([0.3, 0.1, 0.2]) + 0.4 * (
            np.cos(turns)[:, None] * across[0] + np.sin(turns)[:, None] * across[1]
        )
        lowest = rim[np.argmin(rim[:, 2])]
        depth = tube - lowest[2]
        assert depth > 0
        assert view.force[0] == pytest.approx([0, 0, 10.0 * depth], abs=1e-8)
        arm = lowest - [0.3, 0.1, 0.2]
        assert view.moment[0] == pytest.approx(np.cross(arm, view.force[0]), abs=1e-4)


def test_a_ball_on_a_height_field_is_as_deep_as_its_nearest_point_says() -> None:
    """Against scipy: cubic Hermite pieces with central slopes, and the nearest point by minimising."""
    x, y = np.linspace(-1, 1, 9), np.linspace(-0.5, 0.7, 7)
    heights = 0.05 * np.cos(3 * x)[None, :] + 0.04 * np.sin(4 * y)[:, None]

    def interpolate(grid: np.ndarray, values: np.ndarray, at: float) -> np.ndarray:
        padded = np.concatenate([values[:1], values, values[-1:]])
        return CubicHermiteSpline(grid, values, (padded[2:] - padded[:-2]) / (2 * (grid[1] - grid[0])))(at)

    def height(px: float, py: float) -> float:
        return float(interpolate(y, interpolate(x, heights.T, px), py))

    for px, py in ((0.13, 0.21), (-0.41, 0.02), (0.6, 0.5)):
        centre = np.array([px, py, height(px, py) + 0.08])
        m = Mechanism("terrain", gravity=None)
        ball = m.ball("ball", centre, radius=0.1, mass=1.0)
        m.contact(
            "ground",
            m.ground,
            ball,
            at=(0, 0, 0),
            normal=(0, 0, 1),
            centre=centre,
            radius=0.1,
            stiffness=100.0,
            exponent=1.0,
            heights=(x, y, heights),
        )
        force = m.simulate(times=[0.0, 1e-6]).force("ground").force[0]
        axes = m.forces["ground"].i.axes
        foot = minimize(
            lambda p, axes=axes, centre=centre: np.sum((axes @ [p[0], p[1], height(*p)] - centre) ** 2),
            (axes.T @ centre)[:2],
            method="Nelder-Mead",
            options={"xatol": 1e-10, "fatol": 1e-16},
        ).x
        way = centre - axes @ [*foot, height(*foot)]
        far = np.linalg.norm(way)
        assert force == pytest.approx(100.0 * (0.1 - far) * way / far, abs=1e-5)


def test_a_ball_rocks_in_a_dish_without_losing_energy() -> None:
    x = np.linspace(-1, 1, 21)
    dish = 0.3 * (x[None, :] ** 2 + 0.5 * x[:, None] ** 2)
    m = Mechanism("dish", gravity=(0, 0, -G))
    ball = m.ball("ball", (0.4, 0.2, 0.3), radius=0.1, mass=1.0)
    m.contact(
        "dish",
        m.ground,
        ball,
        at=(0, 0, 0),
        normal=(0, 0, 1),
        centre=(0.4, 0.2, 0.3),
        radius=0.1,
        stiffness=1e4,
        heights=(x, x, dish),
    )
    sol = m.simulate(duration=2.0, steps=50, tolerance=1e-9)
    assert np.ptp(sol.energy.total) < 1e-4
    assert sol.body("ball").x.min() < -0.2


@pytest.mark.parametrize(("slip", "angle"), [(0.05, 0.0), (-0.02, 4.0), (0.0, -6.0)])
def test_a_tyre_pulls_by_the_magic_formula(slip: float, angle: float) -> None:
    """A wheel that is led along x at 10 m/s, steered by an angle, and turned at a rate of its own."""
    load, radius, speed = 2000.0, 0.3, 10.0
    turned = math.radians(angle)
    axis = np.array([-math.sin(turned), math.cos(turned), 0.0])  # forward: axis x normal
    forward = np.cross(axis, [0, 0, 1.0])
    along, across = speed * forward[0], speed * np.cross([0, 0, 1.0], forward)[0]
    m = Mechanism("tyre", gravity=None)
    depth = load / 2e5
    hub = (0, 0, radius - depth)
    fork = m.body("fork", 1.0, com=hub, inertia=(1, 1, 1))
    wheel = m.disc("wheel", hub, axis, radius=radius, mass=10.0, thickness=0.1)
    m.prismatic("rail", m.ground, fork, at=hub, axis=(1, 0, 0))
    m.revolute("axle", fork, wheel, at=hub, axis=axis)
    m.drive_slide("pull", "rail", polynomial(0.0, speed))
    m.drive_turn("motor", "axle", constant_rate((1 + slip) * along / (radius - depth)))
    m.tyre(
        "tyre",
        m.ground,
        wheel,
        radius,
        2e5,
        at=(0, 0, 0),
        normal=(0, 0, 1),
        centre=hub,
        axis=axis,
        side_slope=8.0,
        grip=0.9,
    )
    force = m.sweep(times=[0.0, 0.1]).force("tyre").force[0]
    size = math.hypot(along, 0.1)
    sx, sy = 10.0 * slip * along / size, 8.0 * across / size
    s = math.hypot(sx, sy)
    bent = s - 0.97 * (s - math.atan(s))
    pull = load * 0.9 * math.sin(1.65 * math.atan(bent))
    wanted = pull * (sx * forward - sy * np.cross([0, 0, 1.0], forward)) / s
    assert force == pytest.approx([wanted[0], wanted[1], load], rel=1e-9, abs=1e-6)


@pytest.mark.parametrize("compiled", [True, False])
def test_functions_of_the_user_push_frames(compiled: bool) -> None:
    """A spring to a place by a function is that of a spring between places."""

    def pull(t, q, v):
        return -30.0 * (q[0] - 1.0), -30.0 * q[1], -30.0 * q[2], 0.0, 0.0, 0.0

    ends = []
    for is_user in (True, False):
        m = Mechanism("pull", gravity=(0, 0, -G))
        body = m.body("body", 1.0, com=(0.1, 0, 0), inertia=(0.3, 0.4, 0.5), orientation=(0.9, 0.1, -0.2, 0.3))
        m.start_moving({"body": (1.0, 2.0, 0.5)})
        mark = body.marker((0.3, -0.2, 0.1))
        if is_user:
            m.user_force("pull", numba.njit(pull) if compiled else pull, mark)
        else:
            m.spring("pull", m.ground.marker((1, 0, 0)), mark, stiffness=30.0, length=0.0)
        sol = m.simulate(duration=1.0, steps=4, tolerance=1e-11)
        ends.append(sol.body("body").place)
    assert np.allclose(*ends, rtol=0, atol=1e-9)


def test_what_a_function_of_the_user_raises_is_said_with_its_time() -> None:
    m, _, second = two_bodies()

    def fails(t: float, q: np.ndarray, v: np.ndarray) -> tuple[float, ...]:
        if t > 0.2:
            raise KeyError("valve")
        return (0.0,) * 6

    m.user_force("valve", fails, second)
    with pytest.raises(ModelError, match=r"(?s)pair: force 'valve': at t = .*the user's function fails: KeyError"):
        m.simulate(duration=1.0)
    other, _, body = two_bodies()
    other.user_force("short", lambda t, q, v: (1.0, 2.0), body)
    with pytest.raises(ModelError, match="gives 2 numbers; 6 are wanted"):
        other.simulate(duration=1.0)


def test_forces_by_functions_that_cannot_be_are_refused() -> None:
    m, first, second = two_bodies()
    with pytest.raises(ModelError, match=r"stiffness has shape \(3,\); give six numbers"):
        m.bushing("b", first, second, (1, 2, 3), at=(0, 0, 0), axis=(0, 0, 1))
    with pytest.raises(ModelError, match="eigenvalue -1"):
        m.bushing("b", first, second, (1, 2, 3, 4, 5, -1), at=(0, 0, 0), axis=(0, 0, 1))
    with pytest.raises(ModelError, match="needs at= and normal="):
        m.contact("c", first, second, 1e5, centre=(0, 0, 0))
    with pytest.raises(ModelError, match="needs centre=, axis= of the round body"):
        m.contact("c", first, second, 1e5, at=(0, 0, 0), normal=(0, 0, 1), centre=(0, 0, 0), ring=0.1)
    with pytest.raises(ModelError, match="x and y of heights must rise by equal steps"):
        m.contact(
            "c",
            first,
            second,
            1e5,
            at=(0, 0, 0),
            normal=(0, 0, 1),
            centre=(0, 0, 0),
            heights=([0, 1, 3], [0, 1], [[0, 0, 0]] * 2),
        )
    with pytest.raises(ModelError, match=r"friction is -0\.1; it cannot be negative"):
        m.contact("c", first, second, 1e5, at=(0, 0, 0), normal=(0, 0, 1), centre=(0, 0, 0), friction=-0.1)
    with pytest.raises(ModelError, match="needs the frames it acts on"):
        m.user_force("u", lambda t, q, v: 0.0)
