"""Joints that slide beside bodies at rest, whose forces say how hard they are pressed; joints without friction; bodies
that hold each other by forces that end with their rest."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from mbsd import Mechanism, harmonic
from mbsd.measures import samples
from tools.models.rough import pusher

TIMES = np.linspace(0.0, 1.0, 21)


def thrown_chain(lengths: tuple[float, ...], starts: tuple[tuple[float, float, float], ...], **numbers) -> Mechanism:
    """Three bars that fall on a rough plane; two come to lie on it while the first turns on its dry pin."""
    m = Mechanism("chain", gravity=numbers["gravity"])
    places, last = {}, None
    for k, (length, mass, start) in enumerate(zip(lengths, numbers["masses"], starts, strict=True)):
        bar = m.bar(f"bar{k}", length, mass=mass)
        if last is not None:
            m.revolute(f"P{k}", last.end, bar.start)
            rub, preload = numbers["pins"][k - 1]
            m.friction(f"rub {k}", f"P{k}", rub, radius=0.02, preload=preload)
        kinetic, static = numbers["floor"]
        m.rigid_contact(f"tip{k}", m.ground.at(0, 0), bar.end, 0.01, numbers["restitution"], kinetic, static)
        places[f"bar{k}"], last = start, bar
    m.start_near(**places)
    return m


def drawn_chain() -> Mechanism:
    return thrown_chain(
        (1 / 3, 0.3635905816197978, 0.4499364978283497),
        ((0.0, 0.5, 4.716697551), (0.3322044884532743, 0.5274096509, 0.0), (0.69579507, 0.5274096509, -37.656216457)),
        gravity=(0, -9.81),
        masses=(1.9, 0.3057589663168389, 1.6131558561858959),
        pins=((0.39059551703586526, 11.995333765818355), (0.2982419381307455, 24.491337122141598)),
        floor=(0.5369023442370257, 0.7516632819318358),
        restitution=0.3,
    )


def tilted_chain() -> Mechanism:
    return thrown_chain(
        (0.3391574234344522, 0.20136540080403034, 1 / 3),
        ((0.0, 0.492397074, -25.693933), (0.305622532, 0.345350735, 0.0), (0.506987933, 0.345350735, -15.7262457)),
        gravity=(-4.703164533707231, -8.609084932144556),
        masses=(1.0, 0.3, 1.314788509333237),
        pins=((0.18509142085587088, 2.0), (0.2085055448926974, 2.6845456791798874)),
        floor=(0.6706532284418136, 0.938914519818539),
        restitution=0.0,
    )


@pytest.mark.parametrize("build", [drawn_chain, tilted_chain])
def test_bars_that_lie_give_way_to_one_that_turns_beside_them(build) -> None:
    """They share what holds them, and with it what presses the turning pin: it came to no end who slips."""
    m = build()
    own = ("x", "theta", "omega")
    measure = {part: samples(f"bar0.{part}", TIMES.tolist()) for part in own}
    many = m.simulate_many(vary={"bar0": {"mass": [m.bodies["bar0"].mass]}}, measure=measure, times=TIMES)
    sol = m.simulate(times=TIMES)
    slips = [event.time for event in sol.events if event.what == "slides" and event.name in ("tip1", "tip2")]
    assert len(slips) >= 2
    assert len(set(slips)) < len(slips), "they lie on one line and give way together"
    assert many.reason[0] is None
    assert many.alone[0] is None, many.alone[0]
    for part in own:
        np.testing.assert_allclose(many[part][0], getattr(sol.body("bar0"), part), atol=1e-6)
    fine = m.simulate(times=TIMES, tolerance=1e-11)
    np.testing.assert_allclose(sol.body("bar0").theta, fine.body("bar0").theta, atol=1e-5)


COEFFICIENTS = st.one_of(st.just(0.0), st.floats(0.05, 0.4))


@settings(max_examples=15, deadline=None)
@given(
    coefficients=st.lists(COEFFICIENTS, min_size=3, max_size=3).filter(lambda each: 0.0 in each),
    masses=st.lists(st.floats(0.5, 2.0), min_size=3, max_size=3),
    pulls=st.lists(st.tuples(st.floats(0.0, 12.0), st.floats(1.0, 4.0)), min_size=3, max_size=3),
    tilt=st.sampled_from([0.0, 0.0, -1.0, 0.7]),
)
def test_a_joint_with_a_coefficient_of_zero_moves_as_one_without_friction(
    coefficients: list[float], masses: list[float], pulls: list[tuple[float, float]], tilt: float
) -> None:
    def sledges(rubs: list[float | None]) -> Mechanism:
        m = Mechanism("sledges", gravity=(tilt, -9.81))
        below = m.ground
        for k, (rub, mass, pull) in enumerate(zip(rubs, masses, pulls, strict=True)):
            body = m.body(f"sledge{k}", mass, inertia=1.0)
            m.prismatic(f"on{k}", below.origin, body.origin)
            if rub is not None:
                m.friction(f"rub{k}", f"on{k}", rub, sticks=True)
            m.force(f"pull{k}", body.origin, harmonic(*pull))
            below = body
        m.start_near(sledge0=(0, 0, 0), sledge1=(0, 0, 0), sledge2=(0, 0, 0))
        return m

    m, bare = sledges(coefficients), sledges([rub or None for rub in coefficients])
    sol, other = m.simulate(times=TIMES, tolerance=1e-10), bare.simulate(times=TIMES, tolerance=1e-10)
    without = {f"rub{k}" for k, rub in enumerate(coefficients) if rub == 0.0}
    assert not without & {event.name for event in sol.events}
    assert [(e.name, e.what) for e in sol.events] == [(e.name, e.what) for e in other.events]
    for k in range(3):
        name = f"sledge{k}"
        np.testing.assert_allclose(sol.body(name).x, other.body(name).x, atol=1e-7)
        assert f"rub{k}" not in without or not sol.friction(f"rub{k}").force.any()
    measure = {"x": samples("sledge2.x", TIMES.tolist())}
    many = m.simulate_many(vary={"sledge2": {"mass": masses[2:]}}, measure=measure, times=TIMES, tolerance=1e-10)
    assert many.alone[0] is None
    np.testing.assert_allclose(many["x"][0], sol.body("sledge2").x, atol=1e-8)


def test_a_block_gives_way_to_a_linkage_that_pressed_it_down_while_it_held() -> None:
    """Torques of dry pins at rest turn the rod onto the block, whose feet hold more by that, and end with the rest."""
    angle, rubbing = 84.8264358, {"rear": (0.2, 0.2), "front": (0.2, 0.2)}
    m = pusher(True, "OAB", 2.3037288079360136, (0.2, 0.5), rubbing, (0.5, 4.843645223170216), angle)
    sol, fine = (m.simulate(times=TIMES, tolerance=tolerance) for tolerance in (1e-8, 1e-11))
    begins = [event.time for event in sol.events if event.what == "slides"]
    assert {event.name for event in sol.events if event.time == begins[0]} >= {
        "rear",
        "front",
        "rub O",
        "rub A",
        "rub B",
    }
    assert begins[0] == pytest.approx(0.07533634, abs=1e-5)
    np.testing.assert_allclose(sol.body("part").x, fine.body("part").x, atol=1e-6)
    still = begins[0] > TIMES
    assert np.ptp(sol.body("part").x[still]) < 1e-12
    assert np.ptp(sol.body("part").x) > 0.01
