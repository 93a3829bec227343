"""The hip thrust and its variants: what the film shows is a repetition that muscles make, not guides."""

from __future__ import annotations

import numpy as np
import pytest

from mbsd.machines.body.lift import Lift
from mbsd.results.solution import Solution
from mechanisms.hip_thrust import mechanism as thrust
from mechanisms.hip_thrust.parts import GAP
from shared.shapes.facets import facets
from shared.shapes.mannequin import torso
from shared.shapes.units import mm


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
