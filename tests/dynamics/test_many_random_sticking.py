"""Random machines with friction in their joints: the compiled loop beside single simulations of the same rows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, harmonic, polynomial
from tests.dynamics.beside_single_runs import assert_as_single_ones, between

pytestmark = pytest.mark.slow
MACHINES = 25


@st.composite
def bells(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """A pendulum in its dry bearing, anywhere in a world turned any way, with a stop or without."""
    turned, fall = draw(between(0.0, 6.0)), draw(between(3.0, 15.0))
    m = Mechanism("bell", gravity=(fall * math.sin(turned), -fall * math.cos(turned)))
    bar = m.bar("part", draw(between(0.2, 1.0)), mass=draw(between(0.5, 2.0)))
    pin = m.revolute("pin", m.ground.at(draw(between(-1.0, 1.0)), 0.3), bar.start)
    mu = draw(between(0.1, 0.5))
    static = mu * draw(st.sampled_from([1.0, 1.3]))
    radius, preload = draw(between(0.02, 0.1)), draw(between(0.0, 5.0))
    m.friction("rub", "pin", mu, static=static, radius=radius, preload=preload, sticks=True)
    if draw(st.booleans()):
        m.stop("end", pin, lower=-1.2 + turned, upper=0.5 + turned, restitution=0.4)
    m.start_near(part=math.degrees(turned) + draw(between(-60.0, 25.0)))
    return m, "part"


@st.composite
def slider_cranks(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """A slider-crank with friction in some of its joints, which coasts to rest and may be pulled away again."""
    m = Mechanism("slider-crank", gravity=draw(st.sampled_from([(0, 0), (0, -9.81), (6.0, -3.0)])))
    r, angle = draw(between(0.06, 0.12)), draw(between(0.0, 6.0))
    length = r * draw(between(2.2, 4.0))
    crank, rod = m.bar("part", r, draw(between(0.5, 2.0))), m.bar("rod", length, 0.8)
    slider = m.body("slider", draw(between(0.5, 2.0)), inertia=0.01)
    m.revolute("O", m.ground.origin, crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("rail", m.ground.origin, slider.origin)
    tilt = -math.asin(r * math.sin(angle) / length)
    m.start_near(
        part=math.degrees(angle),
        rod=math.degrees(tilt),
        slider=(r * math.cos(angle) + length * math.cos(tilt), 0, 0),
    )
    pins = draw(st.lists(st.sampled_from("OAB"), min_size=1, unique=True))
    for pin in pins:
        m.friction(f"rub {pin}", pin, draw(between(0.05, 0.2)), static=0.22, radius=0.02, preload=20.0, sticks=True)
    if draw(st.booleans()):
        m.friction("rub", "rail", 0.2, length=0.08, preload=10.0, sticks=True)
    m.torque("motor", crank, polynomial(0.0, draw(st.sampled_from([0.0, 2.0, -3.0]))))
    m.start_moving(part=draw(between(-8.0, 8.0)))
    return m, "part"


@st.composite
def shaken_blocks(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """A block on a spring, on a base that goes to and fro: it breaks away again and again."""
    m = Mechanism("shaken block")
    base, block = m.body("base", 1.0, inertia=1.0), m.body("part", draw(between(0.5, 2.0)), inertia=1.0)
    m.prismatic("rail", m.ground.origin, base.origin)
    m.drive_coordinate(
        "shake", m.ground.origin, base.origin, harmonic(draw(between(0.01, 0.05)), draw(between(4.0, 12.0)))
    )
    m.prismatic("touch", base.origin, block.origin)
    m.friction("rub", "touch", 0.2, static=draw(between(0.2, 0.5)), stribeck=0.05, sticks=True)
    m.spring("spring", m.ground.at(-3, 0), block.origin, draw(between(20.0, 200.0)), free_length=3.0)
    m.start_near(base=(0, 0, 0), part=(draw(between(-0.02, 0.02)), 0, 0))
    return m, "part"


@st.composite
def sledges(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """Blocks on each other, pulled to and fro: joints stick and slide in turn."""
    m = Mechanism("sledges", gravity=(draw(between(-1.0, 1.0)), -9.81))
    below, starts = m.ground, {}
    for k in range(draw(st.integers(2, 3))):
        name = f"sledge{k}"
        body = m.body(name, draw(between(0.5, 2.0)), inertia=1.0)
        m.prismatic(f"on{k}", below.origin, body.origin)
        m.friction(f"rub{k}", f"on{k}", draw(between(0.1, 0.4)), static=0.45, sticks=True)
        m.force(f"pull{k}", body.origin, harmonic(draw(between(2.0, 12.0)), draw(between(1.0, 4.0))))
        below, starts[name] = body, (0, 0, 0)
    m.start_near(**starts)
    return m, below.name


@st.composite
def pairs(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """Two slider-cranks, the second on ground or on the first one's slider, whose joints come to rest in turn."""
    m = Mechanism("pair", gravity=draw(st.sampled_from([(0, 0), (6.0, -3.0)])))
    below, x = m.ground.origin, 0.0
    for k in range(2):
        r, angle = draw(between(0.06, 0.12)), draw(between(0.3, 2.5))
        length = r * draw(between(2.2, 4.0))
        name = "part" if k == 0 else "other"
        crank, rod = m.bar(name, r, draw(between(0.5, 2.0))), m.bar(f"rod{k}", length, 0.8)
        slider = m.body(f"slider{k}", draw(between(0.5, 2.0)), inertia=0.01)
        m.revolute(f"O{k}", below, crank.start)
        m.revolute(f"A{k}", crank.end, rod.start)
        m.revolute(f"B{k}", rod.end, slider.origin)
        m.prismatic(f"rail{k}", below, slider.origin)
        tilt = -math.asin(r * math.sin(angle) / length)
        reach = x + r * math.cos(angle) + length * math.cos(tilt)
        places = {name: math.degrees(angle), f"rod{k}": math.degrees(tilt), f"slider{k}": (reach, 0, 0)}
        m.start_near(**places)
        for pin in draw(st.lists(st.sampled_from("OAB"), min_size=2, unique=True)):
            m.friction(f"rub {pin}{k}", f"{pin}{k}", draw(between(0.1, 0.3)), radius=0.02, preload=20.0, sticks=True)
        m.torque(f"motor{k}", crank, polynomial(0.0, draw(st.sampled_from([0.0, 1.0, -1.0]))))
        m.start_moving(**{name: draw(between(-5.0, 5.0))})
        if draw(st.booleans()):
            below, x = slider.origin, reach
    return m, "part"


