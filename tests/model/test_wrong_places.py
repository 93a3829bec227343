"""Arguments at the wrong place, or of the wrong kind: the error names the argument, what it got, and the order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from mbsd import Mechanism, ModelError, constant_rate, curve
from mbsd.model.change import Role, arguments
from mbsd.model.joint import CONTACT_KINDS
from mbsd.testing import force_kinds, joint_kinds


@pytest.fixture
def m() -> Mechanism:
    out = Mechanism("m")
    bar = out.bar("bar", 0.5, 1.0)
    out.bar("other", 0.5, 1.0)
    out.body("block", 1.0)
    out.revolute("A", out.ground.origin, bar.start)
    return out


WRONG: list[tuple[Callable[[Any, Any, Any], object], str]] = [
    (lambda m, a, b: m.force("F", a, 3.0), r"force 'F': at is the body 'bar'; it must be a marker, a place on it: "
     r"write bar\.at\(x, y\), bar\.start or bar\.end; the arguments are \(name, at, force, direction, frame\)"),
    (lambda m, a, b: m.force("F", m.bodies["block"], 3.0), r"write block\.at\(x, y\); the"),
    (lambda m, a, b: m.force("F", 3.0, a.end), r"at is 3\.0; it must be a marker, a place on a body"),
    (lambda m, a, b: m.force("F", a.end, 3.0, frame=a.end), "frame is a marker on 'bar'; it must be a body: write bar"),
    (lambda m, a, b: m.revolute("B", a, b), r"revolute 'B': i is the body 'bar'; .* \(name, i, j, limits\)"),
    (lambda m, a, b: m.revolute(a.end, b.start), r"revolute: j is missing; the arguments are revolute\(name, i"),
    (lambda m, a, b: m.revolute("B", m.joints["A"], b.start), "i is <revolute 'A' between ground and bar>; it must be"),
    (lambda m, a, b: m.spring("S", a.end, 100.0, 0.1), r"spring 'S': j is 100\.0; it must be a marker"),
    (lambda m, a, b: m.spring("S", a.end, 100.0), r"stiffness is missing; the arguments are spring\(name, i, j, stiff"),
    (lambda m, a, b: m.torque("T", a.end, 1.0), r"body is a marker on 'bar'; .*\(name, body, torque, against\)"),
    (lambda m, a, b: m.drive_angle("d", m.joints["A"], constant_rate(1.0)), "body is <revolute 'A' .* m.ground"),
    (lambda m, a, b: m.drive_angle("d", "bat", constant_rate(1.0)), "no body 'bat', did you mean 'bar'"),
    (lambda m, a, b: m.motor("M", a.end, b.end, curve([0, 1], [1, 0])), "first is a marker on 'bar'"),
    (lambda m, a, b: m.user_force("u", lambda t, q, v: 0.0, a.end), "argument 3 is a marker on 'bar'"),
    (lambda m, a, b: m.trace("P", a), "marker is the body 'bar'"),
    (lambda m, a, b: m.trace("P", a, 0.1), r"trace takes 2 arguments at most, got 3; the arguments are trace\(name"),
    (lambda m, a, b: m.start_near(a, 30), r"start_near takes values by names alone: start_near\(bar=\.\.\.\)"),
]  # fmt: skip


@pytest.mark.parametrize(("call", "says"), WRONG)
def test_the_error_tells_what_belongs_there(m: Mechanism, call: Callable[..., object], says: str) -> None:
    with pytest.raises(ModelError, match=says):
        call(m, m.bodies["bar"], m.bodies["other"])
    assert len(m.joints) + len(m.forces) + len(m.drivers) + len(m.traces) == 1


@pytest.mark.parametrize("kind", [*joint_kinds(), *force_kinds(), *CONTACT_KINDS.values()], ids=lambda kind: kind.name)
def test_every_kind_tells_a_body_from_a_marker(m: Mechanism, kind: Any) -> None:
    for place, argument in enumerate(arguments(kind.add)):
        if argument.role not in (Role.MARKER, Role.BODY) or argument.several:
            continue
        bar, other = m.bodies["bar"], m.bodies["other"]
        given: list[Any] = []
        for k, before in enumerate(arguments(kind.add)[: place + 1]):
            right = {Role.MARKER: bar.end if k else other.end, Role.BODY: bar if k else other}
            wrong = {Role.MARKER: bar, Role.BODY: bar.end}
            given.append((wrong if k == place else right).get(before.role, 1.0))
        rest = {later.name: 1.0 for later in arguments(kind.add)[place + 1 :] if later.needed}
        with pytest.raises(ModelError, match=f"'x': {argument.name} is .*it must be a (marker|body)"):
            kind.add(m, "x", *given, **rest)
