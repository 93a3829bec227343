"""Machines whose joints and contacts have friction, for tests and benchmarks."""

from __future__ import annotations

import math
from typing import Any

from mbsd import Mechanism, harmonic, polynomial


def rub(m: Mechanism, sticks: bool, joints: str | list[str], preload: float = 10.0, coefficient: float = 0.2) -> None:
    """Friction of pins, by its rate alone or so that they stick."""
    own: dict[str, Any] = {"static": 1.2 * coefficient, "sticks": True} if sticks else {}
    for pin in joints:
        m.friction(f"rub {pin}", pin, coefficient, radius=0.02, preload=preload, **own)


def thrown_bars(sticks: bool, static: float | None = None) -> Mechanism:
    """Two bars on a dry pin that bounce on a rough floor."""
    m = Mechanism("thrown bars", gravity=(0, -9.81))
    a, b = m.bar("a", 0.4, mass=1.0), m.bar("b", 0.3, mass=0.6)
    m.revolute("P", a.end, b.start)
    rub(m, sticks, "P", 20.0)
    for name, place in (("left", a.start), ("middle", a.end), ("right", b.end)):
        m.rigid_contact(name, m.ground.at(0, 0), place, 0.01, 0.3, 0.3, static)
    m.start_near(a=(0.0, 0.4, -20), b=(0.5, 0.4, 25))
    m.start_moving(a=(0.5, 0.0, 0.0), b=(0.5, 0.0, -2.0))
    return m


def struck_slider(sticks: bool, static: float | None = None) -> Mechanism:
    """A slider in a rough guide that strikes a rough ball, which the floor carries."""
    m = Mechanism("struck slider", gravity=(0, -9.81))
    slider, ball = m.body("slider", 1.0, inertia=0.01), m.body("ball", 0.5, inertia=2e-4)
    m.prismatic("guide", m.ground.at(0, 0.06), slider.origin)
    own: dict[str, Any] = {"static": 0.3, "sticks": True} if sticks else {}
    m.friction("rub", "guide", 0.2, length=0.1, preload=1.0, **own)
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, 0.05, 0.2, 0.3, static)
    m.rigid_contact("face", slider.at(0.02, 0, -math.pi / 2), ball.origin, 0.05, 0.5, 0.25, static)
    m.spring("spring", m.ground.at(-0.5, 0.06), slider.origin, 60.0, 0.5, free_length=0.55)
    m.start_near(slider=(0, 0.06, 0), ball=(0.3, 0.05, 0))
    m.start_moving(slider=(1.5, 0, 0), ball=(-0.2, 0, 0))
    return m


def pushed_block(sticks: bool, static: float | None = None, torque: Any = 1.5, preload: float = 5.0) -> Mechanism:
    """A crank with dry bearings that pushes a rough block along the floor and pulls it back."""
    m = Mechanism("pushed block", gravity=(0, -9.81))
    crank, rod, block = m.bar("crank", 0.1, mass=0.3), m.bar("rod", 0.4, mass=0.2), m.body("block", 2.0, inertia=0.02)
    m.revolute("O", m.ground.at(0, 0.1), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.at(0, 0.02))
    rub(m, sticks, "OAB", preload)
    for name, x in (("rear", -0.1), ("front", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0), block.at(x, -0.05), 0.0, 0.0, 0.3, static)
    m.torque("motor", crank, torque)
    m.start_near(crank=60, rod=-10, block=(0.44, 0.05, 0))
    return m


def pusher(
    sticks: bool,
    joints: str,
    preload: float,
    masses: tuple[float, float],
    rubbing: dict[str, tuple[float, float]],
    motor: tuple[float, float],
    angle: float,
) -> Mechanism:
    """A linkage with dry bearings that pushes a rough block, its "part", to and fro.

    ``masses``: of crank and block (kg); ``rubbing``: kinetic and static friction of the feet "rear" and "front";
    ``motor``: amplitude (N m) and rate (rad/s) of its torque; ``angle``: of the crank at the start (degrees).
    """
    m = Mechanism("pusher", gravity=(0, -9.81))
    crank, rod, block = m.bar("crank", 0.1, masses[0]), m.bar("rod", 0.4, 0.2), m.body("part", masses[1], inertia=0.02)
    m.revolute("O", m.ground.at(0, 0.07), crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, block.at(0, 0.02))
    rub(m, sticks, list(joints), preload)
    for name, x in (("rear", -0.1), ("front", 0.1)):
        m.rigid_contact(name, m.ground.at(0, 0), block.at(x, -0.05), 0.0, 0.2, *rubbing[name])
    m.torque("motor", crank, harmonic(*motor))
    height = 0.07 + 0.1 * math.sin(math.radians(angle))
    tilt = -math.asin((height - 0.07) / 0.4)
    reach = 0.1 * math.cos(math.radians(angle)) + 0.4 * math.cos(tilt)
    m.start_near(crank=angle, rod=math.degrees(tilt), part=(reach, 0.05, 0))
    return m