@st.composite
def five_bars(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """Four bars with two freedoms, whose joints come to rest and give way in turn."""
    m = Mechanism("five-bar", gravity=draw(st.sampled_from([(0, 0), (0, -9.81)])))
    lengths = [draw(between(0.25, 0.35)), 0.5, draw(between(0.4, 0.5)), draw(between(0.2, 0.3))]
    a, b, c, d = (m.bar(n, x, draw(between(0.3, 1.0))) for n, x in zip(("part", *"bcd"), lengths, strict=True))
    m.revolute("A", m.ground.origin, a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", c.start, d.end)
    m.revolute("E", m.ground.at(0.4, 0), d.start)
    m.start_near(part=draw(between(90.0, 130.0)), b=45.0, c=100.0, d=draw(between(50.0, 90.0)))
    for pin in "ABCDE":
        m.friction(f"rub {pin}", pin, draw(between(0.1, 0.3)), static=0.35, radius=0.05, preload=60.0, sticks=True)
    m.torque("motor", a, polynomial(0.0, draw(st.sampled_from([0.0, 8.0, -8.0]))))
    m.torque("other", d, harmonic(draw(between(0.0, 3.0)), draw(between(2.0, 8.0))))
    m.start_moving(part=draw(between(-2.0, 2.0)), d=draw(between(-2.0, 2.0)))
    return m, "part"


@pytest.mark.parametrize(
    ("machines", "duration"),
    [(bells, 2.0), (slider_cranks, 2.0), (shaken_blocks, 2.0), (sledges, 2.0), (pairs, 1.0), (five_bars, 0.8)],
)
def test_random_machines_stick_and_slide_as_single_ones(machines, duration: float) -> None:
    met: list[int] = []

    @settings(max_examples=MACHINES)
    @given(machines(), st.integers(1, 40), st.sampled_from([1e-8, 1e-10]))
    def agree(machine: tuple[Mechanism, str], steps: int, tolerance: float) -> None:
        met.extend(assert_as_single_ones(*machine, duration, steps, tolerance))

    agree()
    assert np.mean(met) > 0.5
