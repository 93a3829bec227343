"""Random machines whose joints and contacts have friction: the compiled loop beside single simulations."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, harmonic
from tests.dynamics.beside_single_runs import assert_as_single_ones, between
from tools.models.rough import pusher, rub

pytestmark = pytest.mark.slow
MACHINES = 15


@st.composite
def chains(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """Bars on dry pins that fall on a rough plane, in a world turned any way."""
    turned, sticks = draw(between(-0.5, 0.5)), draw(st.booleans())
    m = Mechanism("chain", gravity=(9.81 * math.sin(turned), -9.81 * math.cos(turned)))
    friction, restitution = draw(between(0.05, 0.8)), draw(st.sampled_from([0.0, 0.3, 0.7]))
    static = friction * draw(st.sampled_from([1.0, 1.4]))
    starts: dict[str, tuple[float, float, float]] = {}
    x, y, last = 0.0, draw(between(0.3, 0.6)), None
    for k in range(draw(st.integers(2, 3))):
        length, angle = draw(between(0.2, 0.5)), draw(between(-40.0, 40.0))
        name = "part" if k == 0 else f"bar{k}"
        bar = m.bar(name, length, mass=draw(between(0.3, 2.0)))
        starts[name] = (x, y, angle)
        if last is not None:
            m.revolute(f"P{k}", last.end, bar.start)
            rub(m, sticks, [f"P{k}"], draw(between(1.0, 30.0)), draw(between(0.1, 0.4)))
        m.rigid_contact(f"tip{k}", m.ground.at(0, 0), bar.end, 0.01, restitution, friction, static)
        x, y = x + length * math.cos(math.radians(angle)), y + length * math.sin(math.radians(angle))
        last = bar
    m.start_near(**starts)
    return m, "part"


@st.composite
def pushers(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """A linkage with dry bearings that pushes a rough block to and fro."""
    sticks, friction = draw(st.booleans()), draw(between(0.05, 0.6))
    crank, block = draw(between(0.2, 1.0)), draw(between(0.5, 3.0))
    joints, preload = draw(st.sampled_from(["O", "A", "B", "OA", "OAB"])), draw(between(1.0, 30.0))
    rubbing = {name: (friction, friction * draw(st.sampled_from([1.0, 1.3]))) for name in ("rear", "front")}
    motor = draw(between(0.5, 3.0)), draw(between(2.0, 8.0))
    return pusher(sticks, joints, preload, (crank, block), rubbing, motor, draw(between(20.0, 160.0))), "part"


@st.composite
def carriers(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """A sledge on feet on a rough base that goes to and fro; on it a pendulum in a dry bearing."""
    m = Mechanism("carrier", gravity=(0, -9.81))
    sticks, friction = draw(st.booleans()), draw(between(0.05, 0.6))
    base, sledge = m.body("base", 1.0, inertia=1.0), m.body("part", draw(between(0.5, 2.0)), inertia=0.05)
    bob = m.bar("bob", draw(between(0.1, 0.4)), draw(between(0.1, 0.8)))
    m.prismatic("rail", m.ground.origin, base.origin)
    motor = harmonic(draw(between(0.01, 0.08)), draw(between(3.0, 9.0)))
    m.drive_coordinate("motor", m.ground.origin, base.origin, motor)
    m.revolute("P", sledge.origin, bob.start)
    rub(m, sticks, "P", draw(between(1.0, 20.0)))
    above = draw(st.sampled_from([1.0, 1.0, 1.5]))
    for name, x in (("rear", -0.3), ("front", 0.3)):
        m.rigid_contact(name, base.origin, sledge.at(x, -0.05), 0.0, 0.2, friction, above * friction)
    m.start_near(base=(0, 0, 0), part=(0, 0.05, 0), bob=draw(between(-170.0, -10.0)))
    return m, "part"


@st.composite
def strikers(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """A slider in a rough guide on a spring, which strikes a rough ball on the floor."""
    m = Mechanism("striker", gravity=(draw(between(-3.0, 3.0)), -9.81))
    slider, ball = m.body("part", draw(between(0.5, 2.0)), inertia=0.01), m.body("ball", 0.5, inertia=2e-4)
    m.prismatic("guide", m.ground.at(0, 0.06), slider.origin)
    friction = draw(between(0.05, 0.4))
    own = {"static": 1.2 * friction, "sticks": True} if draw(st.booleans()) else {}
    m.friction("rub", "guide", friction, length=0.1, preload=draw(between(0.0, 5.0)), **own)
    restitution = draw(st.sampled_from([0.0, 0.5]))
    m.rigid_contact("floor", m.ground.at(0, 0), ball.origin, 0.05, 0.2, draw(between(0.05, 0.5)))
    face = slider.at(0.02, 0, -math.pi / 2 + draw(between(-0.2, 0.2)))
    m.rigid_contact("face", face, ball.origin, 0.05, restitution, draw(between(0.05, 0.5)))
    m.spring("spring", m.ground.at(-0.5, 0.06), slider.origin, draw(between(20.0, 100.0)), 0.5, free_length=0.6)
    m.start_near(part=(0, 0.06, 0), ball=(0.3, 0.05, 0))
    m.start_moving(part=(draw(between(0.0, 2.0)), 0, 0), ball=(draw(between(-1.0, 0.0)), 0, 0))
    return m, "part"


@pytest.mark.parametrize("machines", [chains, pushers, carriers, strikers])
def test_random_machines_slide_and_stick_as_single_ones(machines) -> None:
    met: list[int] = []

    @settings(max_examples=MACHINES)
    @given(machines(), st.integers(1, 40), st.sampled_from([1e-8, 1e-10]))
    def agree(machine: tuple[Mechanism, str], steps: int, tolerance: float) -> None:
        met.extend(assert_as_single_ones(*machine, 1.0, steps, tolerance))

    agree()
    assert np.mean(met) > 2
