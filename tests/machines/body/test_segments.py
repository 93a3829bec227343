"""Segment tables and figures: masses add up, the whole arm of one row is that of its segments."""

from __future__ import annotations

import math

import pytest

from mbsd import ModelError
from mbsd.machines.body.figure import Figure, combined
from mbsd.machines.body.segments import ARMS_HEAD_TRUNK, DE_LEVA_MEN, DE_LEVA_WOMEN, TABLES, WINTER, SegmentTable

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
def test_what_is_no_figure_is_refused(wrong, message: str) -> None:
    with pytest.raises(ModelError, match=message):
        wrong()
