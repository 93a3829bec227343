"""Random machines in which contacts, stops and joints that stick hold each other, for tests."""

from __future__ import annotations

import math
from random import Random

from mbsd import Mechanism, harmonic, polynomial


def five_bar_with_stops(draw: Random, slip_speed: float | None = None, plain: bool = False) -> tuple[Mechanism, str]:
    """A five-bar with five dry pins that comes to rest against the stops of its crank.

    With ``slip_speed`` (m/s) friction is a smooth function of the rate; ``plain``: static friction is the kinetic one.
    """
    m = Mechanism("five-bar", gravity=draw.choice([(0, 0), (0, -9.81)]))
    r, b_length, c_length, d_length = draw.uniform(0.25, 0.35), 0.5, draw.uniform(0.4, 0.5), draw.uniform(0.2, 0.3)
    a, b = m.bar("a", r, draw.uniform(0.3, 1.0)), m.bar("b", b_length, draw.uniform(0.3, 1.0))
    c, d = m.bar("c", c_length, draw.uniform(0.3, 1.0)), m.bar("d", d_length, draw.uniform(0.3, 1.0))
    shoulder = m.revolute("A", m.ground.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", c.start, d.end)
    m.revolute("E", m.ground.at(0.4, 0), d.start)
    at_a, at_d = math.radians(draw.uniform(90.0, 130.0)), math.radians(draw.uniform(50.0, 90.0))
    x, y = r * math.cos(at_a), r * math.sin(at_a)
    u, v = 0.4 + d_length * math.cos(at_d) - x, d_length * math.sin(at_d) - y
    across = math.hypot(u, v)
    turn = math.acos((b_length**2 + across**2 - c_length**2) / (2.0 * b_length * across))
    at_b = math.atan2(v, u) + turn
    at_c = math.atan2(b_length * math.sin(at_b) - v, b_length * math.cos(at_b) - u)
    angles = {"a": at_a, "b": at_b, "c": at_c, "d": at_d}
    m.start_near(**{name: math.degrees(angle) for name, angle in angles.items()})
    above = 1.0 if plain else 1.5
    for pin in "ABCDE":
        mu, preload = draw.uniform(0.1, 0.3), draw.choice([5.0, 60.0])
        if slip_speed is None:
            m.friction(f"rub {pin}", pin, mu, static=above * mu, radius=0.05, preload=preload, sticks=True)
        else:
            m.friction(f"rub {pin}", pin, mu, radius=0.05, preload=preload, slip_speed=slip_speed)
    lower, upper = (at_a + side * math.radians(draw.uniform(2.0, 12.0)) for side in (-1.0, 1.0))
    m.stop("end", shoulder, lower=lower, upper=upper, restitution=draw.choice([0.0, 0.4]))
    m.torque("motor", a, polynomial(0.0, draw.choice([0.0, 8.0, -8.0])))
    m.torque("other", d, harmonic(draw.uniform(0.0, 3.0), draw.uniform(2.0, 8.0)))
    m.start_moving(a=draw.uniform(-4.0, 4.0), d=draw.uniform(-4.0, 4.0))
    return m, "d"


def striker(draw: Random) -> tuple[Mechanism, str]:
    """A slider that sticks in a rough guide, on a spring, which presses a rough ball on the floor."""
    m = Mechanism("striker", gravity=(draw.uniform(-3.0, 3.0), -9.81))
    slider, ball = m.body("slider", draw.uniform(0.5, 2.0), inertia=0.01), m.body("ball", 0.5, inertia=2e-4)
    m.prismatic("guide", m.ground.at(0, 0.06), slider.origin)
    mu = draw.uniform(0.05, 0.4)
    m.friction("rub", "guide", mu, static=1.2 * mu, length=0.1, preload=draw.uniform(0.0, 5.0), sticks=True)
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, 0.05, 0.2, draw.uniform(0.05, 0.5))
    face = slider.at(0.02, 0, -math.pi / 2 + draw.uniform(-0.2, 0.2))
    m.rigid_contact("face", face, ball.origin, 0.05, draw.choice([0.0, 0.5]), draw.uniform(0.05, 0.5))
    m.spring("spring", m.ground.at(-0.5, 0.06), slider.origin, draw.uniform(20.0, 100.0), 0.5, free_length=0.6)
    m.start_near(slider=(0, 0.06, 0), ball=(0.3, 0.05, 0))
    m.start_moving(slider=(draw.uniform(0.0, 2.0), 0, 0), ball=(draw.uniform(-1.0, 0.0), 0, 0))
    return m, "ball"


