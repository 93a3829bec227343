"""Parts of full size are made for a model only where masses of these decide how it moves."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from mbsd import Mechanism, constant_rate
from mechanisms.stages.loading import loading
from mechanisms.stages.parts.automatic_solids import needs_machine, needs_masses
from mechanisms.stages.solve import solving
from shared.stage.errors import UserError


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


def test_what_is_refused_is_left_to_the_machines_own_stage(monkeypatch: pytest.MonkeyPatch) -> None:
    def refused(*_: object) -> None:
        raise UserError("no")

    monkeypatch.setattr(loading, "load", refused)
    assert needs_machine("bar")
    assert needs_masses("bar")
