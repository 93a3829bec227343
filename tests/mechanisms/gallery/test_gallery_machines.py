"""The gallery's engines, gears, Geneva drive and cams, and how the machines stand."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from mbsd.drawing.moving_skeleton import moving
from mechanisms.belt_drive import mechanism as belt
from mechanisms.four_bar_motor import mechanism as motor
from mechanisms.planetary_gear import mechanism as planetary
from mechanisms.rack_steering import mechanism as steering
from mechanisms.stages.loading import loading
from mechanisms.stages.loading.loading import has, load, params
from mechanisms.stages.solve import solving
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.stages.solve.solving import build
from mechanisms.vibration_slider_crank import mechanism as vibration
from render.film.camera import angles
from render.film.framing import axes
from render.magnitudes import crank_of
from render.plots.pages.spectra import spectrum
from render.plots.quantities import quantity
from shared.contract import Motion, mounted
from shared.contract.geometry import BeltPath
from shared.contract.shot import Shot
from shared.stage.paths import planar_names
from tests.drawing.test_carried import check
from tests.mechanisms.author_project import folders_and_variants

# Machines of the gallery that shake and run up, against their closed forms and an integration by others.


def shaken(p: vibration.Params) -> Motion:
    m = vibration.build(p)
    bodies = [body for body in m.bodies if body != "ground"]
    return to_motion(m.sweep(), None, "", {}, dict.fromkeys(bodies, "mechanism"))


def orders(motion: Motion, what: str) -> np.ndarray:
    """(K, k) amplitudes from order 1 on."""
    spectral = spectrum(motion, quantity(motion, what).rows)
    assert spectral.harmonic
    np.testing.assert_array_equal(spectral.at[:3], [0, 1, 2])
    return spectral.amplitudes[1:]


def harmonics(p: vibration.Params) -> np.ndarray:
    """Return harmonics of m r w^2 along the guide: 1, and the series in r/l to its sixth power.

    C. B. Biezeno, R. Grammel: Technische Dynamik, 2nd ed. 1953, vol. 2; also K. Kutzbach, in every book on engines.
    """
    a = p.crank / p.rod
    second = a + a**3 / 4 + 15 * a**5 / 128 + 35 * a**7 / 512
    fourth = a**3 / 4 + 3 * a**5 / 16 + 35 * a**7 / 256
    sixth = 9 * a**5 / 128 + 45 * a**7 / 512
    return np.array([1.0, second, 0.0, fourth, 0.0, sixth])


def test_the_shaking_force_has_the_harmonics_of_the_books() -> None:
    p = vibration.Params()
    motion = shaken(p)
    amplitudes = orders(motion, "shaking force")
    wanted = p.oscillating * p.crank * p.speed**2 * harmonics(p)
    turning = p.rotating * p.speed**2
    wanted[0] += turning
    np.testing.assert_allclose(amplitudes[:6, 0], wanted, atol=2e-5 * wanted[0])
    np.testing.assert_allclose(amplitudes[:6, 1], [turning, 0, 0, 0, 0, 0], atol=1e-9 * turning)
    # To the second order alone, as one remembers it: m r w^2 (cos a + r/l cos 2a)
    assert amplitudes[1, 0] == pytest.approx(
        wanted[0] / (1 + turning / (wanted[0] - turning)) * p.crank / p.rod, rel=0.03
    )


def test_a_counterweight_halves_and_a_balancer_removes_the_first_harmonic() -> None:
    for name, first in (("counterweight", 0.5), ("balanced", 0.0)):
        p = vibration.Params(**vibration.VARIANTS[name])
        force = p.oscillating * p.crank * p.speed**2
        amplitudes = orders(shaken(p), "shaking force")
        assert amplitudes[0, 0] == pytest.approx(first * force, abs=1e-9 * force)
        assert (amplitudes[0, 1] if first else 0.0) == pytest.approx(first * force, abs=1e-9 * force)
        np.testing.assert_allclose(amplitudes[1:6, 0], force * harmonics(p)[1:], atol=2e-5 * force)


@pytest.mark.parametrize("variant", [{}, *vibration.VARIANTS.values()])
def test_the_shaking_force_is_what_the_joints_put_on_the_frame(variant: dict) -> None:
    """And the shaking moment, less the motor's torque, is their moment about the crank's axis."""
    motion = shaken(vibration.Params(**variant))
    fx, fy, moment = (np.zeros(len(motion.time)) for _ in range(3))
    for joint in motion.joints.values():
        if joint.bodies[0] == "ground":
            fx, fy = fx - joint.fx, fy - joint.fy
            moment = moment - (np.multiply(joint.x, joint.fy) - np.multiply(joint.y, joint.fx) + joint.torque)
    force = quantity(motion, "shaking force").components
    np.testing.assert_allclose(force["x"], fx, atol=1e-9 * np.abs(fx).max())
    np.testing.assert_allclose(force.get("y", 0.0 * fy), fy, atol=1e-9 * np.abs(fx).max())
    moment -= np.asarray(motion.drivers["motor"].effort)
    [shaking] = quantity(motion, "shaking moment").components.values()
    np.testing.assert_allclose(shaking, moment, atol=1e-9 * np.abs(fx).max())


# -- the four-bar under its motor ------------------------------------------------------------------------------------


def bars(p: motor.Params, crank: float) -> tuple[float, float, float, float]:
    """Angles of coupler and rocker (rad) and what they turn while the crank turns by 1, from the vector loop."""
    bx, by = p.crank * math.cos(crank), p.crank * math.sin(crank)
    away = math.hypot(p.ground - bx, by)
    to_d = math.atan2(-by, p.ground - bx)
    coupler = to_d + math.acos((p.coupler**2 + away**2 - p.rocker**2) / (2 * p.coupler * away))
    cx, cy = bx + p.coupler * math.cos(coupler), by + p.coupler * math.sin(coupler)
    rocker = math.atan2(cy, cx - p.ground)
    apart = math.sin(rocker - coupler)
    return (
        coupler,
        rocker,
        p.crank * math.sin(crank - rocker) / (p.coupler * apart),
        p.crank * math.sin(crank - coupler) / (p.rocker * apart),
    )


def reduced_inertia(p: motor.Params, crank: float) -> float:
    """J of the crank's angle: T = J crank'^2 / 2."""
    coupler, _, turn_coupler, turn_rocker = bars(p, crank)
    half = p.coupler / 2
    x = -p.crank * math.sin(crank) - half * turn_coupler * math.sin(coupler)
    y = p.crank * math.cos(crank) + half * turn_coupler * math.cos(coupler)
    return (
        p.wheel[1]
        + p.rotor[1] * (p.teeth[1] / p.teeth[0]) ** 2
        + p.coupler_mass * (x**2 + y**2 + p.coupler**2 / 12 * turn_coupler**2)
        + p.rocker_mass * p.rocker**2 / 3 * turn_rocker**2
    )


def height(p: motor.Params, crank: float) -> float:
    """Potential energy (J)."""
    coupler, rocker, _, _ = bars(p, crank)
    weights = p.coupler_mass * (p.crank * math.sin(crank) + p.coupler / 2 * math.sin(coupler))
    return p.gravity * (weights + p.rocker_mass * p.rocker / 2 * math.sin(rocker))


def test_four_bar_runs_up_as_eksergians_equation_of_one_freedom_says() -> None:
    """J a'' + J' a'^2 / 2 = Q, integrated by scipy (R. Eksergian, Dynamical Analysis of Machines, 1930)."""
    p = motor.Params()
    sol = motor.build(p).simulate(motor.DURATION, motor.STEPS)
    ratio, step = p.teeth[1] / p.teeth[0], 1e-5
    torque_speed = motor.curve(p.speeds, p.torques)

    def rates(t: float, state: np.ndarray) -> list[float]:
        angle, speed = state
        slope = (reduced_inertia(p, angle + step) - reduced_inertia(p, angle - step)) / (2 * step)
        lifting = (height(p, angle + step) - height(p, angle - step)) / (2 * step)
        motor_torque = ratio * float(torque_speed(np.array([ratio * speed]))[0, 0])
        braking = p.load * bars(p, angle)[3] ** 2 * speed
        return [speed, (motor_torque - lifting - braking - slope * speed**2 / 2) / reduced_inertia(p, angle)]

    crank = sol.body("crank")
    other = solve_ivp(rates, (0, sol.t[-1]), [crank.theta[0], 0.0], "DOP853", sol.t, rtol=1e-9, atol=1e-10)
    np.testing.assert_allclose(crank.theta, other.y[0], atol=1e-5)
    np.testing.assert_allclose(crank.omega, other.y[1], atol=1e-5 * np.abs(crank.omega).max())
    motion = to_motion(sol, None, "", {}, dict.fromkeys(("crank", "coupler", "rocker", "rotor"), "mechanism"))
    main_crank = crank_of(motion)
    assert main_crank is not None
    assert (main_crank.body, main_crank.turns) == ("crank", 7)
    # The last two turns are alike: it has run up.
    at = main_crank.angle[-1] - np.linspace(0, 2 * np.pi, 100)
    last, before = (np.interp(at - back, main_crank.angle, crank.omega) for back in (0.0, 2 * np.pi))
    np.testing.assert_allclose(last, before, rtol=2e-3)
    assert 0.05 < np.ptp(last) / last.mean() < 0.12


# Gears of the gallery against their closed forms: Willis' equation, the dyads of a steering, Ackermann's condition.


def test_planetary_gear_as_it_is() -> None:
    """18, 18 and 54 teeth: a quarter of the sun's speed, a third backwards, three quarters of the ring's."""
    for fixed, member, ratio in (("ring", "carrier", 1 / 4), ("carrier", "ring", -1 / 3), ("sun", "carrier", 3 / 4)):
        p = replace(planetary.Params(), fixed=fixed)
        m = planetary.build(p)
        assert m.sweep(0.1, steps=2).body(member).omega == pytest.approx(ratio * p.speed)
        assert (p.sun + p.ring) % p.planets == 0
        assert m.period() == pytest.approx(3.0 if fixed == "carrier" else 4.0)


def _steered(p: steering.Params, side: int, travel: np.ndarray) -> np.ndarray:
    """The knuckle's angle by its dyad: tie rod and arm meet where two circles do."""
    arm = p.arm * np.array([-side * math.sin(p.arm_angle), -math.cos(p.arm_angle)])
    kingpin, inner = np.array([side * p.track / 2, 0.0]), np.array([side * p.rack / 2, -p.behind])
    rod = np.hypot(*(kingpin + arm - inner))
    to = inner + np.stack([travel, np.zeros_like(travel)], axis=1) - kingpin
    away = np.hypot(*to.T)
    beside = np.arccos((p.arm**2 + away**2 - rod**2) / (2 * p.arm * away))
    return np.arctan2(to[:, 1], to[:, 0]) + side * beside - math.atan2(arm[1], arm[0])