def shaken_box(draw: Random) -> tuple[Mechanism, str]:
    """Return a box on two or three feet with friction, pulled to and fro.

    Perhaps a dry pendulum hangs in it.
    """
    m = Mechanism("box", gravity=(draw.uniform(-2.0, 2.0), -9.81))
    box = m.body("box", draw.uniform(0.5, 2.0), inertia=0.05)
    for k, x in enumerate(draw.choice([(-0.3, 0.3), (-0.3, 0.0, 0.3), (-0.3, 0.1, 0.3)])):
        mu = draw.uniform(0.1, 0.6)
        above = draw.choice([1.0, 1.3, 1.8])
        m.rigid_contact(f"foot{k}", m.ground.at(0, 0), box.at(x, -0.05), 0.0, draw.choice([0.0, 0.3]), mu, above * mu)
    m.force("pull", box.at(0.1, draw.uniform(-0.05, 0.1)), harmonic(draw.uniform(1.0, 25.0), draw.uniform(2.0, 9.0)))
    places = {"box": (0.0, 0.05, 0.0)}
    if draw.random() < 0.5:
        bob = m.bar("bob", draw.uniform(0.1, 0.4), draw.uniform(0.1, 0.8))
        m.revolute("P", box.origin, bob.start)
        mu, preload = draw.uniform(0.1, 0.4), draw.uniform(1.0, 20.0)
        m.friction("rub", "P", mu, static=0.5, radius=0.03, preload=preload, sticks=True)
        m.start_near(**places, bob=draw.uniform(-170.0, -10.0))
    else:
        m.start_near(**places)
    m.start_moving(box=(draw.uniform(-1.0, 1.0), 0, 0))
    return m, "box"


def level_chain(draw: Random) -> tuple[Mechanism, str]:
    """A chain of bars that lies level on a rough floor, or falls level upon it."""
    m = Mechanism("level chain", gravity=(draw.choice([0.0, 1.0, 4.0]), -9.81))
    sticks, height, x, last = draw.random() < 0.5, draw.choice([0.0, 0.05]), 0.0, None
    mu = draw.uniform(0.05, 0.6)
    static = mu * draw.choice([1.0, 1.4])
    starts: dict[str, tuple[float, float, float]] = {}
    for k in range(draw.randint(2, 4)):
        length, name = draw.uniform(0.2, 0.5), f"bar{k}"
        bar = m.bar(name, length, draw.uniform(0.3, 2.0))
        if last is None:
            m.rigid_contact("tip", m.ground.at(0, 0), bar.start, 0.01, 0.0, mu, static)
        else:
            m.revolute(f"P{k}", last.end, bar.start)
            if sticks:
                preload = draw.uniform(1.0, 20.0)
                m.friction(f"rub{k}", f"P{k}", 0.2, static=0.3, radius=0.02, preload=preload, sticks=True)
        m.rigid_contact(f"tip{k}", m.ground.at(0, 0), bar.end, 0.01, 0.0, mu, static)
        starts[name] = (x, 0.01 + height, 0.0)
        x, last = x + length, bar
    if last is not None and draw.random() < 0.5:
        m.torque("motor", last, harmonic(draw.uniform(0.5, 3.0), draw.uniform(2.0, 8.0)))
    m.start_near(**starts)
    return m, "bar0"
