"""The gallery's linkages: their motion, traced lines, lifts and loads."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from mbsd import table
from mbsd.machines.body.lift import Lift
from mbsd.results.solution import Solution
from mechanisms.bicycle_leg import mechanism as leg
from mechanisms.four_bar_bicycle import mechanism as bicycle
from mechanisms.hip_thrust import mechanism as thrust
from mechanisms.hip_thrust.parts import GAP
from mechanisms.inverse_slider_crank import mechanism as inverse
from mechanisms.jansen_leg import mechanism as jansen
from mechanisms.scissor_lift import mechanism as lift
from mechanisms.slider_crank import mechanism as slider_crank
from mechanisms.stages.solve import stage as solve_stage
from mechanisms.stages.solve.motion_file import to_motion
from mechanisms.walschaerts import mechanism as walschaerts
from mechanisms.windshield_wiper import mechanism as wiper
from render.report.loads import load_section
from shared.contract.quantity import written
from shared.shapes.facets import facets
from shared.shapes.mannequin import torso
from shared.shapes.units import mm

# Linkages of the gallery against their closed forms and published numbers, at the sizes their folders have.


def test_gravity_costs_the_motor_the_weight_of_crank_and_rod() -> None:
    """Slow enough that masses hardly count: the torque is the weight on its lever arms (virtual work)."""
    p = slider_crank.Params(speed=1e-3)
    m = slider_crank.build(p)
    m.set_mass("crank", 0.2, (p.crank / 2, 0), 1e-5)
    m.set_mass("rod", 0.3, (p.rod / 2, 0), 1e-4)
    sol = m.sweep()
    crank, rod = sol.body("crank").theta, sol.body("rod").theta
    # dy of the rod's middle is half of that of pin A, because pin B keeps its height
    lever = p.crank * np.cos(crank) / 2
    np.testing.assert_allclose(sol.driver("motor").torque, p.gravity * (0.2 + 0.3) * lever, atol=1e-8)
    assert np.abs(rod).max() == pytest.approx(math.asin(p.crank / p.rod), rel=1e-4)


def _corner(first: np.ndarray, r: float, second: np.ndarray, s: float, left: bool) -> np.ndarray:
    """The point r from ``first`` (T, 2) and s from ``second``, left or right of the way from first to second."""
    way = second - first
    apart = np.linalg.norm(way, axis=-1, keepdims=True)
    along = (r**2 - s**2 + apart**2) / (2 * apart)
    across = np.sqrt(r**2 - along**2) * (1 if left else -1)
    unit = way / apart
    return first + along * unit + across * np.stack([-unit[..., 1], unit[..., 0]], axis=-1)


def _place(sol: Solution, name: str) -> np.ndarray:
    point = sol.point(name)
    return np.stack([point.x, point.y], axis=1)


def test_bicycle_knee_stays_between_the_dead_points_of_its_crank() -> None:
    p = bicycle.Params()
    sol = bicycle.build(p).sweep(steps=3600)
    assert sol.t[-1] == pytest.approx(1.0, rel=1e-14)  # 60 turns a minute
    to_bracket = math.radians(-p.slope)  # from hip to bracket
    angle = sol.body("thigh").theta - to_bracket

    def dead(line: float) -> float:
        return math.acos((p.hip**2 + p.thigh**2 - line**2) / (2 * p.hip * p.thigh))

    assert np.degrees(angle.max()) == pytest.approx(math.degrees(dead(p.shank + p.crank)), abs=1e-4)
    assert np.degrees(angle.min()) == pytest.approx(math.degrees(dead(p.shank - p.crank)), abs=1e-4)


def test_jansen_leg_by_circles() -> None:
    """Each joint from two others, as one draws it by compass; a foot that is nearly flat for half of the turn."""
    p = jansen.Params()
    sol = jansen.build(p).sweep()
    crank = sol.body("crank").theta
    pivot = np.zeros((len(crank), 2))
    pin = np.stack([p.a + p.m * np.cos(crank), p.l + p.m * np.sin(crank)], axis=1)
    top = _corner(pivot, p.b, pin, p.j, left=True)
    back = _corner(pivot, p.d, top, p.e, left=True)
    knee = _corner(pivot, p.c, pin, p.k, left=False)
    heel = _corner(back, p.f, knee, p.g, left=False)
    foot = _corner(heel, p.h, knee, p.i, left=False)
    np.testing.assert_allclose(_place(sol, "foot"), foot, atol=1e-14)
    low = np.sort(foot[:-1, 1])
    height, stride = np.ptp(foot[:, 1]), np.ptp(foot[:, 0])
    assert low[len(low) // 2] - low[0] < 0.1 * height
    assert height < 0.5 * stride


def test_wipers_stay_parallel_and_swing_as_the_dead_points_of_the_motor_say() -> None:
    p = wiper.Params()
    sol = wiper.build(p).sweep(steps=3600)
    first, second = sol.body("first").theta, sol.body("second").theta
    np.testing.assert_allclose(first, second, atol=1e-12)
    apart = math.hypot(*p.motor)

    def dead(line: float) -> float:
        return math.acos((apart**2 + p.lever**2 - line**2) / (2 * apart * p.lever))

    assert np.ptp(first) == pytest.approx(dead(p.rod + p.crank) - dead(p.rod - p.crank), rel=1e-5)
    assert 80 < math.degrees(np.ptp(first)) < 110


# Linkages of the gallery that draw, enlarged or straight, and lift, against their closed forms.


def test_scissor_lift() -> None:
    p = lift.Params()
    sol = lift.build(p).sweep()
    foot, platform = sol.body("foot"), sol.body("platform")
    rise = np.sqrt(p.bar**2 - foot.x**2)
    np.testing.assert_allclose(platform.y, p.crosses * rise, atol=1e-14)
    np.testing.assert_allclose(platform.vy, -p.crosses * foot.x * foot.vx / rise, atol=1e-13)
    np.testing.assert_allclose(platform.theta, 0.0, atol=1e-13)


# The hip thrust and its variants: what the film shows is a repetition that muscles make, not guides.


def solved(**changes: object) -> Solution:
    p = thrust.Params(**changes)
    return thrust.motion(thrust.build(p), p)


@pytest.mark.parametrize("variant", ["", *thrust.VARIANTS])
def test_each_variant_is_lifted_by_its_muscles(variant: str) -> None:
    sol = solved(**thrust.VARIANTS.get(variant, {}))
    assert not any(sol.driver(guide).effort.any() for guide in sol.mechanism.drivers)
    lift = Lift(sol)
    assert lift.moment("hip").max() / 80.0 > 2.0
    work = sum(lift.work(joint)[0] for joint in ("hip", "knee"))
    assert work > 65.0 * 9.8 * np.ptp(lift.bar[:, 1])
    assert sol.period == pytest.approx(float(sol.t[-1]))


def test_near_feet_and_a_low_bench_take_load_off_the_hip() -> None:
    hip = {name: Lift(solved(**changes)).moment("hip").max() for name, changes in thrust.VARIANTS.items()}
    usual = Lift(solved()).moment("hip").max()
    assert hip["feet_near"] < usual
    assert hip["low_bench"] < usual
    assert hip["squat"] > usual


def test_arms_reach_the_bar() -> None:
    """The angles at which the mannequin's arms are made are those of the mass properties."""
    for exercise in ("hip_thrust", "squat"):
        p = thrust.Params(exercise=exercise)
        who = thrust.figure(p)
        upper, lower = np.radians(thrust.arm_angles(p))
        hand = who.length("trunk") + who.length("upper_arm") * np.exp(1j * upper) + who.reach * np.exp(1j * lower)
        bar = thrust.build(p).joints["bar"].i
        assert hand == pytest.approx(complex(bar.x, bar.y), abs=1e-12)
    assert thrust.arm_angles(thrust.Params(exercise="deadlift")) == (0.0, 0.0)