def test_rack_steering_follows_its_dyads() -> None:
    p = steering.Params()
    sol = steering.build(p).sweep()
    travel = sol.body("rack").x
    assert travel.max() == pytest.approx(p.travel)
    np.testing.assert_allclose(travel, p.module * p.teeth / 2 * sol.body("pinion").theta, atol=1e-15)
    for side, name in ((-1, "left"), (1, "right")):
        np.testing.assert_allclose(sol.body(f"knuckle_{name}").theta, _steered(p, side, travel), atol=1e-12)


def test_rack_steering_is_near_ackermann() -> None:
    """The inner wheel turns by 32 degrees, the outer is off by less than 0.5, as the docstring has it."""
    p = steering.Params()
    travel = np.linspace(1e-4, p.travel, 200)
    inner, outer = _steered(p, -1, travel), _steered(p, 1, travel)
    assert math.degrees(inner[-1]) == pytest.approx(32.0, abs=0.3)
    ideal = np.arctan(1 / (1 / np.tan(inner) + p.track / p.wheelbase))
    off = np.degrees(np.abs(outer - ideal))
    assert 0.3 < off.max() < 0.5
    assert np.degrees(inner - outer)[-1] > 7.0


@pytest.mark.parametrize("variant", [{}, {"crossed": True}, {"teeth": 16}])
def test_belt_drive_halves_the_speed(variant: dict[str, Any]) -> None:
    """r1 w1 = r2 w2, and of a crossed belt -r2 w2. The chain's length is a whole number of its pitch."""
    p = replace(belt.Params(), **variant)
    sol = belt.build(p).sweep()
    assert sol.t[-1] == pytest.approx(2.0)
    ratio = (-1 if p.crossed else 1) / p.ratio
    np.testing.assert_allclose(sol.body("large").theta, ratio * sol.body("small").theta, atol=1e-13)
    links = BeltPath(p.radius, p.ratio * p.radius, p.distance).length / (2 * math.pi * p.radius / 16)
    assert links == pytest.approx(56, abs=1e-4)


