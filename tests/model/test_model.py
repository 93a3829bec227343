"""Models: bodies and markers, numbers of connections, and warnings that are raised once."""

from __future__ import annotations

import math
import sys
import warnings
from types import SimpleNamespace
from typing import Any

import pytest

import mbsd.base.warning
from mbsd import Mechanism, ModelError, constant_rate, harmonic
from mbsd.base.errors import ModelWarning
from mbsd.base.warning import PACKAGE
from mbsd.model.joint import JointKind
from mbsd.model.mechanism import connections
from mbsd.numbers.names import known_numbers, number_named
from mbsd.testing import force_kinds, joint_kinds
from mbsd.testing.forces import example as of_force
from mbsd.testing.joints import example as of_joint

# Models that cannot be are refused when they are built, by name.


def _two_bars() -> Mechanism:
    m = Mechanism("pair")
    m.bar("a", 1.0)
    m.bar("b", 2.0)
    return m


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (lambda m: m.bar("a", 1.0), "two of the name 'a'"),
        (lambda m: m.body("", 1.0), "needs a name"),
        (lambda m: m.bar("c", 0.0), "length 0 m; it must be positive"),
        (lambda m: m.bar("c", math.nan), "length is nan"),
        (lambda m: m.bar("c", "long"), "must be a number"),
        (lambda m: m.body("c", mass=-1.0), "'c' has mass -1 kg; it cannot be negative"),
        (lambda m: m.body("c", mass=1e-170), "'c' has mass 1e-170 kg; give 0, or 1e-100 kg or more"),
        (lambda m: m.body("c", mass=1.0, inertia=1e-120), r"'c' has inertia 1e-120 kg m\^2; give 0, or 1e-100"),
        (lambda m: m.body("c", inertia=-1.0), "inertia -1 kg m"),
        (lambda m: m.body("c", com=(math.inf, 0)), r"com of body 'c' \(m\) is inf; it must be finite"),
        (lambda m: m.body("c", com=(1, 2, 3)), r"com of body 'c' \(m\) is \(1, 2, 3\); it must be two numbers"),
        (lambda m: m.body("c", com=0.5), r"com of body 'c' \(m\) is 0.5; it must be two numbers"),
        (lambda m: m.body("c", com=("a", 0)), "com of body 'c' .* must be a number"),
        (lambda m: m.body("c", mass=True), "pair: body 'c': mass is True; it must be a number"),
        (lambda m: m.body("c", mass=1 + 2j), r"body 'c': mass is \(1\+2j\); it must be a number"),
        (lambda m: m.bar("c", 1.0, mass="heavy"), "bar 'c': mass is 'heavy'; it must be a number"),
        (lambda m: m.bar("c", 1.0, mass=math.nan), "bar 'c': mass is nan"),
        (lambda m: m.bar("c", 1.0, mass=1.0, inertia=math.nan), "inertia is nan"),
        (lambda m: m.bar(" c", 1.0), "a body needs a name without spaces around it, got ' c'"),
        (lambda m: m.bar("a\nb", 1.0), "needs a name"),
        (lambda m: m.bar(7, 1.0), "pair: bar: name is 7; it must be a text"),
        (lambda m: m.set_mass("a", math.nan, (0, 0), 1.0), "set_mass 'a': mass is nan"),
        (
            lambda m: m.trace("P", m.ground),
            r"trace 'P': marker is the body 'ground'; it must be a marker, .* write ground\.at\(x, y\)",
        ),
        (lambda m: m.start_near(a=None), "start of 'a' is None; give degrees"),
        (lambda m: m.start_near(a="90"), "start of 'a' is '90'; give degrees"),
        (lambda m: m.start_near(a=True), "start of 'a' is True; it must be a number"),
        (lambda m: Mechanism("x", gravity=9.81), r"gravity \(m/s\^2\) is 9.81; it must be two numbers"),
        (lambda m: m.known_body("z"), "no body 'z'; there is: ground, a, b"),
        (lambda m: m.ground.at(math.nan, 0), "ground.at: x is nan"),
        (lambda m: m.ground.end, "'ground' is no bar"),
        (lambda m: m.revolute("A", m.bodies["a"].start, m.bodies["a"].end), "connects 'a' with itself"),
        (lambda m: m.revolute("A", m.ground.at(0, 0), Mechanism("x").bar("q", 1).end), "'q' of another mechanism"),
        (
            lambda m: m.revolute("A", m.ground, m.bodies["a"].start),
            r"'A': i is the body 'ground'; it must be a marker.*\(name, i, j, limits\)",
        ),
        (lambda m: m.distance("D", m.bodies["a"].end, m.bodies["b"].end, 0.0), "length 0 m"),
        (lambda m: m.drive_angle("motor", m.bodies["a"], 3.0), "needs a motion law"),
        (lambda m: m.drive_angle("motor", "z", constant_rate(1)), "driver 'motor': there is no body 'z'; there is"),
        (lambda m: m.trace("P", Mechanism("x").bar("q", 1).end), "another mechanism"),
        (lambda m: m.start_near(z=3), "no body 'z'"),
        (lambda m: m.start_near(a=(1, 2)), r"give degrees, or \(x, y, degrees\)"),
        (lambda m: m.start_moving(a="fast"), r"start velocity of 'a' is 'fast'; give rad/s, or \(vx, vy, omega\)"),
        (lambda m: m.start_moving(a=None), "start velocity of 'a' is None"),
        (lambda m: m.sweep(steps=0), "steps is 0"),
        (lambda m: m.sweep(duration=-1.0), "duration is -1.0 s"),
        (lambda m: m.sweep(times=[0.0, 0.0]), "rising"),
        (lambda m: Mechanism("x", gravity=(0, math.nan)), r"gravity \(m/s\^2\) is nan"),
        (lambda m: Mechanism(""), "needs a name"),
        (lambda m: Mechanism("empty").sweep(duration=1.0), "no body beside ground"),
    ],
)
def test_refused(build, says: str) -> None:
    with pytest.raises(ModelError, match=says):
        build(_two_bars())