@pytest.mark.parametrize("changes", [{}, thrust.VARIANTS["feet_near"], thrust.VARIANTS["low_bench"]])
def test_the_head_stays_above_the_bench(changes: dict[str, float]) -> None:
    """On a low bench the shoulders are lower than the hips at the top, and the chin goes to the chest."""
    p, sol = thrust.Params(**changes), solved(**changes)
    head = torso(mm(thrust.figure(p).length("trunk")), p.height / 1.78, p.nod)[1]
    assert head.name == "head"
    corners = facets(head.shape.val(), 1.0, 0.5).reshape(-1, 3)[:, :2] / 1000.0
    trunk = sol.body("trunk")
    up = np.sin(trunk.theta)[:, None] * corners[:, 0] + np.cos(trunk.theta)[:, None] * corners[:, 1]
    pad = sol.mechanism.joints["pad"].j.y - GAP / 1000.0
    assert (trunk.y[:, None] + up).min() > pad


# The torque that makes a wished motion: virtual work, and there and back.


def test_inverse_slider_crank_torque_makes_the_wished_motion() -> None:
    """Virtual work gives the torque, and a forward simulation under it gives the motion back."""
    p = inverse.Params()
    m = inverse.build(p)
    sol = inverse.motion(m, p)
    torque = sol.efforts["motor"]
    crank, slider = sol.body("crank"), sol.body("slider")
    np.testing.assert_allclose(slider.x, [inverse.place(p, t) for t in sol.t], atol=1e-9)
    power = np.gradient(sol.energy.total, sol.t, edge_order=2)
    assert np.abs(torque * crank.omega - power)[2:-2].max() < 2e-3 * np.abs(power).max()
    forward = m.with_efforts(wish=None, motor=table(sol.t, torque))
    forward.start_near(crank=math.degrees(crank.theta[0]), slider=(slider.x[0], 0, 0))
    again = forward.simulate(p.time, 360, tolerance=1e-10)
    assert np.abs(again.body("slider").x - slider.x).max() < 2e-3 * (p.far - p.near)


