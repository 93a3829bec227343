"""Segment tables, figures, squat and deadlift: masses, statics and balance of forces."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import ModelError
from mbsd.machines.body.chain import Tempo
from mbsd.machines.body.figure import Figure, combined
from mbsd.machines.body.hip_thrust import hip_thrust
from mbsd.machines.body.lift import Lift, lifted, peaks
from mbsd.machines.body.segments import ARMS_HEAD_TRUNK, DE_LEVA_MEN, DE_LEVA_WOMEN, TABLES, WINTER, SegmentTable
from mbsd.machines.body.squat_and_deadlift import deadlift, squat

LIMBS = ("shank", "thigh", "trunk", "upper_arm", "forearm")


@pytest.mark.parametrize("table", TABLES, ids=lambda table: table.name)
def test_masses_of_the_segments_are_the_mass_of_the_body(table: SegmentTable) -> None:
    assert table.total == pytest.approx(1.0, abs=2e-4)  # as printed
    who = Figure(1.70, 65.0, table)
    assert who.foot().mass + sum(who.limb(limb).mass for limb in LIMBS) == pytest.approx(65.0, rel=1e-12)


def test_a_row_of_several_segments_is_what_these_make() -> None:
    """Winter's head, arms and trunk from its trunk and hanging arms: one table, measured and rounded apart."""
    who = Figure(2.0, 100.0, WINTER)
    trunk = who.length("trunk")
    arms = combined((who.limb("upper_arm"), who.limb("forearm").placed(who.length("upper_arm"), 0.0)))
    whole = combined((who.limb("trunk"), arms.placed(trunk, 0.0, math.pi)))
    assert whole.mass == pytest.approx(100.0 * ARMS_HEAD_TRUNK.mass)
    assert whole.com[0] == pytest.approx(ARMS_HEAD_TRUNK.com * trunk, abs=0.02 * trunk)
    assert math.sqrt(whole.inertia / whole.mass) == pytest.approx(ARMS_HEAD_TRUNK.gyration * trunk, rel=0.06)


@pytest.mark.parametrize("table", [DE_LEVA_MEN, DE_LEVA_WOMEN], ids=lambda table: table.name)
def test_tables_agree_about_where_the_centre_of_a_standing_body_is(table: SegmentTable) -> None:
    """55 to 58 % of the height above the sole, whichever table."""
    for segments in (WINTER, table):
        assert 0.54 < _standing_height(Figure(1.0, 1.0, segments)) < 0.585


def _standing_height(who: Figure) -> float:
    up = math.pi / 2
    knee = who.length("ankle") + who.length("shank")
    hip = knee + who.length("thigh")
    shoulder = hip + who.length("trunk")
    pieces = [
        who.foot().placed(0.0, who.length("ankle")),
        who.limb("shank").placed(0.0, knee, -up),
        who.limb("thigh").placed(0.0, hip, -up),
        who.limb("trunk").placed(0.0, hip, up),
        who.arms((shoulder, 0.0), (shoulder - 0.999 * who.arm, 0.0)).placed(0.0, 0.0, up),
    ]
    assert combined(pieces).mass == pytest.approx(1.0)
    return combined(pieces).com[1]


