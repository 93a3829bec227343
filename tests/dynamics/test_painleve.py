"""Painleve's rod: rigid bodies with Coulomb's friction have no motion, and the error says from which friction on."""

from __future__ import annotations

import math
import re

import pytest

from mbsd import Mechanism, SimulationError


def rod(friction: float, degrees: float, speed: float, yields: bool = False) -> Mechanism:
    """A uniform rod of 2 m and 1 kg whose lower end slides on a table."""
    m = Mechanism("painleve")
    bar = m.bar("rod", 2.0, 1.0)
    m.set_mass("rod", 1.0, (1.0, 0.0), 1.0 / 3.0)
    if yields:
        m.contact("table", m.ground.origin, bar.start, 1e6, damping=0.5, friction=friction)
    else:
        m.rigid_contact("table", m.ground.origin, bar.start, friction=friction)
    m.start_near(rod=(0.0, 0.0, degrees))
    m.start_moving(rod=(speed, 0.0, 0.0))
    return m


def critical(degrees: float) -> float:
    """(1 + 3 cos^2) / (3 sin cos), Genot, Brogliato 1999, Eur. J. Mech. A 18, 653."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (1 + 3 * c * c) / abs(3 * s * c)


@pytest.mark.parametrize(("friction", "degrees", "speed"), [(2.0, 60.0, -3.0), (1.6, 60.0, -5.0), (2.0, 120.0, 3.0)])
def test_it_is_refused_with_its_friction_and_a_remedy_that_helps(friction, degrees, speed) -> None:
    with pytest.raises(SimulationError, match="Painleve's paradox") as error:
        rod(friction, degrees, speed).simulate(1.0, 20)
    said = str(error.value)
    assert "at t = 0 s contact 'table' jams" in said
    numbers = re.search(r"friction ([\d.]+) is above ([\d.]+)", said)
    assert numbers
    assert float(numbers[1]) == friction
    assert float(numbers[2]) == pytest.approx(critical(degrees), rel=1e-3)
    assert "m.contact(...)" in said
    sol = rod(friction, degrees, speed, yields=True).simulate(0.02, 20)
    assert sol.body("rod").theta[-1] != sol.body("rod").theta[0]


@pytest.mark.parametrize(("friction", "degrees", "speed"), [(1.2, 60.0, -3.0), (2.0, 60.0, 3.0), (1.0, 120.0, 3.0)])
def test_below_it_and_the_other_way_it_moves(friction, degrees, speed) -> None:
    assert rod(friction, degrees, speed).simulate(0.05, 10).t[-1] == 0.05
