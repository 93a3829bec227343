"""The route of large mechanisms with gears, curves, stops, redundant joints and starts that contradict themselves."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from mbsd import InitialConditionWarning, Mechanism
from mbsd.dynamics.prepare import large, prepare
from mbsd.results.solution import Solution
from tests.dynamics.test_simulate import n_four_bar


def train(pairs: int, belts: bool = False) -> Mechanism:
    """Wheels in a row on gears or belts, each with an eccentric one on its shaft's gear: one freedom."""
    m = Mechanism("train", gravity=(0.0, -9.81))
    before = None
    for k in range(pairs):
        wheel, weight = m.body(f"wheel{k}", 1.0, inertia=0.01), m.body(f"weight{k}", 0.5, (0.05, 0.0), 0.01)
        m.revolute(f"W{k}", m.ground.at(0.25 * k, 0.0), wheel.origin)
        m.revolute(f"E{k}", m.ground.at(0.25 * k, 0.3), weight.origin)
        m.start_near(**{wheel.name: 0.0, weight.name: 10.0 * k})
        if belts:
            m.belt(f"B{k}", wheel.origin, weight.origin, 0.10, 0.05)
        else:
            m.gear_pair(f"G{k}", wheel.origin, weight.origin, 0.1, 0.2)
        if before is not None and belts:
            m.belt(f"C{k}", before.origin, wheel.origin, 0.1, 0.1)
        elif before is not None:
            m.gear_pair(f"H{k}", before.origin, wheel.origin, 0.125, 0.125)
        before = wheel
    m.start_moving(wheel0=5.0)
    return m


def beads(count: int) -> Mechanism:
    """Beads on a closed curve, with springs between them; gravity pulls them down the wire."""
    m = Mechanism("beads", gravity=(0.0, -9.81))
    points = [(2 * math.cos(t), math.sin(t)) for t in np.linspace(0, 2 * math.pi, 24, endpoint=False)]
    before = None
    for k in range(count):
        bead, turn = m.body(f"bead{k}", 1.0, inertia=0.01), 2 * math.pi * k / count
        m.point_on_curve(f"wire{k}", m.ground.origin, bead.origin, points, closed=True)
        m.angle_lock(f"lock{k}", m.ground.origin, bead.origin)
        m.start_near(**{bead.name: (2 * math.cos(turn), math.sin(turn), 0)})
        if before is not None:
            m.spring(f"spring{k}", before.origin, bead.origin, 50.0, free_length=0.02)
        before = bead
    return m


def storeys(count: int, spread: float = 0.0) -> Mechanism:
    """Decks on three parallel legs each, one of them redundant; ``spread`` degrees between their start angles."""
    m = Mechanism("storeys", gravity=(0.0, -9.81))
    floor = m.ground
    for k in range(count):
        deck = m.bar(f"deck{k}", 1.0, mass=1.0)
        for j in range(3):
            leg = m.bar(f"leg{k}{'abc'[j]}", 0.3, mass=0.2)
            m.revolute(f"foot{k}{j}", floor.at(0.5 * j, 0), leg.start)
            m.revolute(f"head{k}{j}", leg.end, deck.at(0.5 * j, 0))
            m.start_near(**{leg.name: 60.0 + spread * j})
        m.start_near(**{deck.name: 0.0})
        floor = deck
    return m


def follower() -> Mechanism:
    """A disc that rolls on a hill, a pinion on a rack, and a stop that the rack meets."""
    m = Mechanism("machine", gravity=(0.0, -9.81))
    disc, pinion, rack = m.body("disc", 1.0, inertia=0.02), m.body("pinion", 1.0, (0.02, 0), 0.02), m.body("rack", 2.0)
    hill = [(x, 0.1 * math.cos(3 * x)) for x in np.linspace(-2, 2, 41)]
    m.rolling_on_curve("hill", m.ground.origin, disc.origin, hill, 0.1)
    m.revolute("shaft", m.ground.at(0, 2.1), pinion.origin)
    m.prismatic("guide", m.ground.at(0, 2.0), rack.origin, limits=(None, 0.05))
    m.rack_and_pinion("teeth", rack.origin, pinion.origin, 0.1)
    m.start_near(disc=(0.2, 0.183860459029086, 0), pinion=90, rack=(0, 2, 0))
    m.start_moving(rack=(0.5, 0, 0))
    return m


