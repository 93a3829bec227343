"""Rods with automatic parts, and linear drivers and ropes between two points."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate, harmonic
from mechanisms.stages.automatic.automatic import Automatic
from mechanisms.stages.automatic.layout.planar import placed
from mechanisms.stages.automatic.pins.pins import Pin
from mechanisms.stages.automatic.pins.springs import Stretching
from tests.mechanisms.automatic.layouts import meets
from tools.hunt_parts.case import parts_of


def four_bar(scale: float = 1.0, turn: float = 0.0, rod: bool = True) -> Mechanism:
    """Its coupler is a rod."""
    m = Mechanism("rodded", gravity=None)
    crank, rocker = m.bar("crank", scale * 0.1), m.bar("rocker", scale * 0.25)
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("D", m.ground.at(0.3 * scale * math.cos(turn), 0.3 * scale * math.sin(turn)), rocker.start)
    if rod:
        m.distance("coupler", crank.end, rocker.end, scale * 0.3)
    else:
        coupler = m.bar("coupler", scale * 0.3)
        m.revolute("B", crank.end, coupler.start)
        m.revolute("C", coupler.end, rocker.end)
    m.drive_angle("motor", crank, constant_rate(6.0))
    near = {"crank": 60.0, "rocker": 100.0} | ({} if rod else {"coupler": 20.0})
    m.start_near(**{body: angle + math.degrees(turn) for body, angle in near.items()})
    return m


@pytest.mark.parametrize(("scale", "turn"), [(1.0, 0.0), (0.1, 1.0), (30.0, -2.0)])
def test_a_rod_lies_where_a_bar_would(scale: float, turn: float) -> None:
    made, barred = (Automatic(m, m.sweep()) for m in (four_bar(scale, turn), four_bar(scale, turn, rod=False)))
    assert made.levels == barred.levels
    assert made.sizes == barred.sizes
    assert not meets(made)
    pose, there = made.layout.poses["coupler"], barred.layout.poses["coupler"]
    assert pose[:, :2] == pytest.approx(there[:, :2], abs=0.05)
    assert np.cos(pose[:, 2] - there[:, 2]) == pytest.approx(1.0, abs=1e-5)


def test_pins_at_both_ends_are_on_both_bodies() -> None:
    made = Automatic(four_bar(), four_bar().sweep())
    pins = {f.name: f for f in made.layout.features if isinstance(f, Pin)}
    assert set(pins) == {"A", "D", "coupler_1", "coupler_2"}
    for pin in (pins["coupler_1"], pins["coupler_2"]):
        seen = [placed(np.array([at]), made.layout.poses[body])[:, 0] for body, at in pin.places.items()]
        assert seen[0] == pytest.approx(seen[1], abs=0.02)
    solids = made.solids(engraved_too=False)
    assert solids.rods == {"coupler": (("crank", 100.0, 0.0), ("rocker", 250.0, 0.0))}
    assert solids["coupler"][0].material == "steel"


def test_a_rod_may_join_a_revolute_joint_and_ground() -> None:
    """A lambda of two rods: one ends on the pin of the crank's other link, one on ground; none touch."""
    m = Mechanism("lambda", gravity=None)
    crank, swing = m.bar("crank", 0.06), m.bar("swing", 0.2)
    m.revolute("A", m.ground.origin, crank.start)
    m.revolute("B", crank.end, swing.start)
    m.distance("rod", swing.at(0.14, 0.0), m.ground.at(0.12, -0.12), 0.14)
    m.drive_angle("motor", crank, constant_rate(6.0))
    m.start_near(crank=90, swing=-10)
    outcome = parts_of(m, m.sweep(times=np.linspace(0.0, 2 * math.pi / 6.0, 121)))
    assert outcome.state == "built", outcome


def test_wishes_reach_a_rod() -> None:
    made = Automatic(four_bar(), four_bar().sweep())
    made.material("coupler", "brass")
    made.layer("coupler", 0)
    assert made.levels["coupler"] == 0
    assert made.solids(engraved_too=False)["coupler"][0].material == "brass"
    made = Automatic(four_bar(), four_bar().sweep())
    made.leave_out("coupler")
    solids = made.solids(engraved_too=False)
    assert "coupler" not in solids
    assert not solids.left_out
    assert [solid.through_holes for solid in (solids["crank"][0], solids["rocker"][0])] == [2, 2]


def test_a_joint_that_is_called_like_a_body_has_a_rod_of_another_name() -> None:
    m = four_bar()
    m.joints["crank"] = m.joints.pop("coupler")
    assert set(Automatic(m, m.sweep()).levels) == {"crank", "rocker", "rod_crank"}


def stretched(made: Automatic) -> dict[str, Stretching]:
    return {feature.force: feature for feature in made.layout.features if isinstance(feature, Stretching)}


def test_a_linear_driver_is_a_cylinder_between_studs() -> None:
    m = Mechanism("lift", gravity=None)
    arm = m.bar("arm", 0.3)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.drive_distance("ram", m.ground.at(0.2, -0.1), arm.at(0.2, 0), harmonic(0.22, 0.05, 1.0))
    m.start_near(arm=60)
    made = Automatic(m, m.sweep(6.0))
    ram = stretched(made)["ram"]
    assert ram.outer == pytest.approx(0.6 * ram.radius)
    held = [
        hold.force for solids in made.solids(engraved_too=False).values() for solid in solids for hold in solid.holds
    ]
    assert held == ["ram", "ram"]


@pytest.mark.parametrize("gravity", [(0.0, -9.81), None])
def test_a_rope_has_studs_and_room_to_hang(gravity: tuple[float, float] | None) -> None:
    """Its parabola lies in the triangle that is kept free, whenever it is slack."""
    from render.film.tubes.stretched import sagging

    m = Mechanism("roped", gravity=gravity)
    arm = m.bar("arm", 0.3, mass=1.0)
    m.revolute("A", m.ground.at(0, 0), arm.start)
    m.rope("rope", m.ground.at(0.3, 0.3), arm.at(0.2, 0), 0.35)
    m.start_near(arm=60)
    m.start_moving(arm=(0.0, 0.0, -3.0))
    solution = m.simulate(0.5, 60, event_rows=True)
    made = Automatic(m, solution)
    feature = stretched(made)["rope"]
    assert feature.sags is not None
    slack = np.linalg.norm(feature.path[:, 1] - feature.path[:, 0], axis=1) < made.sizes.of_metres(0.3499)
    assert slack.any()
    assert feature.sags.any() == (gravity is not None)
    down = np.array([0.0, -1.0 if gravity else 0.0, 0.0])
    for (a, b), sag in zip(feature.path[::50], feature.sags[::50], strict=True):
        rope = sagging(np.array([*a, 0.0]), np.array([*b, 0.0]), made.sizes.of_metres(0.35), down)[:, :2]
        lowest = (rope - (a + np.linspace(0, 1, len(rope))[:, None] * (b - a)))[:, 1].min()
        assert 2 * lowest >= sag[1] - 1e-6
    held = [
        hold.force for solids in made.solids(engraved_too=False).values() for solid in solids for hold in solid.holds
    ]
    assert held == ["rope", "rope"]
