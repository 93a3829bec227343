"""Bars and bodies whose lengths and masses are changed are those that would have been built with these numbers."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError
from mbsd.saving.document import build, document
from tests.model.test_changed_equals_fresh import state

BARS: list[dict[str, Any]] = [{}, {"mass": 2.0}, {"mass": 2.0, "inertia": 0.3}, {"com": (0.1, 0.05)}, {"mass": 0.0}]
BAR_CHANGES: list[dict[str, Any]] = [
    {"mass": 3.0},
    {"length": 0.7},
    {"length": 0.7, "mass": 1.5},
    {"com": (0.2, 0.0)},
    {"com": None, "inertia": None},
    {"inertia": 0.2, "mass": 4.0},
    {"mass": None},
]


def lever(**own: Any) -> Mechanism:
    m = Mechanism("lever")
    bar = m.bar("bar", **({"length": 0.5} | own))
    slider = m.body("slider", 1.0)
    m.revolute("A", m.ground.origin, bar.start)
    pin = m.revolute("B", bar.end, slider.origin)
    m.friction("F", pin, 0.2, radius=0.01)
    m.prismatic("guide", m.ground.at(0, 0.1), slider.origin)
    m.spring("S", m.ground.at(1, 1), bar.end, 10.0)
    m.force("push", bar.end, 3.0, direction=1.0, frame=bar)
    m.rope("R", m.ground.at(0, 1), bar.end, 2.0)
    m.trace("tip", bar.end)
    m.trace("middle", bar.at(0.2, 0.1))
    return m


@pytest.mark.parametrize("own", BARS)
@pytest.mark.parametrize("values", BAR_CHANGES)
@pytest.mark.parametrize("loaded", [False, True])
def test_bars(own: dict[str, Any], values: dict[str, Any], loaded: bool) -> None:
    m = build(document(lever(**own)), Mechanism) if loaded else lever(**own)
    m.change("bar", **values)
    fresh = lever(**own | values)
    assert state(m) == state(fresh)
    assert [(k.x, k.y) for k in m.traces.values()] == [(k.x, k.y) for k in fresh.traces.values()]
    bar, other = m.bodies["bar"], fresh.bodies["bar"]
    assert (bar.mass_given, bar.derived, bar.length) == (other.mass_given, other.derived, other.length)


def test_bodies_of_other_shapes() -> None:
    def disc(**own: Any) -> Mechanism:
        m = Mechanism("disc")
        m.body("disc", **own)
        return m

    m = disc(mass=1.0, com=(0.1, 0.0), inertia=0.2)
    m.change("disc", mass=None, com=(0.0, 0.3))
    assert state(m) == state(disc(com=(0.0, 0.3), inertia=0.2))
    assert not m.bodies["disc"].mass_given
    m.change("disc", mass=0.0)
    assert m.bodies["disc"].mass_given


def test_the_mass_of_a_bar_set_as_an_attribute_brings_its_inertia() -> None:
    m = lever(mass=1.0)
    m.bodies["bar"].mass = 3.0
    assert state(m)[:2] == state(lever(mass=3.0))[:2]
    m.bodies["bar"].inertia = 0.5
    m.bodies["bar"].mass = 1.0
    assert m.bodies["bar"].inertia == 0.5


def test_a_length_that_cannot_be_changes_nothing() -> None:
    m = lever(mass=1.0)
    before = state(m)
    for values in ({"length": -1.0}, {"length": 0.7, "mass": -1.0}, {"length": None}, {"long": 1.0}):
        with pytest.raises(ModelError, match="lever"):
            m.change("bar", **values)
        assert state(m) == before


def test_a_solution_stays_what_it_was_when_a_length_changes() -> None:
    m = Mechanism("pendulum")
    rod = m.bar("rod", 0.5, 1.0)
    m.revolute("A", m.ground.origin, rod.end)
    m.trace("P", rod.end)
    sol = m.simulate(0.1, steps=3)
    before = sol.point("P").x.copy(), sol.joint("A").x.copy()
    m.change("rod", length=0.7)
    assert np.array_equal(sol.point("P").x, before[0])
    assert np.array_equal(sol.joint("A").x, before[1])
