"""Machines with bodies along a shaft: engines, legs, walker, loom, sewing machine."""

from __future__ import annotations

import math
from collections.abc import Sequence
from math import acos, cos, pi, sin

from mbsd import Mechanism, constant_rate

# Machines whose bodies have places along the normal of the plane: engines by hand, and legs on a shaft.


THROW, ROD = 0.04, 0.145
"""m."""

type Cylinder = tuple[float, float, float]
"""Bank, counted from upright, and throw (degrees); place along the shaft (m)."""

SINGLE: Sequence[Cylinder] = [(0, 90, 0.0)]
INLINE_TWO: Sequence[Cylinder] = [(0, 90, -0.05), (0, 270, 0.05)]
INLINE_FOUR: Sequence[Cylinder] = [(0, 90, -0.15), (0, 270, -0.05), (0, 270, 0.05), (0, 90, 0.15)]
V_TWO: Sequence[Cylinder] = [(45, 90, -0.0115), (-45, 90, 0.0115)]
V_FOUR: Sequence[Cylinder] = [(45, 90, -0.0615), (-45, 90, -0.0385), (45, 270, 0.0385), (-45, 270, 0.0615)]


def engine(cylinders: Sequence[Cylinder], mass: float | None = None) -> Mechanism:
    """Return a crank, and for each cylinder a rod and a piston.

    ``mass`` (kg) of each piston, None for that of its parts.
    """
    m = Mechanism("engine")
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k, (bank, throw, z) in enumerate(cylinders, start=1):
        rod, piston = m.bar(f"rod_{k}", ROD, z=z), m.body(f"piston_{k}", mass=mass, z=z)
        a, along = math.radians(throw), math.radians(90 + bank)
        m.revolute(f"pin_{k}", crank.at(THROW * math.cos(a), THROW * math.sin(a), z=z), rod.start)
        m.revolute(f"wrist_{k}", rod.end, piston.origin)
        m.prismatic(f"bore_{k}", m.ground.at(0, 0, along, z=z), piston.origin)
        m.start_near(**{f"rod_{k}": 90 + bank, f"piston_{k}": 90 + bank})
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=0)
    return m


def legs(
    throws: Sequence[tuple[float, float]] = ((0, -0.06), (180, 0.0), (120, 0.06)), beside: float = 0.014
) -> Mechanism:
    """Return Chebyshev's lambda legs on one shaft.

    Throw (degrees) and place (m) of each; its rocker is ``beside`` it (m).
    """
    m, a = Mechanism("legs"), 0.03
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k, (throw, z) in enumerate(throws, start=1):
        turn = math.radians(throw)
        leg, rocker = m.bar(f"leg_{k}", 5 * a, z=z), m.bar(f"rocker_{k}", 2.5 * a, z=z + beside)
        m.revolute(f"pin_{k}", crank.at(a * math.cos(turn), a * math.sin(turn), z=z), leg.start)
        m.revolute(f"knee_{k}", leg.at(2.5 * a, 0), rocker.end)
        m.revolute(f"hip_{k}", m.ground.at(2 * a, 0), rocker.start)
        m.trace(f"foot_{k}", leg.end)
        m.start_near(**{f"leg_{k}": -50, f"rocker_{k}": -110})
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=0)
    return m


def press(places: Sequence[float] = (-0.03, 0.03), rod_z: bool = True, ram_z: float | None = None) -> Mechanism:
    """Return a crank that pushes one ram by rods at several places (m).

    With ``rod_z`` False the markers alone tell them.
    """
    m = Mechanism("press")
    crank, ram = m.body("crank"), m.body("ram", z=ram_z)
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k, z in enumerate(places, start=1):
        rod = m.bar(f"rod_{k}", 5 * THROW, z=z if rod_z else None)
        m.revolute(f"pin_{k}", crank.at(THROW, 0, z=z), rod.start)
        m.revolute(f"wrist_{k}", rod.end, ram.origin)
        m.start_near(**{f"rod_{k}": -90})
    m.prismatic("guide", m.ground.at(0, 0, -math.pi / 2), ram.origin)
    m.drive_angle("motor", crank, constant_rate(2 * math.pi))
    m.start_near(crank=-90, ram=(0, -6 * THROW, -90))
    return m


# Machines with a shaft that has things along it, as users write them: walker, loom, sewing machine, presses, pump.


LETTERS = {
    "a": 0.0380, "b": 0.0415, "c": 0.0393, "d": 0.0401, "e": 0.0558, "f": 0.0394, "g": 0.0367, "h": 0.0657,
    "i": 0.0490, "j": 0.0500, "k": 0.0619, "l": 0.0078, "m": 0.0150,
}  # fmt: skip
"""Theo Jansen's numbers (m)."""
LAYERS = {"upper": (0, 1), "lower": (2, 3), "j": (-1, -2), "k": (4, 5), "c": (1, 0), "f": (3, 2)}
"""Places of a left and of a right leg on one throw."""


