"""A mechanism for every Assur group, where it matters both ways round."""

from __future__ import annotations

import math

from mbsd import Mechanism, constant_rate, harmonic


def crank(m: Mechanism, length: float = 0.1, start: float = 0.0):
    """A driven crank about the origin; returns it."""
    body = m.bar("crank", length, mass=1.0, com=(0.03, 0.01))
    m.revolute("O", m.ground.at(0, 0), body.start)
    m.drive_angle("motor", body, constant_rate(6.0, start))
    m.start_near(crank=10)
    return body


def four_bar() -> Mechanism:
    m = Mechanism("four-bar")
    coupler, rocker = m.bar("coupler", 0.38, 1.0, com=(0.1, 0.05)), m.bar("rocker", 0.30, 1.0)
    m.revolute("A", crank(m).end, coupler.start)
    m.revolute("B", coupler.end, rocker.end)
    m.revolute("C", m.ground.at(0.4, 0), rocker.start)
    m.start_near(coupler=45, rocker=90)
    return m


def slider_crank(turned_round: bool) -> Mechanism:
    m = Mechanism("slider-crank")
    rod, slider = m.bar("rod", 0.3, 1.0), m.body("slider", 1.0, com=(0.02, 0.01), inertia=0.1)
    m.revolute("A", crank(m).end, rod.start)
    m.revolute("B", rod.end, slider.at(0.01, 0.03))
    ends = m.ground.at(0.4, -0.05, 0.1), slider.at(0, 0.02, 0.2)
    m.prismatic("rail", *(reversed(ends) if turned_round else ends))
    m.start_near(rod=-5)
    return m


def slotted_rod() -> Mechanism:
    m = Mechanism("slotted rod")
    rod = m.bar("rod", 0.3, 1.0)
    m.revolute("A", crank(m).end, rod.start)
    m.pin_in_slot("rail", m.ground.at(0.2, -0.05, 0.1), rod.end)
    m.start_near(rod=-5)
    return m


def inverted(turned_round: bool) -> Mechanism:
    m = Mechanism("inverted")
    guide, block = m.body("guide", 1.0, com=(0.1, 0.02), inertia=0.2), m.body("block", 0.5, (0.01, 0.02), 0.1)
    m.revolute("A", m.ground.at(-0.3, 0.05), guide.at(0.01, 0.0))
    m.revolute("B", crank(m).end, block.at(0.02, 0.01))
    ends = guide.at(0.05, 0.01, 0.1), block.at(0.01, 0.02, 0.3)
    m.prismatic("slide", *(reversed(ends) if turned_round else ends))
    m.start_near(guide=8)
    return m


def slotted_guide() -> Mechanism:
    m = Mechanism("slotted guide")
    guide = m.body("guide", 1.0, com=(0.1, 0.02), inertia=0.2)
    m.revolute("A", m.ground.at(-0.3, 0.05), guide.at(0.01, 0.0))
    m.pin_in_slot("slot", guide.at(0, 0.03, 0.1), crank(m).end)
    m.start_near(guide=8)
    return m


def yoke(turned_round: bool) -> Mechanism:
    m = Mechanism("yoke")
    body = m.body("yoke", 1.0, com=(0.1, 0.02), inertia=0.2)
    ends = m.ground.at(0.3, 0.1, 0.1), body.at(0.02, 0.01, 0.2)
    m.prismatic("rail", *(reversed(ends) if turned_round else ends))
    m.pin_in_slot("slot", body.at(0, 0.03, 1.3), crank(m).end)
    return m


def six_bar_with_welds() -> Mechanism:
    m = four_bar()
    arm, rod, slider = m.bar("arm", 0.2, 0.3), m.bar("rod", 0.5, 0.4), m.body("slider", 0.2, inertia=0.1)
    m.weld("brazed", arm.at(0.02, 0.0, 0.4), m.bodies["rocker"].at(0.1, 0.05))
    m.revolute("D", arm.end, rod.start)
    m.revolute("E", rod.end, slider.origin)
    m.prismatic("rail", m.ground.at(0, -0.2), slider.origin)
    m.start_near(rod=-30)
    return m


def crank_on_a_turning_base() -> Mechanism:
    m = Mechanism("carried")
    base, arm = m.bar("base", 0.2, 1.0), m.bar("arm", 0.1, 1.0)
    m.revolute("O", m.ground.at(0, 0), base.start)
    m.revolute("A", base.end, arm.start)
    m.drive_angle("motor", base, constant_rate(2.0))
    m.drive_relative_angle("wrist", base, arm, constant_rate(5.0, 0.3))
    m.start_near(base=0, arm=0)
    return m