def test_the_line_and_the_report_tell_the_torque_and_not_the_driver_that_gives_nothing() -> None:
    p = inverse.Params()
    m = inverse.build(p)
    sol = inverse.motion(m, p)
    said = solve_stage._summary(sol)
    assert "wish" not in said
    assert said.endswith(f"motor up to {written(float(abs(sol.force('motor').effort).max()), 'N m')}")
    given = dict.fromkeys(("crank", "rod", "slider"), "mechanism")
    motion = to_motion(sol, None, "0" * 64, {}, given)  # pyright: ignore[reportArgumentType]
    lines = "\n".join(load_section(motion))
    assert "### Drivers" not in lines
    assert "| motor (torque) |" in lines


# The leg on a bicycle: the torque at the crank from virtual work, the work of the muscles as it was measured.


MEASURED = {
    "hip_extensors": (0.27, 74.4),
    "hip_flexors": (0.04, 18.0),
    "knee_extensors": (0.39, 110.1),
    "knee_flexors": (0.10, 30.0),
}
"""Part of the positive work, and peak power (W).

M. O. Ericson et al.: Power output and work in different muscle groups during ergometer cycling. Eur. J. Appl. Physiol.
55 (1986) 229-235, abstract: 120 W at 60 turns a minute, 20 % from the ankle, negative work of 3.4 J a leg and turn.
"""
POSITIVE = 120 / 2 / 1.0 + 3.4
"""Work of one leg in one turn (J)."""


@pytest.fixture(scope="module")
def sol() -> Solution:
    return leg.build(leg.Params()).sweep(steps=720)


def lower_leg(p: leg.Params) -> tuple[float, tuple[float, float], float]:
    """Winter's shank and foot, stiff: mass (kg), centre (m) from the ball towards the knee, inertia (kg m^2)."""
    calf, sole = 0.246 * p.height, (0.48 * 0.152 * p.height, 0.039 * p.height)  # the ankle above and behind the ball
    foot = math.hypot(*sole)
    at_ankle = math.radians(p.ankle) + math.atan2(sole[1], sole[0])
    to_knee = math.sqrt(calf**2 + foot**2 - 2 * calf * foot * math.cos(at_ankle))
    at_ball = math.asin(calf * math.sin(at_ankle) / to_knee)  # between the foot and the way to the knee
    ankle = np.array([foot * math.cos(at_ball), foot * math.sin(at_ball)])  # behind that way, where the heel is
    knee = np.array([to_knee, 0.0])
    weights = 0.0145 * p.rider, 0.0465 * p.rider
    centres = 0.5 * ankle, ankle + 0.567 * (knee - ankle)
    mass = sum(weights)
    com = (weights[0] * centres[0] + weights[1] * centres[1]) / mass
    own = weights[0] * (0.475 * foot) ** 2 + weights[1] * (0.302 * calf) ** 2
    moved = sum(w * ((c - com) ** 2).sum() for w, c in zip(weights, centres, strict=True))
    return mass, (float(com[0]), float(com[1])), float(own + moved)


def places(p: leg.Params, crank: np.ndarray) -> dict[str, np.ndarray]:
    """Centres of mass (x, y) and angles of crank, shank and thigh for angles of the crank, by circles."""
    slope = math.radians(p.slope)
    hip = p.hip * np.array([-math.cos(slope), math.sin(slope)])[:, None]
    pedal = p.crank * np.stack([np.cos(crank), np.sin(crank)])
    way = pedal - hip
    away = np.hypot(*way)
    at_hip = np.arccos((p.thigh**2 + away**2 - p.shank**2) / (2 * p.thigh * away))
    thigh = np.arctan2(way[1], way[0]) + at_hip  # the knee is in front
    to_knee = np.stack([np.cos(thigh), np.sin(thigh)])
    shank_way = hip + p.thigh * to_knee - pedal
    along = shank_way / p.shank
    across = np.stack([-along[1], along[0]])
    x, y = lower_leg(p)[1]
    return {
        "crank": np.stack([*(0.5 * pedal), crank]),
        "thigh": np.stack([*(hip + 0.433 * p.thigh * to_knee), thigh]),
        "shank": np.stack([*(pedal + x * along + y * across), np.arctan2(shank_way[1], shank_way[0])]),
    }


