"""Tangents in independent coordinates are those of reference coordinates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

import mbsd
from mbsd.derivatives import simulations


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
    ways: list[str] = []
    for name in ("_in_independent_coordinates", "_between_looks", "_at_nodes"):
        own = getattr(simulations.SimulationTangents, name)

        def noted(self: object, edges: np.ndarray, own: Callable = own, name: str = name) -> object:
            made = own(self, edges)
            ways.append(name)
            return made

        monkeypatch.setattr(simulations.SimulationTangents, name, noted)
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
