"""Random machines whose joints are released by events: the compiled loop beside single simulations of the same rows."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, angle_reaches, constant_rate, harmonic, speed_reaches
from tests.dynamics.beside_single_runs import assert_as_single_ones, between

pytestmark = pytest.mark.slow
MACHINES = 12


def clock(m: Mechanism) -> None:
    """A disc that turns by a radian a second, of its own."""
    disc = m.body("clock", mass=1.0, inertia=1.0)
    m.revolute("axle", m.ground.at(3.0, 3.0), disc.origin)
    m.drive_angle("tick", disc, constant_rate(1.0))
    m.start_near(clock=(3.0, 3.0, 0.0))


def released(m: Mechanism, draw: st.DrawFn, joints: list[str], bodies: list[str], turning: bool = True) -> None:
    """Some events that release joints: at a time or, of bodies that are ``turning``, at an angle or a speed."""
    clock(m)
    last = draw(between(0.0, 0.6))
    for k in range(draw(st.integers(1, 3))):
        let_go = draw(st.lists(st.sampled_from(joints), min_size=1, max_size=2, unique=True))
        body = m.bodies[draw(st.sampled_from(bodies))]
        what = draw(st.sampled_from(["time", "same", "angle", "speed"] if turning else ["time", "same"]))
        if what == "time":
            last = draw(st.sampled_from([1e-6, 0.05]) | between(0.0, 0.6))
        value = angle_reaches(m.bodies["clock"], last)
        if what == "angle":
            value = angle_reaches(body, draw(between(-3.0, 1.5)))
        if what == "speed":  # of a body that goes on turning at another: in free flight it would stay where it is
            value, let_go = speed_reaches(m.bodies[bodies[0]], draw(between(-6.0, 6.0))), joints[-1:]
        m.event(f"lets go {k}", value, direction=draw(st.sampled_from([0, 0, 1])), releases=let_go)


@st.composite
def dry_chains(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """Bars on pins, some of them dry and some that hold, in a world turned any way; with a floor or without."""
    turned = draw(between(-1.0, 1.0))
    m = Mechanism("chain", gravity=(9.81 * math.sin(turned), -9.81 * math.cos(turned)))
    end, places, joints = m.ground.at(0, 0), {}, []
    for k in range(draw(st.integers(2, 4))):
        bar = m.bar("part" if k == 0 else f"bar{k}", draw(between(0.2, 0.6)), mass=draw(between(0.2, 2.0)))
        joints.append(f"pin{k}")
        m.revolute(joints[-1], end, bar.start)
        if draw(st.booleans()):
            radius, preload = draw(st.sampled_from([(0.02, 0.0), (0.05, 20.0), (0.1, 200.0)]))
            sticks = draw(st.booleans())
            m.friction(f"rub{k}", joints[-1], 0.3, static=0.35, radius=radius, preload=preload, sticks=sticks)
        places[bar.name], end = draw(between(-120.0, 60.0)), bar.end
    if draw(st.booleans()):
        m.rigid_contact("floor", m.ground.at(0, -1.5), end, radius=0.02, restitution=0.4, friction=0.3)
    if draw(st.booleans()):
        m.torque("motor", m.bodies["part"], harmonic(draw(between(0.0, 5.0)), draw(between(2.0, 9.0))))
    m.start_near(**places)
    released(m, draw, joints, list(places))
    return m, f"bar{len(places) - 1}"


@st.composite
def sledges(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """Blocks on each other, pulled to and fro, whose guides stick, slide and let go."""
    m = Mechanism("sledges", gravity=(draw(between(-1.0, 1.0)), -9.81))
    below, starts = m.ground, {}
    for k in range(draw(st.integers(2, 3))):
        body = m.body(f"sledge{k}", draw(between(0.5, 2.0)), inertia=1.0)
        m.prismatic(f"on{k}", below.origin, body.origin)
        m.friction(f"rub{k}", f"on{k}", draw(between(0.1, 0.4)), static=0.45, sticks=True)
        m.force(f"pull{k}", body.origin, harmonic(draw(between(2.0, 12.0)), draw(between(1.0, 4.0))))
        below, starts[body.name] = body, (0, 0, 0)
    m.start_near(**starts)
    released(m, draw, [f"on{k}" for k in range(len(starts))], list(starts), turning=False)
    return m, below.name


@st.composite
def cranks(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """Equal cranks that carry a coupler, of which all but two repeat others; dry ones, and a stop, among them."""
    turned = draw(between(-0.4, 0.4))
    m = Mechanism("cranks", gravity=(9.81 * math.sin(turned), -9.81 * math.cos(turned)))
    coupler, joints, pin = m.bar("part", 0.6, mass=draw(between(0.3, 2.0))), [], None
    start, rough = draw(between(-85.0, -55.0)), draw(st.booleans())
    for k in range(draw(st.integers(3, 5))):
        x, y = 0.14 * k + draw(between(0.0, 0.1)), draw(between(-0.2, 0.2))
        crank = m.bar(f"crank{k}", 0.3, mass=draw(between(0.1, 1.0)))
        pin = m.revolute(f"A{k}", m.ground.at(x, y), crank.start)
        m.revolute(f"B{k}", crank.end, coupler.at(x, y))
        joints += [f"A{k}", f"B{k}"]
        if rough and draw(st.booleans()):
            sticks, preload = draw(st.booleans()), draw(st.sampled_from([0.0, 30.0]))
            m.friction(f"rub{k}", f"A{k}", draw(between(0.01, 0.1)), radius=0.02, preload=preload, sticks=sticks)
    m.torsion_spring("spring", m.ground, m.bodies["crank0"], draw(between(0.0, 4.0)), 0.05, free_angle=-math.pi / 2)
    if pin is not None and draw(st.booleans()):
        m.stop("end", pin, lower=-2.0, upper=1.0, restitution=0.4)
    names = [name for name in m.bodies if name.startswith("crank")]
    m.start_near(**dict.fromkeys(names, start))
    released(m, draw, joints, names)
    return m, "part"


@st.composite
def doors(draw: st.DrawFn) -> tuple[Mechanism, str]:
    """A leaf on two hinges of one axis, tied to a cart on two rails, above a rough floor."""
    m = Mechanism("doors", gravity=(0, -9.81))
    leaf, cart = m.bar("leaf", 0.8, mass=draw(between(0.5, 2.0))), m.body("part", mass=1.0, inertia=0.05)
    m.revolute("hinge", m.ground.at(0, 0), leaf.start)
    m.revolute("other", m.ground.at(0, 0), leaf.at(0, 0))
    m.prismatic("rail", m.ground.at(1.2, -0.5), cart.origin)
    m.prismatic("rail2", m.ground.at(1.2, -0.4), cart.at(0, 0.1))
    m.spring("tie", leaf.end, cart.origin, draw(between(10.0, 60.0)), 0.6, free_length=0.3)
    for k, point in enumerate((cart.at(-0.1, 0), cart.at(0.1, 0)) if draw(st.booleans()) else ()):
        m.rigid_contact(f"floor{k}", m.ground.at(0, -0.8), point, restitution=0.3, friction=0.2)
    m.start_near(leaf=-20, part=(1.2, -0.5, 0))
    released(m, draw, ["hinge", "other", "rail", "rail2"], ["leaf", "part"])
    return m, "part"


@pytest.mark.parametrize("machines", [dry_chains, sledges, cranks, doors])
def test_random_machines_come_apart_as_by_themselves(machines) -> None:
    met: list[int] = []

    @settings(max_examples=MACHINES, suppress_health_check=[HealthCheck.too_slow], deadline=None)
    @given(machines(), st.integers(1, 20), st.sampled_from([1e-8, 1e-10]))
    def agree(machine: tuple[Mechanism, str], steps: int, tolerance: float) -> None:
        met.extend(assert_as_single_ones(*machine, 0.8, steps, tolerance))

    agree()
    assert np.mean(met) > 0.3