def test_the_torque_at_the_crank_is_that_of_virtual_work(sol: Solution) -> None:
    """J'(a) w^2 / 2 + V'(a) - muscles, at constant speed w; derivatives by central differences."""
    p = leg.Params()
    crank = sol.body("crank")
    step = 1e-5
    around = {k: places(p, crank.theta + k * step) for k in (-2, -1, 0, 1, 2)}
    masses = {
        "crank": (p.crank_mass, p.crank_mass * p.crank**2 / 12),
        "thigh": (0.100 * p.rider, 0.100 * p.rider * (0.323 * p.thigh) ** 2),
        "shank": lower_leg(p)[::2],
    }
    slopes = {}
    wanted = np.zeros(len(sol.t))
    for body, (mass, inertia) in masses.items():
        angle = around[0][body][2]
        np.testing.assert_allclose(angle, sol.body(body).theta, atol=1e-12)
        narrow, wide = ((around[k][body] - around[-k][body]) / (2 * k * step) for k in (1, 2))
        slopes[body] = (4 * narrow - wide) / 3
        bends = (around[1][body] - 2 * around[0][body] + around[-1][body]) / step**2
        weights = np.array([mass, mass, inertia])[:, None]
        wanted += (weights * slopes[body] * bends).sum(axis=0) * crank.omega**2 + 9.81 * mass * slopes[body][1]
    hip, knee = slopes["thigh"][2], slopes["shank"][2] - slopes["thigh"][2]
    for muscle in MEASURED:
        wanted -= sol.force(muscle).effort * (hip if muscle.startswith("hip") else knee)
    torque = sol.driver("bicycle").torque
    np.testing.assert_allclose(torque, wanted, atol=2e-4)
    top = int(torque.argmax())
    assert 80 < 360 * sol.t[top] < 110  # largest where the crank is level
    assert torque[np.abs(sol.t - 0.8).argmin()] < 0  # the leg is lifted


def test_muscles_do_the_work_that_was_measured(sol: Solution) -> None:
    done = {muscle: float(np.trapezoid(sol.force(muscle).power, sol.t)) for muscle in MEASURED}
    for muscle, (part, peak) in MEASURED.items():
        assert done[muscle] == pytest.approx(part * POSITIVE, rel=0.02), muscle
        assert sol.force(muscle).power.max() == pytest.approx(peak, rel=0.15), muscle
        assert sol.force(muscle).power.min() > -0.5, muscle  # no muscle brakes
    given = -float(np.trapezoid(sol.driver("bicycle").power, sol.t))
    assert given == pytest.approx(sum(done.values()), rel=1e-6)  # what the leg swings comes back


def test_without_muscles_the_bicycle_drives_the_leg_and_gets_all_of_it_back() -> None:
    p = leg.Params(**leg.VARIANTS["no_muscles"])
    power = leg.build(p).sweep().driver("bicycle").power
    assert abs(np.trapezoid(power)) < 1e-6 * np.trapezoid(np.abs(power))


def test_walschaerts_gear_keeps_its_lead_and_cuts_off_earlier_as_it_is_linked_up() -> None:
    """The lead is that of the lever at any gear; cut-offs are those of Zeuner's diagram; astern steam works against."""
    p = walschaerts.Params()
    works = []
    for gear in (p.gear, 0.6 * p.gear, -p.gear):
        sol = walschaerts.build(replace(p, gear=gear)).sweep(1.0, steps=720)
        valve, piston, steam = sol.body("valve").x, sol.body("piston").x, sol.force("steam")
        ends = np.interp([math.pi, 2 * math.pi], sol.body("crank").theta, valve)  # of the piston's travel
        assert ends[0] - ends[1] == pytest.approx(2 * p.crank * 0.022 / 0.14, rel=0.01)
        late = sol.t >= 0.5
        works.append(np.trapezoid(steam.power[late], sol.t[late]))
        if gear > 0.0:
            cut = next(t for t, what in steam.valve_events if t > 0.25 and what == "cut-off A")
            share = (np.interp(cut, sol.t, piston) - piston.min()) / (2 * p.crank)
            lead, swing = p.crank * 0.022 / 0.14, p.eccentric * gear / 0.055 * 0.162 / 0.14
            turned = math.atan2(swing, lead) + math.acos(p.lap / math.hypot(lead, swing))
            assert share == pytest.approx((1 - math.cos(turned)) / 2, abs=0.02)
    assert works[0] > works[1] > 0.0 > works[2]
