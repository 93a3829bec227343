"""Tangents in independent coordinates are those of reference coordinates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import mbsd
from mbsd.derivatives import simulations
from mbsd.derivatives.numbers import near_numbers
from mbsd.derivatives.sensitivities import simulation_tangents
from mbsd.measures import final, integral, samples
from mbsd.numbers.names import Number
from mbsd.testing.derivatives import check_derivatives


def links() -> mbsd.Mechanism:
    """Three freedoms."""
    m = mbsd.Mechanism("links", gravity=(0.0, -9.81))
    a, b, c = m.bar("a", 0.3, mass=0.5), m.bar("b", 0.2, mass=0.3), m.bar("c", 0.25, mass=0.2)
    m.revolute("A", m.ground.at(0.1, 0.2), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.start)
    m.spring("s", m.ground.at(0.5, 0.3), c.end, 50.0, damping=0.2, free_length=0.1)
    m.start_near(a=10, b=-20, c=40)
    m.start_moving(a=3.0, b=-2.0, c=1.0)
    return m


def slider_crank() -> mbsd.Mechanism:
    """A spring turns it."""
    m = mbsd.Mechanism("slider_crank", gravity=(0.0, -9.81))
    a, b, slider = m.bar("a", 0.05, mass=0.2), m.bar("b", 0.15, mass=0.3), m.body("slider", mass=0.5)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, slider.origin)
    m.prismatic("guide", m.ground.at(0, 0.01), slider.origin)
    m.spring("s", m.ground.at(0.4, 0.0), slider.origin, 200.0, damping=3.0, free_length=0.1)
    m.start_near(a=60, b=-10)
    m.start_moving(a=20.0)
    return m


def six_bar() -> mbsd.Mechanism:
    """Two loops; all that is given at the start decides it."""
    m = mbsd.Mechanism("six_bar")
    a, b, c = m.bar("a", 0.04, mass=0.2), m.bar("b", 0.12, mass=0.3), m.bar("c", 0.09, mass=0.2)
    d, e = m.bar("d", 0.1, mass=0.1), m.bar("e", 0.09, mass=0.1)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.revolute("C", b.end, c.end)
    m.revolute("D", m.ground.at(0.12, 0), c.start)
    m.revolute("E", c.at(0.06, 0.02), d.start)
    m.revolute("F", d.end, e.end)
    m.revolute("G", m.ground.at(0.25, 0.02), e.start)
    m.spring("s", m.ground.at(0.05, 0.2), b.end, 300.0, damping=1.0, free_length=0.1)
    m.start_near(a=20, b=45, c=100, d=10, e=80)
    m.start_moving(a=30.0)
    return m


def driven() -> mbsd.Mechanism:
    """A link hangs on a crank that a driver turns."""
    m = mbsd.Mechanism("driven", gravity=(0.0, -9.81))
    a, b = m.bar("a", 0.1, mass=0.2), m.bar("b", 0.2, mass=0.3)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.drive_angle("motor", a, mbsd.constant_rate(10.0))
    m.torsion_spring("s", a, b, stiffness=0.1, damping=0.01)
    m.start_near(b=-90)
    return m


def swung() -> mbsd.Mechanism:
    """A link hangs on a crank that swings to and fro; no force acts but gravity."""
    m = mbsd.Mechanism("swung", gravity=(0.0, -9.81))
    a, b = m.bar("a", 0.1, mass=0.2), m.bar("b", 0.2, mass=0.3)
    m.revolute("A", m.ground.at(0, 0), a.start)
    m.revolute("B", a.end, b.start)
    m.drive_angle("motor", a, mbsd.harmonic(0.4, 9.0, phase=0.3))
    m.start_near(b=-80)
    return m


def noted_ways(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The ways to tangents that come to an end, as they are gone."""
    ways: list[str] = []
    for name in ("_in_independent_coordinates", "_between_looks", "_at_nodes"):
        own = getattr(simulations.SimulationTangents, name)

        def noted(self: object, edges: np.ndarray, own: Callable = own, name: str = name) -> object:
            made = own(self, edges)
            ways.append(name)
            return made

        monkeypatch.setattr(simulations.SimulationTangents, name, noted)
    return ways


