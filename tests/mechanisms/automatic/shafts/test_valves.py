"""Overhead camshafts, belts and valves by themselves: proven clear of pistons, heads and each other."""

from __future__ import annotations

import math
from typing import Any

import pytest

from mbsd import Mechanism, constant_rate, four_stroke
from mbsd.cams import Lift, flat_cam
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.valve_train import ValveTrain
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.shafts.along import Along
from shared.stage.errors import UserError
from tests.mechanisms.automatic.shafts.proofs import checked
from tools.models import shaft_machines as models


def motor(layout: str, **valves: Any) -> Mechanism:
    gas = four_stroke(10.0, heat_density=1.2e6)
    size = {"bore": 0.08, "stroke": 0.08, "rod": 0.15, "spacing": 0.1, "speed": 100.0}
    return engine(layout, **size, gas=gas, valves=ValveTrain(**valves))


def along(m: Mechanism) -> Along:
    plan = Automatic(m, m.sweep(steps=90)).along
    assert plan is not None
    return plan


@pytest.mark.slow
def test_a_single_with_valves_is_built_and_nothing_touches() -> None:
    made, bodies = checked(motor("I1"))
    assert made.along is not None
    for kind in ("intake_1", "exhaust_1"):
        plan = made.along.valves[kind]
        assert plan.valve.lift == pytest.approx(6.4, abs=1e-3)  # mm
        assert 2 * plan.radius == pytest.approx(0.4 * 80.0)
        held = [hold.force for solids in bodies.values() for solid in solids for hold in solid.holds]
        assert held.count(f"spring_{kind}") == 2  # on the head and on the valve, so that the film draws it between
    head = next(solid for solid in bodies["ground"] if solid.name == "head_piston_1")
    assert head.through_holes == 2  # its ports


@pytest.mark.parametrize(("layout", "shafts"), [("I4", 1), ("V2", 2)])
def test_engines_with_several_valves_pass(layout: str, shafts: int) -> None:
    plan = along(motor(layout))
    plan.refuse()
    cams = [shaft for shaft in plan.shafts if shaft.shaft.body.startswith("camshaft")]
    assert len(cams) == shafts
    for shaft in cams:
        assert len(shaft.mounted) == 1 + 2 * len(plan.cylinders) / shafts
        assert shaft.mounted[-1].is_wheel
        assert shaft.mounted[-1].low > shaft.ends[1]  # the pulley hangs beyond the last bearing


def test_a_follower_over_no_cylinder_is_told() -> None:
    lift = Lift.of((2.0, 0.004, "cycloidal"), (2.0, 0.0, "cycloidal"), (2 * math.pi - 4.0, 0.0))
    m = models.engine(models.SINGLE)
    cam, pushed = m.body("cam"), m.body("pushed", z=0.02)
    m.revolute("axis", m.ground.at(0.3, 0), cam.origin)
    m.prismatic("guide", m.ground.at(0.3, 0, math.pi / 2, z=0.02), pushed.origin)
    m.cam_flat("contact", cam.at(0, 0, z=0.02), pushed.at(0, 0, -math.pi / 2), flat_cam(lift, 0.02))
    m.drive_angle("turn", cam, constant_rate(2 * math.pi))
    m.start_near(cam=0, pushed=(0.3, 0.02, 90))
    with pytest.raises(UserError, match="'pushed' is pushed by the cam of 'contact' and slides over no cylinder"):
        along(m).refuse()


def test_valves_beside_their_bore_are_told() -> None:
    with pytest.raises(UserError, match=r"valve 'intake_1' is 36 mm along z from the middle of its cylinder"):
        along(motor("I1", apart=0.072)).refuse()
