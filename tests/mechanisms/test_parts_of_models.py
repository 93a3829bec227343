"""Parts of models at a scale and of simulations, and how bodies are dressed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import cadquery as cq
import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.automatic import automatic
from mechanisms.stages.loading import loading
from mechanisms.stages.parts import automatic_solids
from mechanisms.stages.parts.automatic_solids import needs_machine, needs_masses
from mechanisms.stages.parts.bodies import described_body
from mechanisms.stages.solve import masses, solving
from mechanisms.stages.solve.masses import bare_solution
from shared.shapes.bodies import Bodies
from shared.shapes.solid import Solid
from shared.shapes.workpieces import CUP, TEA, block, crate, pen, prism, sheet, standing
from shared.stage.errors import UserError

# Parts of full size are made for a model only where masses of these decide how it moves.


def bar(driven: bool, mass: float | None) -> Mechanism:
    m = Mechanism("bar")
    body = m.bar("bar", 0.1) if mass is None else m.bar("bar", 0.1, mass=mass)
    m.revolute("A", m.ground.at(0, 0), body.start)
    if driven:
        m.drive_angle("motor", body, constant_rate(1.0))
    else:
        m.start_near(bar=30)
    return m


@pytest.mark.parametrize(
    ("driven", "mass", "own_motion", "needs"),
    [
        (True, None, False, False),
        (True, 1.0, False, False),
        (False, 1.0, False, False),
        (False, None, False, True),
        (True, None, True, True),
        (False, 1.0, True, False),
    ],
)
def test_only_a_simulation_without_masses_needs_the_machine(
    driven: bool, mass: float | None, own_motion: bool, needs: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    module = SimpleNamespace(**({"motion": None} if own_motion else {}))
    monkeypatch.setattr(loading, "load", lambda *_: module)
    monkeypatch.setattr(loading, "params", lambda _: None)
    monkeypatch.setattr(solving, "build", lambda *_: bar(driven, mass))
    assert needs_machine("bar") is needs
    assert needs_masses("bar") is (mass is None)


def test_refused_parts_are_left_to_the_stage_at_full_size(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise UserError("no")

    monkeypatch.setattr(loading, "load", refused)
    assert needs_machine("bar")
    assert needs_masses("bar")


# Parts of a simulated mechanism fit the motion that it has with their own masses.


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

    def build_parts(m: Mechanism, solution: Any) -> Any:
        side = sides[min(len(asked), len(sides)) - 1]
        cube = [Solid("arm", cq.Workplane().box(side, side, side), "steel", 0)]
        solids = lambda: {"ground": cube, "arm": cube}  # noqa: E731
        return SimpleNamespace(solids=solids, shown=solids)

    monkeypatch.setattr(automatic_solids, "bare_solution", solved)
    monkeypatch.setattr(automatic, "automatic", build_parts)
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


# What a machine works on is in its parts, and weighs nothing.


def bar_dressing() -> Solid:
    return Solid("bar_dressing", cq.Workplane().box(60.0, 10.0, 5.0), "steel", 0)


def load() -> Solid:
    return Solid("load", block((0.0, 5.1, 20.0, 40.0), 0.0, 12.0), "steel", 0)


def test_a_load_is_a_piece_of_no_mass() -> None:
    plain, made = Bodies(arm=[bar_dressing()]), Bodies(arm=[bar_dressing()])
    made.dress("arm", load())
    alone, dressed = (described_body("m", "arm", bodies["arm"], {}, None) for bodies in (plain, made))
    assert dressed.mass == alone.mass
    assert dressed.pieces["load"].dressing
    assert not dressed.pieces["bar_dressing"].dressing
    assert dressed.pieces["load"].mass.mass > 0.05  # it is there: it is printed and listed with its own mass
    appended = described_body("m", "arm", [bar_dressing(), load()], {}, None)
    assert appended.mass.mass == pytest.approx(alone.mass.mass + dressed.pieces["load"].mass.mass)


def test_statements_survive_a_union() -> None:
    made = Bodies(arm=[bar_dressing()])
    made.dress("arm", load())
    assert [solid.dressing for solid in (made | {"ground": [bar_dressing()]})["arm"]] == [False, True]


def test_a_load_is_no_main_piece() -> None:
    with pytest.raises(UserError, match=r"dress\('leg'\).*arm"):
        Bodies(arm=[bar_dressing()]).dress("leg", load())


def test_workpieces_are_sound() -> None:
    shapes = [
        ("block", block((0, 0, 30, 20), 0.0, 9.0), 0),
        ("crate", crate((0, 0, 120, 90), 1.0, 50.0), 0),
        ("sheet", sheet((0, 0, 80, 60), 0.0), 0),
        ("pen", pen(0.4, 20.0, 3.0), 0),
        ("prism", prism([(0, 0), (10, 0), (4, 8)], 0.0, 6.0, 0.5), 0),
        ("cup", standing(CUP, 5.0, 6.0, 30.0, 12.0), 0),
        ("tea", standing(TEA, 5.0, 6.0, 30.0, 12.0), 0),
    ]
    solids = [Solid(name, shape, "steel", holes) for name, shape, holes in shapes]
    described = described_body("m", "all", solids, {}, None)  # refuses what is not one closed solid of so many holes
    assert set(described.pieces) == {name for name, _, _ in shapes}


def test_a_cup_stands_up_in_the_plane_with_tea_inside() -> None:
    cup, tea = (standing(profile, 5.0, 6.0, 30.0, 12.0).val() for profile in (CUP, TEA))
    box = cup.BoundingBox()
    assert (box.ymin, box.ymax) == pytest.approx((6.0, 24.0), abs=1e-3)
    assert ((box.xmin + box.xmax) / 2, (box.zmin + box.zmax) / 2) == pytest.approx((5.0, 30.0), abs=1e-2)
    assert cup.intersect(tea).Volume() == pytest.approx(0.0, abs=1e-6)
