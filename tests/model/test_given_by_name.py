"""Bodies, joints, forces and contacts are given themselves or by their names, with the same result."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate, curve, four_stroke


def linkage() -> Mechanism:
    m = Mechanism("linkage")
    crank, rod = m.bar("crank", 0.05, 0.2), m.bar("rod", 0.15, 0.3)
    slider = m.body("slider", 0.5, inertia=1e-4)
    m.revolute("O", m.ground.origin, crank.start)
    m.revolute("A", crank.end, rod.start)
    m.revolute("B", rod.end, slider.origin)
    m.prismatic("guide", m.ground.origin, slider.origin)
    m.start_near(crank=30, rod=-10)
    return m


def pick(table: str) -> Callable[[Mechanism, str, bool], Any]:
    return lambda m, name, by_name: name if by_name else getattr(m, table)[name]


BODY, JOINT = pick("bodies"), pick("joints")
ADDED: dict[str, Callable[[Mechanism, bool], object]] = {
    "drive_angle": lambda m, n: m.drive_angle("x", BODY(m, "crank", n), constant_rate(1.0)),
    "drive_relative_angle": lambda m, n: m.drive_relative_angle(
        "x", BODY(m, "crank", n), BODY(m, "rod", n), constant_rate(1.0)
    ),
    "torque": lambda m, n: m.torque("x", BODY(m, "crank", n), 1.0, against=BODY(m, "rod", n)),
    "force": lambda m, n: m.force("x", m.bodies["rod"].end, 1.0, frame=BODY(m, "crank", n)),
    "torsion_spring": lambda m, n: m.torsion_spring("x", BODY(m, "crank", n), BODY(m, "rod", n), 2.0),
    "torsion_spring_law": lambda m, n: m.torsion_spring_law(
        "x", BODY(m, "crank", n), BODY(m, "rod", n), lambda angle, rate: -2.0 * angle
    ),
    "motor": lambda m, n: m.motor("x", BODY(m, "ground", n), BODY(m, "crank", n), curve([0.0, 9.0], [1.0, 0.0])),
    "shaft": lambda m, n: m.shaft("x", BODY(m, "crank", n), BODY(m, "rod", n), 0.1, 0.01),
    "user_force": lambda m, n: m.user_force("x", lambda t, q, v: (0.0, 1.0, 0.0), BODY(m, "crank", n)),
    "gas_cycle": lambda m, n: m.gas_cycle(
        "x", m.ground.origin, m.bodies["slider"].origin, BODY(m, "crank", n), four_stroke(8.0), bore=0.08
    ),
    "friction": lambda m, n: m.friction("x", JOINT(m, "O", n), 0.1, radius=0.01),
    "stop": lambda m, n: m.stop("x", JOINT(m, "O", n), lower=-1.0),
    "one_way": lambda m, n: m.one_way("x", BODY(m, "ground", n), BODY(m, "crank", n)),
    "event": lambda m, n: m.event(
        "x", lambda t, q, v: q[2] - 9.0, frames=BODY(m, "crank", n), releases=JOINT(m, "O", n)
    ),
    "set_mass": lambda m, n: m.set_mass(BODY(m, "rod", n), 0.7, (0.1, 0.0), 0.001),
    "change": lambda m, n: m.change(BODY(m, "rod", n), mass=0.7),
    "change of a joint": lambda m, n: m.change(JOINT(m, "guide", n)),
}


@pytest.mark.parametrize("name", ADDED)
def test_a_name_is_as_good_as_the_object(name: str) -> None:
    given = []
    for by_name in (False, True):
        m = linkage()
        ADDED[name](m, by_name)
        given.append(m)
    first, second = given
    for table in ("joints", "drivers", "forces", "contacts"):
        ends = [
            {key: [(end.body.name, end.x, end.y, end.angle) for end in (part.i, part.j)] for key, part in parts.items()}
            for parts in (getattr(first, table), getattr(second, table))
        ]
        assert ends[0] == ends[1]
    assert [body.mass for body in first.bodies.values()] == [body.mass for body in second.bodies.values()]
    assert [event.releases for event in first.events.values()] == [event.releases for event in second.events.values()]


def test_analyses_take_forces_and_drivers_themselves() -> None:
    m = linkage()
    push = m.torque("push", "crank", 0.0)
    m.torsion_spring("hold", "ground", "crank", 50.0)
    assert np.array_equal(m.linearise(inputs=[push]).b, m.linearise(inputs="push").b)


def test_a_change_after_it_is_given_keeps_it() -> None:
    """``change`` puts another joint in its place; the old object still means it."""
    m = linkage()
    old = m.joints["O"]
    m.change("O", limits=(-9.0, 9.0))
    assert m.joints["O"] is not old
    m.stop("end", old, lower=-1.0)
    assert set(m.contacts) == {"end lower"}


@pytest.mark.parametrize(
    ("add", "says"),
    [
        (lambda m: m.stop("s", "Q", lower=0.0), "stop 's': there is no joint 'Q'"),
        (lambda m: m.stop("s", 3, lower=0.0), "stop 's' needs a joint, got 3"),
        (lambda m: m.stop("s", linkage().joints["O"], lower=0.0), "stop 's' uses joint 'O' of another"),
        (lambda m: m.friction("f", "Q", 0.1), "force 'f': there is no joint 'Q'"),
        (lambda m: m.one_way("c", "ground", "cranc"), "contact 'c': there is no body 'cranc', did you mean 'crank'"),
        (lambda m: m.torque("t", 3, 1.0), "it must be a body: .*, or its name"),
        (lambda m: m.change(m, mass=1.0), "no body, joint, driver, force or contact"),
    ],
)
def test_wrong_values_are_refused(add: Callable[[Any], object], says: str) -> None:
    with pytest.raises(ModelError, match=says):
        add(linkage())
