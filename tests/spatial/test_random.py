"""A few random mechanisms in space against Newton and Euler by numpy and scipy; `make hunt` takes 200."""

from __future__ import annotations

import numpy as np
import pytest

from tools.hunt_space.__main__ import DURATION, OUTPUTS, TOLERANCE, WITHIN, case
from tools.hunt_space.mechanisms import FAMILIES, random_mechanism
from tools.hunt_space.newton_euler import differences


@pytest.mark.parametrize("seed", range(6))
def test_random_mechanisms_obey_newton_and_euler(seed: int) -> None:
    result = case(seed)
    assert result["good"], result


def test_every_family_is_what_it_is_called() -> None:
    assert random_mechanism(3, "redundant").mobility().redundant_rows == 3
    assert random_mechanism(3, "open").mobility().redundant_rows == 0
    assert len(FAMILIES) == 3


@pytest.mark.filterwarnings("ignore::mbsd.base.errors.InitialConditionWarning")
def test_the_check_sees_a_wrong_mass() -> None:
    m = random_mechanism(5, "closed")
    sol = m.simulate(duration=DURATION, steps=OUTPUTS, tolerance=TOLERANCE)
    name = list(m.bodies)[1]
    m.change(name, mass=m.bodies[name].mass * 1.001, inertia=np.array(m.bodies[name].inertia) * 1.001)
    worst = differences(m, sol)
    assert max(worst["acceleration"], worst["reaction"]) > 10 * WITHIN["acceleration"]
