"""Driven mechanisms in space against published numbers and closed forms; each test names its source."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd.spatial import Mechanism, constant_rate, polynomial
from tests.spatial import machines
from tests.spatial.machines import about

TOLERANCE = 1e-9


@pytest.mark.parametrize(
    ("bend", "out_at_45", "other_yoke"),
    [
        (15, 45.99297280436371, 44.00702719563628),
        (30, 49.10660535086909, 40.893394649130904),
        (45, 54.735610317245346, 35.264389682754654),
    ],
)
def test_a_hooke_joint_turns_as_its_closed_form_says(bend: float, out_at_45: float, other_yoke: float) -> None:
    """tan out = tan in / cos b, or tan in cos b, by the yoke that starts in the plane of the shafts."""
    angle = math.radians(bend)
    for yoke, wanted in ((math.pi / 2, out_at_45), (0.0, other_yoke)):
        sol = machines.hooke_joint(angle, yoke).sweep(duration=math.pi / 2, steps=90)
        out = sol.joint("bearing 2")
        assert math.degrees(out.turn[45]) == pytest.approx(wanted, abs=TOLERANCE)
        assert sorted((out.turn_rate.min(), out.turn_rate.max())) == pytest.approx(
            [math.cos(angle), 1 / math.cos(angle)], abs=TOLERANCE
        )
        assert sol.mobility.redundant_rows == 3
        assert sol.mobility.dof == 1


@pytest.mark.parametrize("bend", [20, 35])
def test_two_hooke_joints_cancel_in_phase_and_add_a_quarter_off(bend: float) -> None:
    angle = math.radians(bend)
    even = machines.hooke_pair(angle, quarter=False).sweep(duration=2 * math.pi).joint("bearing 2").turn_rate
    assert np.allclose(even, 1.0, rtol=0, atol=TOLERANCE)
    uneven = machines.hooke_pair(angle, quarter=True).sweep(duration=2 * math.pi).joint("bearing 2").turn_rate
    assert uneven.min() == pytest.approx(math.cos(angle) ** 2, abs=TOLERANCE)
    assert uneven.max() == pytest.approx(math.cos(angle) ** -2, abs=TOLERANCE)


def test_haugs_slider_crank() -> None:
    """Haug, Computer Aided Kinematics and Dynamics of Mechanical Systems, 1989: place, speed, acceleration."""
    eye = machines.slider_crank().sweep(times=[0.0, 0.125, 0.25, 0.5, 0.75]).point("eye")
    wanted = [
        (0.2, -0.2513274122871836, 1.579136704174298),
        (0.1852291588876695, 0.03837739556634461, 2.6445038033195405),
        (0.20784609690826528, 0.29020789827747484, 1.1143183348516377),
        (0.28, 0.17951958020513112, -1.4686431738530636),
        (0.27422618401604176, -0.21995922513874713, -1.3281350315445863),
    ]
    motion = np.column_stack([eye.x, eye.velocity[:, 0], eye.acceleration[:, 0]])
    assert np.allclose(motion, wanted, rtol=0, atol=TOLERANCE)
    many = machines.slider_crank().sweep(duration=1.0, steps=20_000).point("eye")
    assert (many.x.min(), many.x.max()) == pytest.approx((0.18495188844027224, 0.29015995409838535), abs=1e-8)
    speed = many.velocity[:, 0]
    assert (speed.min(), speed.max()) == pytest.approx((-0.3305208861651059, 0.3305208861610005), abs=1e-7)


def test_haugs_four_link() -> None:
    """Haug, 1989: spatial four-link with crank, coupler and rocker."""
    sol = machines.four_link().sweep(duration=2.0, steps=2000)
    middle, rocker = sol.point("middle"), sol.joint("bearing 2")
    assert middle.place[0] == pytest.approx([-3.745557718914, -4.25, 4.262365437829], abs=TOLERANCE)
    assert middle.velocity[0] == pytest.approx([-5.26684752247, -3.14159265359, -2.818073732816], abs=TOLERANCE)
    assert middle.acceleration[0] == pytest.approx([17.01557318537, 0.0, -11.70249448868], abs=TOLERANCE)
    assert rocker.turn_rate[0] == pytest.approx(1.6144259810377692, abs=TOLERANCE)
    assert rocker.turn_acceleration[0] == pytest.approx(-3.821154304197, abs=TOLERANCE)
    assert math.degrees(np.ptp(rocker.turn)) == pytest.approx(131.01408 - 45.11356, abs=1e-4)


def test_bennetts_loop_moves_with_three_redundant_rows() -> None:
    """Bennett 1903: tan(theta / 2) tan(phi / 2) = K, where Gruebler counts -2 freedoms."""
    m = machines.bennett()
    assert m.mobility().dof == 1
    assert m.mobility().nominal == -2
    assert m.mobility().redundant_rows == 3
    sol = m.sweep(duration=2 * math.pi, steps=360)
    ratio = math.sin(math.radians(55)) / math.sin(math.radians(15))
    start = math.radians(60.0), 2 * math.atan(ratio / math.tan(math.radians(30.0)))
    theta, phi = start[0] + sol.joint("hinge 0").turn, start[1] + sol.joint("hinge 1").turn
    left = np.sin(theta / 2) * np.sin(phi / 2) - ratio * np.cos(theta / 2) * np.cos(phi / 2)
    assert np.abs(left).max() < 1e-12
    assert np.allclose(sol.body("link 2").rotation[-1], np.eye(3), atol=1e-11)
    for turned, other in ((30, 170.32162607929226), (90, 144.93112508126293), (150, 80.59912861351138)):
        reached = ratio / math.tan(math.radians(turned) / 2)
        assert math.degrees(2 * math.atan(reached)) == pytest.approx(other, abs=TOLERANCE)


def test_bricards_loop_has_one_freedom_that_is_not_counted() -> None:
    """IFToMM benchmark A04: dof 1, Gruebler 0."""
    mobility = machines.bricard().mobility()
    assert (mobility.dof, mobility.nominal, mobility.redundant_rows) == (1, 0, 1)


def test_sarrus_leads_a_plate_straight_up() -> None:
    m = machines.sarrus()
    sol = m.sweep(duration=math.radians(60), steps=60)
    plate, angle = sol.point("plate"), math.radians(10) + sol.t
    assert np.allclose(plate.z, 0.4 * np.sin(angle), rtol=0, atol=1e-13)
    assert np.allclose(plate.place[:, :2], 0.0, atol=1e-13)
    assert plate.z[20] == pytest.approx(0.19999999999999998, abs=TOLERANCE)
    assert plate.velocity[20, 2] == pytest.approx(0.3464101615137755, abs=TOLERANCE)
    assert sol.mobility.redundant_rows == 1


LENGTHS = [1.0757581913396066, 1.2467799073639507, 1.2175326410725333, 1.2207072532823073, 1.0089657232209899,
           1.2634236183459286]  # fmt: skip
PUSHES = [129.66785709401634, 105.69452671883658, 80.77802215349257, 81.09102986755177, 145.322327662066,
          48.5991864213922]  # fmt: skip
RATES = [-0.4161008766639316, 0.2471939521099457, -0.21684895792621378, -0.3294923603078937, -0.5571565123336844,
         0.12100299761269759]  # fmt: skip


def stewart(laws: list) -> Mechanism:
    m = Mechanism("Stewart platform", gravity=(0.0, 0.0, -9.81))
    base, platform = (-10, 10, 110, 130, 230, 250), (-50, 50, 70, 170, 190, 290)
    centre = np.array([0.1, -0.05, 0.95])
    roll, pitch, yaw = np.radians([5, -8, 12])
    turned = about((0, 0, 1), yaw) @ about((0, 1, 0), pitch) @ about((1, 0, 0), roll)
    plate = m.body("platform", 50.0, com=centre, inertia=(3.0, 3.0, 5.0))
    for k in range(6):
        foot = np.array([math.cos(math.radians(base[k])), math.sin(math.radians(base[k])), 0.0])
        head = 0.6 * np.array([math.cos(math.radians(platform[k])), math.sin(math.radians(platform[k])), 0.0])
        m.drive_distance(f"leg {k}", m.ground, plate, laws[k], start=foot, end=centre + turned @ head)
    return m


def test_a_stewart_platform_stands_on_its_legs_and_moves_with_them() -> None:
    """Closed forms of leg lengths, statics and the inverse Jacobian."""
    standing = stewart([polynomial(length) for length in LENGTHS]).sweep(times=[0.0])
    assert standing.body("platform").place[0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-12)
    efforts = [standing.driver(f"leg {k}").force[0] for k in range(6)]
    assert efforts == pytest.approx(PUSHES, abs=1e-8)
    moving = stewart([polynomial(length, rate) for length, rate in zip(LENGTHS, RATES, strict=True)]).sweep(times=[0])
    body = moving.body("platform")
    centre = body.velocity[0] + np.cross(body.w[0], [0.1, -0.05, 0.95])
    assert [*centre, *body.w[0]] == pytest.approx([0.1, 0.2, -0.3, 0.4, -0.5, 0.6], abs=TOLERANCE)


def test_a_delta_robot_reaches_the_place_of_its_angles() -> None:
    """Closed form: base .2, platform .05, arms .2, rods .45 m; angles below the horizontal."""
    wanted = 19.98974845310761, 45.93069592471842, 32.16201139964748
    m = Mechanism("delta robot")
    height, start = -0.4, math.radians(27.277414558952945)
    plate = m.body("platform", 0.5, com=(0, 0, height), inertia=(1e-3, 1e-3, 1e-3))
    for k, degrees in enumerate(wanted):
        spin = about((0, 0, 1), math.radians(120 * k))
        hinge, side = spin @ [0.2, 0, 0], spin @ [0, 0.06, 0]
        elbow = spin @ [0.2 + 0.2 * math.cos(start), 0, -0.2 * math.sin(start)]
        wrist = spin @ [0.05, 0, 0] + [0, 0, height]
        arm = m.rod(f"arm {k}", hinge, elbow, mass=0.2, radius=0.01)
        m.revolute(f"hinge {k}", m.ground, arm, at=hinge, axis=spin @ [0, 1, 0])
        for sign in (-1, 1):
            m.distance(f"rod {k} {sign}", arm, plate, start=elbow + sign * side, end=wrist + sign * side, length=0.45)
        m.drive_turn(f"motor {k}", f"hinge {k}", polynomial(0.0, math.radians(degrees) - start))
    m.trace("tool", plate, at=(0, 0, height))
    sol = m.sweep(times=[0.0, 1.0])
    assert sol.point("tool").place[0] == pytest.approx([0, 0, height], abs=TOLERANCE)
    assert sol.point("tool").place[1] == pytest.approx([0.06, -0.04, -0.42], abs=TOLERANCE)
    assert np.allclose(sol.body("platform").rotation, np.eye(3), atol=1e-12)


def test_a_swash_plate_moves_its_piston_by_a_cosine() -> None:
    """Closed form: stroke 2 R tan(tilt)."""
    tilt, speed, radius = math.radians(15), 157.07963267948966, 0.04
    m = Mechanism("swash plate")
    plate = m.disc("plate", (0, 0, 0), (-math.sin(tilt), 0, math.cos(tilt)), radius=0.06, mass=1.0, thickness=0.01)
    foot = (radius, 0, radius * math.tan(tilt))
    piston = m.body("piston", 0.1, com=foot, inertia=(1e-5, 1e-5, 1e-5))
    m.revolute("bearing", m.ground, plate, at=(0, 0, 0), axis=(0, 0, 1))
    m.prismatic("bore", m.ground, piston, at=foot, axis=(0, 0, 1))
    m.point_on_plane("shoe", plate, piston, at=foot, axis=(-math.sin(tilt), 0, math.cos(tilt)))
    m.drive_turn("motor", "bearing", constant_rate(speed))
    m.trace("shoe", piston, at=foot)
    sol = m.sweep(duration=2 * math.pi / speed, steps=360)
    shoe = sol.point("shoe")
    assert np.ptp(shoe.z) == pytest.approx(0.021435935394489816, abs=TOLERANCE)
    assert shoe.z[30] == pytest.approx(0.009282032302755093, abs=TOLERANCE)
    assert shoe.velocity[30, 2] == pytest.approx(-0.8417872144769328, abs=1e-9)
    assert shoe.acceleration[30, 2] == pytest.approx(-229.0249671658131, abs=1e-7)


def test_a_bevel_pair_turns_by_its_teeth() -> None:
    m = Mechanism("bevel pair")
    for k, axis in enumerate([(1, 0, 0), (0, 1, 0)], 1):
        wheel = m.disc(f"wheel {k}", 0.1 * np.array(axis), axis, radius=0.05, mass=0.1)
        m.revolute(f"shaft {k}", m.ground, wheel, at=0.1 * np.array(axis), axis=axis)
    m.gear_pair("teeth", "shaft 1", "shaft 2", teeth=(16, 40))
    m.drive_turn("motor", "shaft 1", constant_rate(10.0))
    turned = m.sweep(duration=5.0, steps=50).joint("shaft 2")
    assert turned.turn[-1] == pytest.approx(-0.4 * 50.0, abs=TOLERANCE)
    assert np.allclose(turned.turn_rate, -4.0, rtol=0, atol=TOLERANCE)


def test_a_bevel_differential_halves_the_speeds() -> None:
    """Left 30, right 18 rad/s: carrier 24, planet 10 on it."""
    m = Mechanism("bevel differential")
    carrier = m.body("carrier", 1.0, inertia=(2.0, 2.0, 2.0))
    m.revolute("carrier bearing", m.ground, carrier, at=(0, 0, 0), axis=(1, 0, 0))
    for name, axis in (("left", (-1, 0, 0)), ("right", (1, 0, 0)), ("planet", (0, 1, 0))):
        wheel = m.disc(name, 0.1 * np.array(axis), axis, radius=0.05, mass=1.0)
        m.revolute(f"{name} bearing", carrier, wheel, at=0.1 * np.array(axis), axis=axis)
    m.gear_pair("left teeth", "left bearing", "planet bearing", teeth=(20, 12))
    m.gear_pair("right teeth", "planet bearing", "right bearing", teeth=(12, 20))
    m.drive_turn("motor", "carrier bearing", constant_rate(24.0))
    m.drive_turn("left", "left bearing", constant_rate(-6.0))
    sol = m.sweep(duration=1.0, steps=20)
    assert np.allclose(sol.body("left").w[:, 0], 30.0, rtol=0, atol=TOLERANCE)
    assert np.allclose(sol.body("right").w[:, 0], 18.0, rtol=0, atol=TOLERANCE)
    assert np.allclose(sol.joint("planet bearing").turn_rate, 10.0, rtol=0, atol=TOLERANCE)


def test_a_differential_without_planets_does_the_same() -> None:
    m = Mechanism("differential")
    for name in ("left", "right", "cage"):
        shaft = m.shaft(name, (0, 0, 0), (0.2, 0, 0), radius=0.01)
        m.revolute(f"{name} bearing", m.ground, shaft, at=(0, 0, 0), axis=(1, 0, 0))
    m.differential("wheels", "left bearing", "right bearing", "cage bearing")
    m.drive_turn("left", "left bearing", constant_rate(30.0))
    m.drive_turn("right", "right bearing", constant_rate(18.0))
    sol = m.sweep(duration=1.0, steps=20)
    assert sol.joint("cage bearing").turn[-1] == pytest.approx(24.0, abs=TOLERANCE)


def test_a_skew_disc_shakes_its_bearing() -> None:
    """Closed form: couple (I_axis - I_across) sin cos of the skew, times the square of the speed."""
    m = Mechanism("skew disc", gravity=None)
    skew = math.radians(5)
    disc = m.disc("disc", (0, 0, 0), (math.cos(skew), math.sin(skew), 0), radius=0.15, mass=4.0, thickness=0.02)
    m.revolute("bearing", m.ground, disc, at=(0, 0, 0), axis=(1, 0, 0))
    m.drive_turn("motor", "bearing", constant_rate(100.0))
    couple = np.linalg.norm(m.sweep(steps=36).joint("bearing").moment, axis=1)
    assert np.allclose(couple, 19.41965453575171, rtol=0, atol=1e-9)
    assert np.allclose(couple / 0.5, 38.83930907150342, rtol=0, atol=1e-9)


def test_a_gyro_answers_a_turn_with_a_couple() -> None:
    """Closed form: I3 spin turn = 12 N m."""
    m = Mechanism("gyro", gravity=None)
    frame = m.body("frame", 1.0, inertia=(0.1, 0.1, 0.1))
    wheel = m.body("wheel", 1.0, inertia=(0.02, 0.011, 0.011))
    m.revolute("mast", m.ground, frame, at=(0, 0, 0), axis=(0, 0, 1))
    m.revolute("spindle", frame, wheel, at=(0, 0, 0), axis=(1, 0, 0))
    m.drive_turn("turn", "mast", constant_rate(3.0))
    m.drive_turn("spin", "spindle", constant_rate(200.0))
    spindle = m.sweep(duration=0.1, steps=50).joint("spindle")
    assert np.abs(spindle.local_moment[:, 2]).max() < 1e-9
    assert np.allclose(np.linalg.norm(spindle.moment, axis=1), 12.0, rtol=0, atol=1e-9)


def test_a_conical_pendulum_hangs_without_a_moment() -> None:
    """Closed form: omega^2 = g / (l cos angle), tension m g / cos angle."""
    angle, omega = math.radians(40), 3.578553549739008
    m = Mechanism("conical pendulum", gravity=(0, 0, -9.81))
    bob = (math.sin(angle), 0.0, -math.cos(angle))
    mast = m.body("mast", 0.0)
    ball = m.body("bob", 1.0, com=bob)
    m.revolute("bearing", m.ground, mast, at=(0, 0, 0), axis=(0, 0, 1))
    m.fixed("hook", mast, ball, at=(0, 0, 0))
    m.drive_turn("motor", "bearing", constant_rate(omega))
    hook = m.sweep(steps=30).joint("hook")
    assert np.allclose(hook.magnitude, 12.806045508349655, rtol=0, atol=1e-9)
    assert np.abs(hook.moment).max() < 1e-9
