"""Every kind of joint, driver, force and contact: derivatives along a motion against differences of whole ones."""

from __future__ import annotations

import math
from typing import Any

import pytest

from mbsd import Mechanism, MechanismError, ModelError, constant_rate
from mbsd.model.force import ForceKind
from mbsd.testing import force_kinds, joint_kinds
from mbsd.testing.derivatives import check_derivatives
from mbsd.testing.forces import example as of_force
from mbsd.testing.joints import example as of_joint
from mbsd.testing.kinds import contact_kinds

KINDS: list[Any] = [*joint_kinds(), *force_kinds(), *contact_kinds()]
IN_A_MACHINE = {"gear_mesh", "gear_pair", "geneva", "rack_and_pinion"}
"""Kinds whose places must suit each other: their machines are below."""
SWITCHING = ("clearance_joint", "contact", "tyre")
"""Kinds whose force has kinks on the way of their example, which cost digits."""
REFUSED = {
    "hydraulic_cylinder": "states of forces",
    "double_acting_cylinder": "states of forces",
    "gas_cycle": "cycle of a gas",
    "capstan": "friction of cables on wheels",
}
PLACES = ("example.i.x", "example.j.x", "example.j.y")
OWN = {
    "belt": "radius_i",
    "distance": "length",
    "rolling_disc": "radius",
    "spring": "stiffness",
    "torsion_spring": "damping",
    "drag": "coefficient",
    "gas": "area",
    "gas_strut": "force",
    "bushing": "stiffness.0",
    "friction": "coefficient",
    "drive_angle": "amplitude",
    "drive_coordinate": "amplitude",
    "drive_distance": "amplitude",
    "drive_relative_angle": "rate",
}
"""A number of its own."""


def started(kind: Any) -> Mechanism:
    """Its example between two free bodies, of the first seed with which it closes."""
    for seed in range(10):
        m = of_force(kind, seed)[0] if isinstance(kind, ForceKind) else of_joint(kind, seed)
        try:
            m.simulate(0.2, steps=10)
        except MechanismError:
            continue
        return m
    raise AssertionError(f"{kind.name}: no example closes")


def numbers_of(kind: Any) -> list[str]:
    out = ["second.mass", "second.com.x", *PLACES]
    if isinstance(kind, ForceKind) and kind.on_bodies:
        out = out[:2]
    own = OWN.get(kind.name)
    if kind.name == "friction":  # its markers are those of the joint, which move together
        out = ["second.mass", "second.com.x"]
    return out if own is None else [*out, f"example.{own}"]


@pytest.mark.parametrize(
    "kind", [k for k in KINDS if k.name not in {*IN_A_MACHINE, *SWITCHING, *REFUSED}], ids=lambda k: k.name
)
def test_a_simulation_with_it(kind: Any) -> None:
    m = started(kind)
    errors = check_derivatives(
        m, ["second.x", "second.theta", "second.omega"], numbers_of(kind), 0.2, 10, tolerance=3e-6
    )
    assert len(errors) >= 2


def gears() -> Mechanism:
    m = Mechanism("gears")
    small, large = m.body("small", 1.0, inertia=0.01), m.body("large", 2.0, inertia=0.05)
    m.revolute("A", m.ground.at(0, 0), small.origin)
    m.revolute("B", m.ground.at(0.5, 0), large.origin)
    m.gear_pair("mesh", small.origin, large.origin, radius_i=0.2, radius_j=0.3)
    m.torsion_spring("spring", m.ground, large, stiffness=1.0, damping=0.1)
    m.trace("P", large.at(0.1, 0.05))
    m.start_near(small=0, large=20)
    m.start_moving(small=3.0)
    return m


def rack() -> Mechanism:
    m = Mechanism("rack")
    pinion, bar = m.body("pinion", 1.0, inertia=0.01), m.body("bar", 2.0)
    m.revolute("A", m.ground.at(0, 0), pinion.origin)
    m.prismatic("B", m.ground.at(0, -0.3), bar.origin)
    m.rack_and_pinion("mesh", bar.origin, pinion.origin, radius=0.3)
    m.spring("spring", m.ground.at(-1.0, -0.3), bar.origin, 20.0, damping=1.0, free_length=0.8)
    m.start_near(pinion=0, bar=(0, -0.3, 0))
    return m


def test_gears_and_racks_whose_phase_follows_from_the_start() -> None:
    check_derivatives(
        gears(), ["small.theta", "P.x", "B.fy"], ["small.inertia", "spring.stiffness", "P.x", "small.start.angle"],
        0.5, 20, tolerance=1e-6,
    )  # fmt: skip
    check_derivatives(
        rack(), ["pinion.theta", "bar.x", "A.fx"], ["bar.mass", "spring.free_length", "pinion.inertia"], 0.5, 20,
        tolerance=1e-6,
    )  # fmt: skip


def test_gears_with_play() -> None:
    m = Mechanism("rattle", gravity=None)
    first, second = m.body("first", 1.0, inertia=2e-3), m.body("second", 1.0, inertia=1e-3)
    m.revolute("A", m.ground.at(0, 0), first.origin)
    m.revolute("B", m.ground.at(0.09, 0), second.origin)
    m.gear_mesh(
        "mesh", first.origin, second.origin, 1e5, backlash=1e-4, radius_i=0.06, radius_j=0.03, exponent=1.5, damping=0.2
    )
    m.torque("motor", first, 2.0)
    m.torque("load", second, 0.2)
    numbers = ["motor.torque", "first.inertia", "mesh.stiffness", "mesh.damping", "mesh.backlash", "B.x"]
    check_derivatives(m, ["first.theta", "second.omega"], numbers, 0.02, 20, tolerance=1e-3)


def test_an_indexed_geneva() -> None:
    m = Mechanism("geneva")
    crank, wheel = m.body("crank", 0.1, inertia=1e-4), m.body("wheel", 0.2, inertia=2e-4)
    m.revolute("A", m.ground.at(0, 0), crank.origin)
    m.revolute("B", m.ground.at(0.1, 0), wheel.origin)
    m.geneva("index", crank.origin, wheel.origin, slots=4, radius=0.1 * math.sin(math.pi / 4))
    m.drive_angle("motor", crank, constant_rate(2.0, -0.4))
    m.start_near(crank=-23)
    check_derivatives(
        m, ["wheel.theta", "wheel.alpha", "motor.effort"], ["motor.start", "motor.rate", "wheel.inertia"], 0.35, 20,
        tolerance=1e-6,
    )  # fmt: skip


@pytest.mark.parametrize("name", SWITCHING)
def test_a_simulation_with_a_force_that_has_kinks(name: str) -> None:
    [kind] = [kind for kind in KINDS if kind.name == name]
    check_derivatives(started(kind), ["second.x", "second.theta"], ["second.mass", "example.damping"], 0.2, 10, 3e-3)


@pytest.mark.parametrize(("name", "says"), REFUSED.items())
def test_what_a_simulation_has_no_derivatives_of_is_refused_by_name(name: str, says: str) -> None:
    [kind] = [kind for kind in KINDS if kind.name == name]
    with pytest.raises(ModelError, match=f"{says} \\('example'\\)"):
        started(kind).sensitivities("second.x", "second.mass", 0.1)
