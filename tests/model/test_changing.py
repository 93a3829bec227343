"""Numbers and laws changed between solutions: the next one has them, nothing is compiled or built anew."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numba.core import event

import mbsd
from mbsd import Mechanism, ModelError, constant_rate, harmonic


def oscillator(stiffness: float = 100.0) -> Mechanism:
    """A crank that turns by a spring, beside a driven one; both about the origin."""
    m = Mechanism("oscillator", gravity=None)
    block = m.body("block", 2.0, inertia=0.1)
    m.prismatic("rail", m.ground.origin, block.origin)
    m.spring("spring", m.ground.origin, block.origin, stiffness, free_length=1.0)
    m.force("push", block.origin, 0.0, direction=(1.0, 0.0))
    m.start_near(block=(1.1, 0, 0))
    return m


def end(m: Mechanism) -> float:
    return float(m.simulate(1.0, steps=10, tolerance=1e-11).body("block").x[-1])


def swing(stiffness: float, mass: float, amplitude: float = 0.1) -> float:
    return 1.0 + amplitude * math.cos(math.sqrt(stiffness / mass))


def test_the_next_solution_has_them_and_nothing_is_compiled() -> None:
    m = oscillator()
    assert end(m) == pytest.approx(swing(100.0, 2.0), abs=1e-8)
    with event.install_recorder("numba:compile") as compiled:
        m.change("spring", stiffness=50.0)
        assert end(m) == pytest.approx(swing(50.0, 2.0), abs=1e-8)
        m.change("block", mass=3.0)
        assert end(m) == pytest.approx(swing(50.0, 3.0), abs=1e-8)
        m.bodies["block"].mass = 1.0
        assert end(m) == pytest.approx(swing(50.0, 1.0), abs=1e-8)
        m.change("push", force=5.0)
        assert end(m) == pytest.approx(swing(50.0, 1.0, 0.0) + 0.1, abs=1e-8)
    assert not compiled.buffer
    assert m.bodies["block"].inertia == 0.1
    assert list(m.forces) == ["spring", "push"]


def test_laws_of_drivers_and_torques_are_changed() -> None:
    m = Mechanism("driven")
    crank = m.bar("crank", 0.1, mass=1.0)
    m.revolute("A", m.ground.origin, crank.start)
    m.drive_angle("motor", crank, constant_rate(2.0))
    assert m.sweep(1.0).body("crank").theta[-1] == pytest.approx(2.0)
    m.change("motor", law=harmonic(0.5, math.pi / 2))
    assert m.sweep(1.0).body("crank").theta[-1] == pytest.approx(0.5)
    m.change("A", limits=(None, 0.4))
    with pytest.raises(mbsd.LimitError, match="A"):
        m.sweep(1.0)


@pytest.mark.parametrize(
    ("name", "values", "says"),
    [
        ("spring", {"stiffness": -1.0}, "oscillator: force 'spring': stiffness is -1; it cannot be negative"),
        ("spring", {"damping": math.nan}, "damping is nan"),
        (
            "spring",
            {"rate": 3.0},
            "spring 'spring': there is no argument 'rate'; there is: stiffness, damping, free_length",
        ),
        ("block", {"mass": -2.0}, "body 'block' has mass -2 kg; it cannot be negative"),
        ("block", {"length": 2.0}, "body 'block': there is no argument 'length'; there is: mass, com, inertia"),
        ("rail", {"limits": (2.0, 1.0)}, "joint 'rail': limits are 2 .. 1; the lower must be below the upper"),
        (
            "engine",
            {"mass": 1.0},
            "no body, joint, driver, force or contact 'engine'; there is: rail, spring, push, block",
        ),
        ("ground", {"mass": 1.0}, "no body, joint, driver, force or contact 'ground'"),
    ],
)
def test_invalid_changes_are_refused_and_nothing_changes(name: str, values: dict, says: str) -> None:
    m = oscillator()
    before = m.forces["spring"], m.joints["rail"], m.bodies["block"].mass, list(m.forces)
    with pytest.raises(ModelError, match=says):
        m.change(name, **values)
    assert (m.forces["spring"], m.joints["rail"], m.bodies["block"].mass, list(m.forces)) == before


@pytest.mark.parametrize(
    ("field", "value", "says"),
    [
        ("mass", -1.0, "oscillator: body 'block' has mass -1 kg; it cannot be negative"),
        ("mass", math.nan, "oscillator: mass of body 'block' is nan; it must be finite"),
        ("inertia", -0.1, "inertia -0.1 kg m"),
        ("inertia", "big", "inertia of body 'block' is 'big'; it must be a number"),
        ("com", (0.0, math.inf), r"com of body 'block' \(m\) is inf"),
        ("name", "other", "oscillator: name of body 'block' is fixed"),
    ],
)
def test_a_body_takes_nothing_that_cannot_be(field: str, value: object, says: str) -> None:
    block = oscillator().bodies["block"]
    before = getattr(block, field)
    with pytest.raises(ModelError, match=says):
        setattr(block, field, value)
    assert getattr(block, field) == before


def test_a_length_of_a_bar_is_fixed_and_gravity_is_checked() -> None:
    m = Mechanism("bar")
    with pytest.raises(ModelError, match="bar: length of body 'a' is fixed; add another body"):
        m.bar("a", 1.0).length = 2.0
    with pytest.raises(ModelError, match=r"bar: gravity \(m/s\^2\) is nan"):
        m.gravity = (0.0, math.nan)
    m.gravity = None
    assert m.gravity == (0.0, 0.0)


def test_names_are_not_given_twice() -> None:
    m = oscillator()
    block = m.bodies["block"]
    with pytest.raises(ModelError, match="oscillator: there are two of the name 'spring'; the joint needs another"):
        m.revolute("spring", m.ground.origin, block.origin)
    m.rope("rope", m.ground.origin, block.origin, 2.0)
    with pytest.raises(ModelError, match="two of the name 'rope'; the force needs another"):
        m.spring("rope", m.ground.origin, block.origin, 1.0)
    with pytest.raises(ModelError, match="two of the name 'rope'; the driver needs another"):
        m.drive_angle("rope", block, constant_rate(1.0))


def test_a_copy_under_efforts_shares_no_events() -> None:
    m = oscillator()
    other = m.with_efforts(push=1.0)
    other.event("stop", lambda moment: moment.body("block").x - 0.5)
    other.rope("rope", m.ground.origin, m.bodies["block"].origin, 2.0)
    assert not m.events
    assert not m.contacts
    assert np.isfinite(end(m))