def walker(pairs: int = 6, pitch: float = 0.07, layer: float = 0.006) -> Mechanism:
    """Jansen's beach animal: pairs of legs along one shaft, the throws a third of a turn apart."""
    m, s = Mechanism("walker"), LETTERS
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    at_pivot = acos((s["b"] ** 2 + s["d"] ** 2 - s["e"] ** 2) / (2 * s["b"] * s["d"]))
    at_knee = acos((s["g"] ** 2 + s["i"] ** 2 - s["h"] ** 2) / (2 * s["g"] * s["i"]))
    for pair in range(pairs):
        middle, throw = (pair - (pairs - 1) / 2) * pitch, 2 * pi * (pair % 3) / 3
        for which, side in ((0, 1), (1, -1)):
            name = f"{pair + 1}{'lr'[which]}"
            z = {key: middle + layer * at[which] for key, at in LAYERS.items()}
            upper, lower = m.body(f"upper_{name}", z=z["upper"]), m.body(f"lower_{name}", z=z["lower"])
            bars = {key: m.bar(f"{key}_{name}", s[key], z=z[key]) for key in "jkcf"}
            pivot, pin = m.ground.at(-side * s["a"], -s["l"]), (s["m"] * cos(throw), s["m"] * sin(throw))
            m.revolute(f"pivot_{name}", pivot, upper.origin)
            m.revolute(f"pivot_c_{name}", pivot, bars["c"].start)
            for key in "jk":
                m.revolute(f"pin_{key}_{name}", crank.at(*pin, z=z[key]), bars[key].start)
            m.revolute(f"top_{name}", bars["j"].end, upper.at(s["b"], 0))
            back = upper.at(s["d"] * cos(at_pivot), side * s["d"] * sin(at_pivot))
            m.revolute(f"back_{name}", back, bars["f"].start)
            m.revolute(f"knee_k_{name}", bars["k"].end, lower.origin)
            m.revolute(f"knee_c_{name}", bars["c"].end, lower.origin)
            m.revolute(f"heel_{name}", bars["f"].end, lower.at(s["g"], 0))
            m.trace(f"foot_{name}", lower.at(s["i"] * cos(at_knee), side * s["i"] * sin(at_knee)))
            near = {"upper": 90, "lower": 180, "j": 150, "k": 230, "c": -80, "f": -90}
            m.start_near(**{f"{key}_{name}": at if side > 0 else 180 - at for key, at in near.items()})
    m.drive_angle("motor", crank, constant_rate(-pi / 2))
    m.start_near(crank=0)
    return m


def loom(teeth: tuple[int, int] = (30, 60), place: float = 0.3) -> Mechanism:
    """A crankshaft beats the sley by two arms; a shaft at half its speed lifts two heald frames."""
    m = Mechanism("loom")
    crank, tappets, sley = m.body("crank_shaft"), m.body("tappet_shaft"), m.body("sley")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    m.revolute("low", m.ground.at(0.0, -0.18), tappets.origin)
    m.revolute("rock", m.ground.at(-0.30, -0.15), sley.origin)
    for k, z in ((1, -0.2), (2, 0.2)):
        arm = m.bar(f"arm_{k}", 0.26, z=z)
        m.revolute(f"pin_{k}", crank.at(0.05, 0, z=z), arm.start)
        m.revolute(f"sword_{k}", arm.end, sley.at(0.22, 0, z=z))
        m.start_near(**{f"arm_{k}": 165})
    module = 0.36 / sum(teeth)
    m.gear_pair("half", crank.at(0, 0, z=place), tappets.at(0, 0, z=place), teeth=teeth, module=module)
    for k, z, turn in ((1, -0.08, 0.0), (2, 0.08, pi)):
        rod, heald = m.bar(f"lift_{k}", 0.14, z=z), m.body(f"heald_{k}", z=z)
        m.revolute(f"tread_{k}", tappets.at(0.025 * cos(turn), 0.025 * sin(turn), z=z), rod.start)
        m.revolute(f"hang_{k}", rod.end, heald.origin)
        m.prismatic(f"frame_{k}", m.ground.at(0, -0.18, -pi / 2, z=z), heald.origin)
        m.start_near(**{f"lift_{k}": -90, f"heald_{k}": (0, -0.32, -90)})
    m.drive_angle("motor", crank, constant_rate(2 * pi))
    m.start_near(crank_shaft=0, tappet_shaft=0, sley=90)
    return m


