"""Signs of engines' cylinders and gas struts: true size, the crown at the piston, valves and ports that open."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import GasCycle, Mechanism, two_stroke
from mbsd.drawing.strokes import strokes_of
from tools.models.engines import BORE, ROD, THROW, petrol, slider_crank

TURN = 2 * math.pi
RATE = 200.0


def loads(cycle: GasCycle, degrees: float) -> list[np.ndarray]:
    """Lines of the cylinder with the crank so far past the firing, by rising order and length: (k, 2) each."""
    sol = slider_crank(cycle).sweep(2 * TURN / RATE, steps=144)
    [drawn] = strokes_of(sol, [round(degrees / 5)])
    return [stroke.points for stroke in drawn.strokes if stroke.ink == "load" and not stroke.closed]


def test_the_barrel_has_the_size_of_the_bore_and_its_head_is_where_the_clearance_ends() -> None:
    barrel, crown, *_ = loads(petrol(), 0.0)
    assert np.ptp(barrel[:, 0]) == pytest.approx(BORE)
    assert barrel[:, 1].max() == pytest.approx(THROW + ROD + 0.02 + 2 * THROW / 9)
    assert crown[:, 1] == pytest.approx([THROW + ROD + 0.02] * 2)


@pytest.mark.parametrize(
    ("degrees", "lifted"), [(0, (False, False)), (90, (False, False)), (270, (False, True)), (400, (True, False))]
)
def test_valves_are_lifted_while_they_are_open(degrees: float, lifted: tuple[bool, bool]) -> None:
    barrel, _, *valves = loads(petrol(exhaust_opens=math.radians(130.0)), degrees)
    head = barrel[:, 1].max()
    # the intake is drawn to the right of the axis that points down, which is on the left of the page
    assert len(valves) == 2
    assert {bool(head - valve[0, 1] > 1e-3) for valve in valves} == set(lifted)
    assert [bool(head - valve[0, 1] > 1e-3) for valve in valves] == list(lifted)


def test_a_port_lies_where_the_piston_opens_it() -> None:
    cycle = two_stroke(8.0, ports_open=math.radians(110.0), ports_close=math.radians(-110.0))
    _, _, closed = loads(cycle, 90.0)
    _, crown, _ = loads(cycle, 110.0)
    _, _, opened = loads(cycle, 180.0)
    assert closed[0, 1] == pytest.approx(crown[0, 1], abs=1e-9)
    assert np.ptp(opened[:, 0]) > 1.5 * np.ptp(closed[:, 0])


@pytest.mark.parametrize("hydraulic", [False, True])
def test_a_strut_has_a_barrel_on_its_first_point_and_a_piston_within(hydraulic: bool) -> None:
    m = Mechanism("strut", gravity=None)
    body = m.body("body", 1.0, inertia=1.0)
    m.prismatic("rail", m.ground.origin, body.origin)
    if hydraulic:
        m.hydraulic_cylinder("strut", m.ground.origin, body.origin, 0.08, 0.05, 0.2, 0.3, 2e7, rated_flow=1e-3)
    else:
        m.gas_strut("strut", m.ground.origin, body.origin, 400.0, 1.3, 0.5, 0.2)
    m.start_near(body=(0.45, 0, 0))
    [drawn] = strokes_of(m.simulate(0.01, steps=2), [0])
    lines = [stroke.points for stroke in drawn.strokes if stroke.ink == "load" and not stroke.closed]
    _, barrel, rod, piston = lines
    assert barrel[:, 0].max() == pytest.approx(0.3)
    assert rod[:, 0].max() == pytest.approx(0.45)
    assert barrel[:, 0].min() < piston[0, 0] < barrel[:, 0].max()