def both(build: Callable[[], Mechanism], monkeypatch: pytest.MonkeyPatch) -> tuple[Solution, Solution]:
    """A simulation by each route."""
    small = build().simulate(0.3, steps=10, tolerance=1e-10)
    monkeypatch.setattr(prepare, "MANY_COORDINATES", 0)
    return small, build().simulate(0.3, steps=10, tolerance=1e-10)


@pytest.mark.parametrize(
    "build",
    [lambda: train(4), lambda: train(4, belts=True), follower, lambda: storeys(3)],
    ids=["gears", "belts", "curves", "redundant"],
)
def test_both_routes_move_alike(build: Callable[[], Mechanism], monkeypatch: pytest.MonkeyPatch) -> None:
    dense, sparse = both(build, monkeypatch)
    assert (dense.mobility.dof, dense.mobility.redundant_rows) == (sparse.mobility.dof, sparse.mobility.redundant_rows)
    np.testing.assert_allclose(sparse.q, dense.q, atol=1e-8)
    np.testing.assert_allclose(sparse.v, dense.v, atol=1e-7)
    assert [(e.name, e.what) for e in dense.events] == [(e.name, e.what) for e in sparse.events]


def test_seven_hundred_coordinates_on_gears() -> None:
    sol = train(120).simulate(0.3, steps=6)
    assert sol.packed.coordinates > prepare.MANY_COORDINATES
    assert sol.mobility.dof == 1
    turned = sol.body("wheel0").theta - sol.body("wheel0").theta[0]
    for k in (1, 60, 119):
        wheel, weight = sol.body(f"wheel{k}").theta, sol.body(f"weight{k}").theta
        np.testing.assert_allclose(wheel - wheel[0], (-1) ** k * turned, atol=1e-11)
        np.testing.assert_allclose(weight - weight[0], -((-1) ** k) * turned / 2, atol=1e-11)
    assert np.ptp(sol.energy.total) < 1e-8 * sol.energy.kinetic.max()


def test_two_hundred_beads_on_a_wire() -> None:
    sol = beads(210).simulate(0.3, steps=6)
    assert sol.mobility.dof == 210
    assert sol.stats.position_residual < 1e-12
    assert np.ptp(sol.energy.total) < 1e-6 * sol.energy.kinetic.max()


def test_starts_that_contradict_themselves_share_the_change() -> None:
    m = storeys(60, spread=5.0)
    sol = m.simulate(0.2, steps=4)
    assert sol.mobility.redundant_rows == 60
    assert len(sol.changes) == 180
    assert "the angle of 'leg0a' is 64.9" in sol.changes[0]
    assert sol.stats.position_residual < 1e-12
    m = storeys(60)
    m.start_moving(leg0a=1.0, leg0b=2.0)
    with pytest.warns(InitialConditionWarning, match="'leg0a' is 1.5.* rad/s, not 1; .*'leg0b' is 1.5.* rad/s, not 2"):
        sol = m.simulate(0.2, steps=4, tolerance=1e-9)
    legs = [sol.body(name).omega[0] for name in ("leg0a", "leg0b", "leg0c")]
    np.testing.assert_allclose(legs, legs[0], atol=1e-11)
    assert np.ptp(sol.energy.total) < 1e-8 * sol.energy.kinetic.max()


def test_mobility_of_large_mechanisms_is_that_of_small_ones(monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where the start pose is singular: bars on one line."""

    def in_line() -> Mechanism:
        m = n_four_bar(3)
        m.start_near(**{name: 0.0 for name in m.bodies if name.startswith("rod")})
        return m

    models = [train(4), storeys(3), n_four_bar(5), in_line(), beads(3)]
    small = [m.mobility() for m in models]
    monkeypatch.setattr(large, "MANY_COORDINATES", 0)
    for m, expected in zip(models, small, strict=True):
        mobility = m.mobility()
        assert (mobility.dof, mobility.nominal, mobility.redundant_rows, mobility.singular) == (
            expected.dof,
            expected.nominal,
            expected.redundant_rows,
            expected.singular,
        )


def test_mobility_of_six_hundred_bodies() -> None:
    assert str(n_four_bar(300).mobility()) == "1 degree of freedom (1 nominal)"