@pytest.mark.parametrize(
    ("make", "numbers"),
    [
        (links, ["a.length", "b.mass", "c.inertia", "s.stiffness", "gravity.y", "a.moving.omega", "c.start.angle"]),
        (slider_crank, ["a.length", "b.length", "guide.y", "slider.mass", "s.damping", "gravity.y", "a.start.angle"]),
        (driven, ["a.length", "b.length", "motor.rate", "b.mass", "s.stiffness", "A.x"]),
        (swung, ["motor.amplitude", "motor.rate", "motor.phase", "a.length", "b.mass", "gravity.y"]),
    ],
)
def test_they_are_those_in_reference_coordinates(
    make: Callable[[], mbsd.Mechanism], numbers: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    of = ["b.x", "b.theta", "b.omega", "A.fx", "B.fy"]
    ways = noted_ways(monkeypatch)
    mine = make().sensitivities(of, numbers, 0.8, 30)
    monkeypatch.setattr(simulations, "suits", lambda ready: None)
    others = make().sensitivities(of, numbers, 0.8, 30)
    monkeypatch.setattr(simulations, "CLOSE", -1.0)
    simulated = make().sensitivities(of, numbers, 0.8, 30)
    assert sorted(set(ways)) == ["_at_nodes", "_between_looks", "_in_independent_coordinates"]
    for label in of:
        for k in range(len(numbers)):
            size = np.abs(simulated[label][:, k]).max()
            least = 1e-9 * np.abs(simulated[label]).max()
            for made in (mine, others):
                assert np.allclose(made[label][:, k], simulated[label][:, k], rtol=0.0, atol=5e-6 * size + least), (
                    numbers[k]
                )


BODIES = ["gravity.x", "gravity.y", "a.mass", "a.length", "b.com.x", "b.com.y", "b.inertia", "P.x", "P.y"]


@pytest.mark.parametrize(
    ("make", "numbers"),
    [
        (links, [*BODIES, "B.j.y", "s.stiffness", "s.j.x", "a.start.angle", "c.moving.omega"]),
        (six_bar, [*BODIES, "E.i.y", "F.j.x", "G.x", "s.damping", "s.i.y", "a.start.angle", "a.moving.omega"]),
        (driven, [*BODIES, "motor.rate", "A.y", "s.free_angle", "b.start.angle"]),
    ],
)
@pytest.mark.parametrize("accelerations", [False, True])
def test_how_bodies_move_is_read_along_the_tangents(
    make: Callable[[], mbsd.Mechanism], numbers: list[str], accelerations: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    of = {"x": "b.x", "turn": "b.theta", "traced turn": "P.theta", "speed": "P.vy", "energy": "kinetic"}
    of |= {"end": final("P.x"), "some": samples("b.omega", [0.2, 0.4]), "all": integral("b.vy")}
    of |= {"push": "P.ay", "largest": integral("b.alpha")} if accelerations else {}
    m = make()
    m.trace("P", m.bodies["b"].at(0.05, 0.02, angle=30))
    ways = noted_ways(monkeypatch)
    mine = m.sensitivities(of, numbers, 0.4, 12, tolerance=1e-11)
    monkeypatch.setattr(simulations, "suits", lambda ready: None)
    others = m.sensitivities(of, numbers, 0.4, 12, tolerance=1e-11)
    assert list(dict.fromkeys(ways)) == ["_in_independent_coordinates", "_between_looks"]
    for label in of:
        assert mine[label].shape == others[label].shape
        for k in range(len(numbers)):
            least = 1e-8 * np.abs(others[label]).max()
            size = np.abs(others[label][..., k]).max()
            assert np.allclose(mine[label][..., k], others[label][..., k], rtol=0.0, atol=1e-5 * size + least), (
                label, numbers[k],
            )  # fmt: skip


def test_a_start_that_least_energy_decides_is_packed_number_by_number(monkeypatch: pytest.MonkeyPatch) -> None:
    m = links()
    m.start_moving(a=3.0)  # b and c move as little as they can, which their masses decide
    m.velocities.pop("b")
    m.velocities.pop("c")
    straight: list[bool] = []
    own = near_numbers.NearNumbers.of

    def noted(self: near_numbers.NearNumbers, number: Number) -> near_numbers.Near | None:
        near = own(self, number)
        straight.append(near is not None)
        return near

    monkeypatch.setattr(near_numbers.NearNumbers, "of", noted)
    check_derivatives(m, ["b.theta", "c.omega"], ["c.mass", "s.stiffness", "a.length", "a.moving.omega"], 0.3, 10)
    assert straight == [False, True, False, False]


def test_a_number_that_cannot_grow_is_taken_from_below() -> None:
    m = mbsd.Mechanism("pendulum")
    rod = m.bar("rod", 0.3, mass=0.5)
    m.revolute("A", m.ground.at(0, 0), rod.start)
    m.start_near(rod=10)

    @dataclass(frozen=True)
    class AtMost:
        """Stands for a model that refuses a larger mass."""

        most: float

        def __call__(self, model: Any, value: float) -> None:
            if value > self.most:
                raise mbsd.ModelError("too heavy")
            model.change("rod", mass=value)

    m.torsion_spring("s", m.ground, rod, stiffness=2.0, damping=0.05)
    number = Number("rod.mass", 0.5, AtMost(0.5))
    grid = np.linspace(0.0, 0.5, 11)
    tangents = simulation_tangents(m, grid, [number], 1e-11, ["rod.theta"])
    plain = m.sensitivities(["rod.theta"], ["rod.mass"], 0.5, 10, tolerance=1e-11)
    assert np.abs(plain["rod.theta"]).max() > 1e-2
    assert np.allclose(tangents.slopes["rod.theta"], plain["rod.theta"], rtol=1e-6, atol=1e-9)