def sewing_machine(belt: float = -0.1) -> Mechanism:
    """Return needle bar and take-up lever on the arm shaft of a sewing machine.

    The hook shaft turns twice as fast and moves the feed.
    """
    m = Mechanism("sewing_machine")
    arm, hook = m.body("arm_shaft"), m.body("hook_shaft")
    m.revolute("arm", m.ground.at(0, 0.20), arm.origin)
    m.revolute("hook", m.ground.at(0, 0), hook.origin)
    rod, needle = m.bar("needle_rod", 0.05, z=0.15), m.body("needle_bar", z=0.15)
    m.revolute("pin", arm.at(0.015, 0, z=0.15), rod.start)
    m.revolute("wrist", rod.end, needle.origin)
    m.prismatic("guide", m.ground.at(0, 0.2, -pi / 2, z=0.15), needle.origin)
    lever, link = m.bar("take_up", 0.06, z=0.172), m.bar("take_up_link", 0.05, z=0.184)
    m.revolute("take_up_pin", arm.at(0.015, 0, z=0.172), lever.start)
    m.revolute("swing", lever.at(0.03, 0), link.end)
    m.revolute("pivot", m.ground.at(0.05, 0.24), link.start)
    m.trace("eye", lever.end)
    m.belt("belt", arm.at(0, 0, z=belt), hook.at(0, 0, z=belt), radius_i=0.05, radius_j=0.025)
    feed, dog = m.bar("feed_rod", 0.10, z=0.06), m.bar("feed_rocker", 0.06, z=0.075)
    m.revolute("eccentric", hook.at(0.008, 0, z=0.06), feed.start)
    m.revolute("feed", feed.end, dog.end)
    m.revolute("rock", m.ground.at(0.10, -0.06), dog.start)
    m.drive_angle("motor", arm, constant_rate(2 * pi))
    m.start_near(arm_shaft=0, hook_shaft=0, needle_rod=-90, needle_bar=(0, 0.15, -90), take_up=60, take_up_link=150)
    m.start_near(feed_rod=0, feed_rocker=90)
    return m


def knuckle_press() -> Mechanism:
    """Two toggles side by side push one ram down."""
    m = Mechanism("knuckle_press")
    crank, ram = m.body("crank"), m.body("ram")
    m.revolute("main", m.ground.at(0.30, 0.22), crank.origin)
    for k, z in ((1, -0.05), (2, 0.05)):
        con, upper = m.bar(f"con_{k}", 0.26, z=z), m.bar(f"upper_{k}", 0.18, z=z + 0.012)
        lower = m.bar(f"lower_{k}", 0.18, z=z - 0.012)
        m.revolute(f"pin_{k}", crank.at(0.04, 0, z=z), con.start)
        m.revolute(f"top_{k}", m.ground.at(0, 0.40), upper.start)
        m.revolute(f"knee_{k}", con.end, upper.end)
        m.revolute(f"lower_knee_{k}", con.end, lower.start)
        m.revolute(f"wrist_{k}", lower.end, ram.origin)
        m.start_near(**{f"con_{k}": 180, f"upper_{k}": -75, f"lower_{k}": -105})
    m.prismatic("guide", m.ground.at(0, 0, -pi / 2), ram.origin)
    m.drive_angle("motor", crank, constant_rate(2 * pi))
    m.start_near(crank=90, ram=(0, 0.05, -90))
    return m


def triplex_pump(throw: float = 0.02, rod: float = 0.1, pitch: float = 0.08) -> Mechanism:
    """Three plungers side by side, a third of a turn apart, so that the flow is nearly even."""
    m = Mechanism("triplex_pump")
    crank = m.body("crank")
    m.revolute("main", m.ground.at(0, 0), crank.origin)
    for k in range(3):
        z, at = (k - 1) * pitch, 2 * pi * k / 3
        con, plunger = m.bar(f"rod_{k + 1}", rod, z=z), m.body(f"plunger_{k + 1}", z=z)
        m.revolute(f"pin_{k + 1}", crank.at(throw * cos(at), throw * sin(at), z=z), con.start)
        m.revolute(f"wrist_{k + 1}", con.end, plunger.origin)
        m.prismatic(f"guide_{k + 1}", m.ground.at(0, 0, z=z), plunger.origin)
        m.start_near(**{f"rod_{k + 1}": 0, f"plunger_{k + 1}": (rod, 0, 0)})
    m.drive_angle("motor", crank, constant_rate(2 * pi))
    m.start_near(crank=0)
    return m


def geared_shafts(z: float = 0.05, teeth: tuple[int, int, int] = (20, 30, 25)) -> Mechanism:
    """Three shafts with a gear each in one plane; the last has a belt to a fourth in another plane."""
    m = Mechanism("shafts")
    module, x = 0.002, 0.0
    bodies = []
    for k, count in enumerate(teeth):
        x += 0.0 if k == 0 else module * (teeth[k - 1] + count) / 2
        bodies.append(m.body(f"shaft_{k + 1}", z=z))
        m.revolute(f"axis_{k + 1}", m.ground.at(x, 0), bodies[-1].origin)
    for k in (0, 1):
        m.gear_pair(f"mesh_{k + 1}", bodies[k].origin, bodies[k + 1].origin, teeth=teeth[k : k + 2], module=module)
    last = m.body("shaft_4")
    m.revolute("axis_4", m.ground.at(x, 0.12), last.origin)
    m.belt("belt", bodies[2].at(0, 0, z=z + 0.04), last.at(0, 0, z=z + 0.04), radius_i=0.02, radius_j=0.03)
    m.drive_angle("motor", bodies[0], constant_rate(2 * pi))
    m.start_near(shaft_1=10, shaft_2=0, shaft_3=0, shaft_4=0)
    return m