# The gallery's Geneva drive and cam follower against closed forms.


def test_an_output_right_where_the_pin_enters_its_slot_has_the_acceleration_of_one_side() -> None:
    """Rounding decides on which side of the jump it is; the equations hold there all the same."""
    module = loading.load("geneva_drive", "mechanism")
    m = module.build(module.Params())
    sol = m.sweep(m.period(), steps=1440)
    jumps = np.abs(np.diff(sol.body("wheel").alpha)).max()
    assert jumps > 5.0
    assert sol.stats.acceleration_residual < 1e-7 * jumps


# Gravity points down in every picture of the gallery, or the machine lies on a desk and has none in its plane.


UPRIGHT = (5.0, 25.0)
"""Elevations (degrees) of the camera at eye level of what stands."""


@pytest.mark.parametrize("name", folders_and_variants())
def test_gravity_is_down_in_the_picture(name: str) -> None:
    m = build(name, load(name, "mechanism"), params(name))
    shot = load(name, "shot").shot if has(name, "shot") else Shot()
    gravity = np.array([*(m.gravity or (0.0, 0.0)), 0.0])
    mount = mounted((gravity[0], gravity[1]), shot.mount)
    azimuth, elevation = angles(shot.camera, mount)
    right, up, forward = axes(azimuth, elevation, mount.up) @ gravity
    if mount.kind == "desk":
        assert not gravity.any(), f"{name} lies on a desk, but gravity is {gravity}"
        return
    assert UPRIGHT[0] <= math.degrees(elevation) <= UPRIGHT[1]
    if gravity.any():
        assert right == pytest.approx(0.0, abs=1e-12)
        assert up < -0.9 * np.linalg.norm(gravity)
        assert abs(forward) < 0.45 * np.linalg.norm(gravity)


# Each stroke of each mechanism's skeleton is carried to where it is drawn.


@pytest.mark.parametrize("name", planar_names())
def test_each_stroke_is_carried_to_where_it_is_drawn(name: str) -> None:
    module, p = loading.load(name, "mechanism"), loading.params(name)
    solution = solving.motion_of(name, module, solving.build(name, module, p), p)
    skeleton = moving(solution)
    check(solution, skeleton)
    drivers = [driver.replace("_", " ") for driver in solution.mechanism.drivers]
    written = " ".join(label.text for label, _ in skeleton.names).replace("_", " ")
    assert all(driver in written for driver in drivers)