def swinging_load(sticks: bool, static: float | None = None) -> Mechanism:
    """A sledge on a rough base that goes to and fro; a pendulum hangs on it in a dry bearing."""
    m = Mechanism("swinging load", gravity=(0, -9.81))
    base, sledge, bob = m.body("base", 1.0, inertia=1.0), m.body("sledge", 1.0, inertia=0.02), m.bar("bob", 0.3, 0.5)
    m.prismatic("rail", m.ground.origin, base.origin)
    m.drive_coordinate("motor", m.ground.origin, base.origin, harmonic(0.05, 6.0))
    m.revolute("P", sledge.origin, bob.start)
    rub(m, sticks, "P")
    for name, x in (("rear", -0.2), ("front", 0.2)):
        m.rigid_contact(name, base.origin, sledge.at(x, -0.05), 0.0, 0.0, 0.25, static)
    m.start_near(base=(0, 0, 0), sledge=(0, 0.05, 0), bob=-50)
    return m


def leaning_ladder(sticks: bool, static: float | None = None) -> Mechanism:
    """Two halves of a ladder on a dry hinge, whose rough feet slide apart."""
    m = Mechanism("leaning ladder", gravity=(0, -9.81))
    left, right = m.bar("left", 1.0, mass=2.0), m.bar("right", 1.0, mass=1.5)
    m.revolute("P", left.end, right.start)
    rub(m, sticks, "P", 50.0, 0.3)
    m.torsion_spring("hinge", left, right, 3.0, 0.5)
    for name, place in (("left foot", left.start), ("right foot", right.end)):
        m.rigid_contact(name, m.ground.at(0, 0), place, 0.0, 0.0, 0.3, static)
    m.start_near(left=(0, 0, 60), right=(0.5, 0.866, -60))
    return m


def block_beside_slider_crank(sticks: bool, static: float | None = None) -> Mechanism:
    """Return the pushed block and a slider-crank without a common body.

    They come to rest, and a growing torque pushes on.
    """
    m = pushed_block(sticks, static, polynomial(0.0, 2.0), 20.0)
    crank, rod, slider = m.bar("crank 2", 0.1, 1.0), m.bar("rod 2", 0.3, 0.8), m.body("slider 2", 1.5, inertia=0.01)
    m.revolute("P", m.ground.at(0, 1), crank.start)
    m.revolute("Q", crank.end, rod.start)
    m.revolute("R", rod.end, slider.origin)
    m.prismatic("rail", m.ground.at(0, 1), slider.origin)
    rub(m, sticks, "PQR", 100.0)
    m.torque("brake", crank, 0.1)
    m.start_near(**{"crank 2": 50, "rod 2": -15, "slider 2": (0.355, 1, 0)})
    m.start_moving(**{"crank 2": 2.0})
    return m


def dragged_arm(sticks: bool, static: float | None = None) -> Mechanism:
    """A cart rolls and drags an arm of two bars in dry pins, whose tip slides on a rough floor."""
    m = Mechanism("dragged arm", gravity=(0, -9.81))
    cart, upper, fore = m.body("cart", 3.0, inertia=0.1), m.bar("upper", 0.2, 0.5), m.bar("fore", 1.0, 0.6)
    m.prismatic("rail", m.ground.at(0, 0.3), cart.origin)
    m.revolute("P", cart.origin, upper.start)
    m.revolute("Q", upper.end, fore.start)
    rub(m, sticks, "PQ", 400.0)
    m.rigid_contact("tip", m.ground.at(0, 0), fore.end, 0.02, 0.0, 0.3, static)
    tilt = math.degrees(math.asin(0.18))
    m.start_near(cart=(0, 0.3, 0), upper=(0, 0.3, -150), fore=(-0.173, 0.2, tilt - 180))
    m.start_moving(cart=(1.0, 0, 0), upper=(1.0, 0, 0), fore=(1.0, 0, 0))
    return m


def carried_five_bar(sticks: bool, static: float | None = None) -> Mechanism:
    """Four bars with two freedoms and dry pins on a sledge that slides on a rough floor."""
    m = Mechanism("carried five-bar", gravity=(0, -9.81))
    sledge = m.body("sledge", 4.0, inertia=0.3)
    a, d = m.bar("a", 0.3, mass=0.6), m.bar("d", 0.25, mass=0.5)
    b, c = m.bar("b", 0.5, mass=0.8), m.bar("c", 0.45, mass=0.7)
    m.revolute("A", sledge.at(-0.2, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", c.start, d.end)
    m.revolute("E", sledge.at(0.2, 0), d.start)
    rub(m, sticks, "ABCDE", 1000.0)
    for name, x in (("rear", -0.5), ("front", 0.5)):
        m.rigid_contact(name, m.ground.at(0, 0), sledge.at(x, -0.05), 0.0, 0.0, 0.3, static)
    m.start_near(sledge=(0, 0.05, 0), a=110, b=45, c=100, d=70)
    m.start_moving(sledge=(2.0, 0, 0), a=(2.0, 0, 0), b=(2.0, 0, 0), c=(2.0, 0, 0), d=(2.0, 0, 0))
    return m