def rod(turned_round: bool, actuator: bool = False) -> Mechanism:
    """A rocker held by a massless rod from the crank's end; or a rod whose length is driven, from ground."""
    m = Mechanism("rod")
    rocker = m.bar("rocker", 0.3, 1.0, com=(0.1, 0.05))
    m.revolute("C", m.ground.at(0.4, 0), rocker.start)
    base = m.ground.at(0.05, -0.1) if actuator else crank(m).end
    ends = base, rocker.at(0.3, 0.02)
    ends = tuple(reversed(ends)) if turned_round else ends
    if actuator:
        m.drive_distance("ram", *ends, harmonic(0.08, 6.0, 0.3, 0.42))
    else:
        m.distance("coupler", *ends, 0.38)
    m.start_near(rocker=90)
    return m


def driven_slider(turned_round: bool) -> Mechanism:
    """A slider-crank that its slider drives; the coordinate is not measured along the rail, but askew."""
    m = Mechanism("driven slider")
    slider, rod, arm = m.body("slider", 1.0, com=(0.02, 0.01)), m.bar("rod", 0.3, 1.0), m.bar("arm", 0.15, 1.0)
    m.prismatic("rail", m.ground.at(0.4, -0.05, 0.1), slider.at(0, 0.02, 0.2))
    law = harmonic(0.08, 6.0, 0.2, -0.05 if turned_round else 0.05)
    ends = m.ground.at(0.35, 0.0, -0.3), slider.at(0.05, 0.03, -0.4)
    m.drive_coordinate("push", *(reversed(ends) if turned_round else ends), law)
    m.revolute("A", slider.at(0.01, 0.03), rod.start)
    m.revolute("B", rod.end, arm.end)
    m.revolute("C", m.ground.at(0.1, 0), arm.start)
    m.start_near(rod=170, arm=90)
    return m


def swinging_lever(m: Mechanism):
    """A lever that swings by 0.5 rad about the origin."""
    lever = m.bar("lever", 0.2, 1.0)
    m.revolute("O", m.ground.at(0, 0), lever.start)
    m.drive_angle("motor", lever, harmonic(0.5, 6.0))
    return lever


def two_slides(turned_round: bool, slot: bool = False) -> Mechanism:
    """Return blocks on a lever and on ground, pinned to each other.

    Or a block on a lever with its pin in a slot of ground.
    """
    m = Mechanism("two slides")
    carrier = swinging_lever(m)
    first = m.body("first", 1.0, com=(0.02, 0.01), inertia=0.1)
    ends = carrier.at(0.1, 0.02, 0.2), first.at(0.01, 0.0, 0.1)
    m.prismatic("on crank", *(reversed(ends) if turned_round else ends))
    if slot:
        m.pin_in_slot("on ground", m.ground.at(0.3, 0, math.pi / 2), first.at(0.0, 0.02))
        return m
    second = m.body("second", 1.0, com=(0.01, -0.02), inertia=0.1)
    ends = m.ground.at(0.3, 0, math.pi / 2), second.at(0.02, 0.01, 0.3)
    m.prismatic("on ground", *(reversed(ends) if turned_round else ends))
    m.revolute("pin", first.at(0.0, 0.02), second.at(0.01, 0.01))
    return m


MODELS = {
    "RRR": four_bar,
    "RRP": lambda: slider_crank(False),
    "RRP round": lambda: slider_crank(True),
    "RRP slot": slotted_rod,
    "RPR": lambda: inverted(False),
    "RPR round": lambda: inverted(True),
    "RPR slot": slotted_guide,
    "yoke": lambda: yoke(False),
    "yoke round": lambda: yoke(True),
    "welded six-bar": six_bar_with_welds,
    "rod": lambda: rod(False),
    "rod round": lambda: rod(True),
    "rod driven": lambda: rod(False, actuator=True),
    "rod driven round": lambda: rod(True, actuator=True),
    "driven slide": lambda: driven_slider(False),
    "driven slide round": lambda: driven_slider(True),
    "PRP": lambda: two_slides(False),
    "PRP round": lambda: two_slides(True),
    "PRP slot": lambda: two_slides(False, slot=True),
    "driven carried": crank_on_a_turning_base,
}