def test_arms_reach_what_they_hold() -> None:
    who = Figure()
    for bend in (1, -1):
        upper, lower = who.arm_angles((0.5, 0.0), (0.1, -0.14), bend)
        x = 0.5 + who.length("upper_arm") * math.cos(upper) + who.reach * math.cos(lower)
        y = who.length("upper_arm") * math.sin(upper) + who.reach * math.sin(lower)
        assert (x, y) == pytest.approx((0.1, -0.14), abs=1e-12)
        assert bend * math.sin(upper - math.atan2(-0.14, -0.4)) > 0


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: Figure(height=-1.0), r"height is -1 m; it must be positive"),
        (lambda: Figure(mass=math.nan), r"figure: mass"),
        (lambda: Figure(table="Winter"), r"the table is a str; give WINTER"),
        (lambda: Figure().length("neck"), r"no length 'neck'; known: ankle"),
        (lambda: Figure().arms((0.0, 0.0), (1.0, 0.0)), r"the hand is 1 m from the shoulder.* reaches from 0\.\d+ to"),
    ],
)
def test_invalid_figures_are_refused(wrong, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        wrong()


WHO, LOAD = Figure(), 65.0
LIFTS = {"squat": squat, "deadlift": deadlift, "hip thrust": hip_thrust}


@pytest.fixture(scope="module")
def lifts() -> dict[str, Lift]:
    return {name: lifted(build(WHO, LOAD)) for name, build in LIFTS.items()}


@pytest.mark.parametrize("name", ["squat", "deadlift"])
def test_the_bar_goes_up_over_the_foot_and_the_floor_carries_all(lifts: dict[str, Lift], name: str) -> None:
    lift = lifts[name]
    np.testing.assert_allclose(lift.bar[:, 0], WHO.mid_foot, atol=1e-12)
    total = sum(body.mass for body in lift.solution.mechanism.bodies.values())
    assert total == pytest.approx(WHO.mass + LOAD)
    wanted = total * np.array([0.0, 9.80665]) - lift.solution.shaking().force
    np.testing.assert_allclose(lift.floor, wanted, atol=1e-8 * total * 9.8)
    assert (lift.pressure > WHO.heel).all()
    assert (lift.pressure < WHO.toe).all()
    assert not lift.pad.any()


@pytest.mark.parametrize("name", ["squat", "deadlift"])
def test_slow_moments_are_those_of_the_weights_above_each_joint(name: str) -> None:
    """M = sum of m g times how far in front of the joint each weight is, bodies of the chain above it."""
    lift = lifted(LIFTS[name](WHO, LOAD, tempo=Tempo(200.0, 1.0, 200.0, 1.0)), steps=36)
    sol = lift.solution
    place = {body: centre(sol, body) for body in sol.mechanism.bodies if body != "ground"}
    above = {"hip": ["trunk", "barbell", "arms"]}
    above["knee"] = [*above["hip"], "thigh"]
    above["ankle"] = [*above["knee"], "shank"]
    side = {"hip": 1, "knee": -1, "ankle": 1}  # in front of the knee they would stretch it
    for joint, bodies in above.items():
        x = sol.joint(joint).x
        wanted = sum(9.80665 * sol.mechanism.bodies[body].mass * (place[body] - x) for body in bodies if body in place)
        np.testing.assert_allclose(lift.moment(joint), side[joint] * wanted, atol=0.05, err_msg=joint)


def centre(sol, body: str) -> np.ndarray:
    frame, com = sol.body(body), sol.mechanism.bodies[body].com
    return frame.x + np.cos(frame.theta) * com[0] - np.sin(frame.theta) * com[1]


def test_the_three_lifts_differ_as_was_measured(lifts: dict[str, Lift]) -> None:
    """With one barbell. Knee: squat, hip thrust, deadlift in this order (Otsuka et al., PLoS ONE 16, 2021, e0251418);
    hip: more in the deadlift than in the squat (Choe et al., J. Strength Cond. Res. 35, 2021, 1364); early in the lift
    most in the deadlift, late most in the hip thrust (ISBS 36, 2018, 53).
    """
    knee = {name: lift.moment("knee").max() for name, lift in lifts.items()}
    assert knee["squat"] > knee["hip thrust"] > knee["deadlift"]
    hip = {name: lift.moment("hip") for name, lift in lifts.items()}
    assert hip["deadlift"].max() > hip["squat"].max()
    late = {name: hip[name][lift.bar[:, 1].argmax()] for name, lift in lifts.items()}
    assert late["hip thrust"] > 2 * max(late["squat"], late["deadlift"])


def test_measures_of_a_study_are_those_of_the_lift(lifts: dict[str, Lift]) -> None:
    measured = peaks(squat(WHO, LOAD), WHO, steps=360)
    lift = lifts["squat"]
    assert measured["hip"] == pytest.approx(lift.moment("hip").max() / WHO.mass)
    assert measured["travel"] == pytest.approx(np.ptp(lift.bar[:, 1]))
    assert measured["floor"] > 9.8 * (WHO.mass + LOAD)
    assert measured["pad"] == 0.0


def test_joints_and_flexions_are_named(lifts: dict[str, Lift]) -> None:
    assert math.degrees(lifts["squat"].flexion("knee").max()) == pytest.approx(120.0)
    assert lifts["deadlift"].moment("shoulder").shape == lifts["deadlift"].t.shape
    with pytest.raises(ModelError, match=r"squat: there is no moment at 'shoulder'; known: hip, knee, ankle"):
        lifts["squat"].moment("shoulder")
    with pytest.raises(ModelError, match=r"no flexion of 'elbow'; known: hip, knee, ankle"):
        lifts["squat"].flexion("elbow")


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: squat(line=0.9), r"squat: the bar's line is 1\.\d+ m in front of the hip.*or give line="),
        (lambda: deadlift(line=1.0), r"deadlift: at the top the bar is .* in front of the shoulder"),
        (lambda: deadlift(shank=(0.0, 0.0), thigh=(130.0, 0.0), floor=2.0), r"deadlift: at the bottom the bar is"),
        (lambda: squat(thigh=(150.0, 0.0)), r"squat: thigh is 150 degrees at the bottom; it must be from 0 to 130"),
        (lambda: deadlift(floor=-1.0), r"deadlift: floor is -1 m; it must be 0 m or more"),
    ],
)
def test_impossible_lifts_are_refused(wrong, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        wrong()
