"""Numbers of a model by name: every name that a thing is said to have is one."""

from __future__ import annotations

from typing import Any

import pytest

from mbsd import Mechanism, harmonic
from mbsd.base.errors import ModelError
from mbsd.model.joint import JointKind
from mbsd.model.mechanism import connections
from mbsd.numbers.names import known_numbers, number_named
from mbsd.testing import force_kinds, joint_kinds
from mbsd.testing.forces import example as of_force
from mbsd.testing.joints import example as of_joint


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