def test_a_refused_body_leaves_nothing_behind() -> None:
    m = _two_bars()
    with pytest.raises(ModelError):
        m.body("c", mass=-1)
    assert list(m.bodies) == ["ground", "a", "b"]


def test_a_uniform_rod_needs_its_mass_only() -> None:
    rod = Mechanism("rod").bar("rod", 0.6, mass=2.0)
    assert rod.com == (0.3, 0.0)
    assert rod.inertia == pytest.approx(2.0 * 0.36 / 12)


# Numbers of a model by name: every name that a thing is said to have is one.


@pytest.mark.parametrize("kind", [*joint_kinds(), *force_kinds()], ids=lambda kind: kind.name)
def test_every_number_that_an_example_lists_is_found(kind: Any) -> None:
    m = of_joint(kind) if isinstance(kind, JointKind) else of_force(kind)[0]
    for table in connections(m):
        for name in table:
            for key in known_numbers(m, name):
                assert isinstance(number_named(m, f"{name}.{key}").value, float)


def test_a_number_of_a_law_with_the_name_of_an_argument_is_reached_through_it() -> None:
    m = Mechanism("turning frame")
    m.body("bob", mass=1.0)
    m.rotating_frame("frame", harmonic(2.0, 3.0), (0.3, -0.4))
    assert number_named(m, "frame.rate.rate").value == 3.0
    with pytest.raises(ModelError, match=r"rate\.rate"):
        number_named(m, "frame.rate")
    m.change("frame", rate=0.5)
    assert number_named(m, "frame.rate").value == 0.5


# Warnings point at the user's line on every Python.


DEEP = "def finds(warn):\n    warn('off', ModelWarning)\ndef asked(warn):\n    finds(warn)\n"


@pytest.mark.parametrize("version", [(3, 11), (3, 12)])
def test_a_warning_names_the_file_outside_the_package(
    monkeypatch: pytest.MonkeyPatch, version: tuple[int, int]
) -> None:
    names: dict[str, Any] = {"ModelWarning": ModelWarning}
    exec(compile(DEEP, f"{PACKAGE[0]}found.py", "exec"), names)
    monkeypatch.setattr(mbsd.base.warning, "sys", SimpleNamespace(version_info=version, _getframe=sys._getframe))
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        names["asked"](mbsd.base.warning.warn)
    assert [(warning.filename, str(warning.message)) for warning in told] == [(__file__, "off")]
