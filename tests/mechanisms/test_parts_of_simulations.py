"""Parts of a simulated mechanism fit the motion that it has with their own masses."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import cadquery as cq
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic import automatic
from mechanisms.stages.loading import loading
from mechanisms.stages.parts import automatic_solids
from mechanisms.stages.solve import masses
from mechanisms.stages.solve.masses import bare_solution
from shared.shapes.solid import Solid


class _Author:
    """A pendulum as mechanism.py has it."""

    DURATION = 0.05

    def __init__(self, monkeypatch: pytest.MonkeyPatch, mass: float | None = None, driven: bool = False) -> None:
        self.mass, self.driven = mass, driven
        monkeypatch.setattr(loading, "load", lambda *_: self)
        monkeypatch.setattr(loading, "params", lambda _: None)

    def build(self, p: None) -> Mechanism:
        m = Mechanism("arm")
        arm = m.bar("arm", 0.3, mass=self.mass)
        m.revolute("A", m.ground.at(0, 0), arm.start)
        m.start_near(arm=-60)
        if self.driven:
            m.drive_angle("motor", arm, constant_rate(6.0))
        return m


def _recorded(monkeypatch: pytest.MonkeyPatch, sides: list[float]) -> list[dict[str, float] | None]:
    """The masses with which the motion is solved; parts are steel cubes of these sides (mm), one after another."""
    asked: list[dict[str, float] | None] = []

    def solved(name: str, masses: Any = None) -> Any:
        asked.append(None if masses is None else {body: mass.mass for body, mass in masses.items()})
        return bare_solution(name, masses)

    def made(m: Mechanism, solution: Any) -> Any:
        side = sides[min(len(asked), len(sides)) - 1]
        cube = [Solid("arm", cq.Workplane().box(side, side, side), "steel", 0)]
        return SimpleNamespace(solids=lambda: {"ground": cube, "arm": cube})

    monkeypatch.setattr(automatic_solids, "bare_solution", solved)
    monkeypatch.setattr(automatic, "automatic", made)
    return asked


def _cube(side: float) -> dict[str, Any]:
    return {"arm": pytest.approx(7850 * side**3 * 1e-9)}


def test_parts_are_made_again_until_they_fit_the_motion_with_their_masses(monkeypatch: pytest.MonkeyPatch) -> None:
    _Author(monkeypatch)
    asked = _recorded(monkeypatch, [10.0, 20.0, 20.0])
    solids = automatic_solids.solids_of("arm")
    assert asked == [None, _cube(10.0), _cube(20.0)]
    assert solids["arm"][0].shape.val().Volume() == pytest.approx(8000.0)


def test_parts_that_never_settle_end(monkeypatch: pytest.MonkeyPatch) -> None:
    _Author(monkeypatch)
    asked = _recorded(monkeypatch, [10.0, 11.0, 12.0, 13.0, 14.0, 15.0])
    automatic_solids.solids_of("arm")
    assert len(asked) == 1 + automatic_solids.ROUNDS


@pytest.mark.parametrize("given", [{"mass": 0.5}, {"driven": True}])
def test_where_masses_decide_nothing_parts_are_made_once(
    monkeypatch: pytest.MonkeyPatch, given: dict[str, Any]
) -> None:
    _Author(monkeypatch, **given)
    asked = _recorded(monkeypatch, [10.0])
    automatic_solids.solids_of("arm")
    assert asked == [None]


def test_given_masses_count_before_those_of_the_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    from mechanisms.stages.parts.meshes import mass_of

    mass = mass_of(cq.Workplane().box(10, 10, 10).val(), 7850.0)
    _Author(monkeypatch, mass=0.5)
    assert masses.bare_solution("arm", {"arm": mass}).mechanism.bodies["arm"].mass == 0.5
    _Author(monkeypatch)
    assert masses.bare_solution("arm", {"arm": mass}).mechanism.bodies["arm"].mass == pytest.approx(0.00785)
