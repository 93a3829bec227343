"""The hip thrust and its variants: what the film shows is a repetition that muscles make, not guides."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd.machines.body.lift import Lift
from mbsd.results.solution import Solution
from mechanisms.hip_thrust import mechanism as thrust


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
