"""Values held at a start do not depend on the axes of the world."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, constant_rate
from mbsd.measures import final


def railed(turn: float, place: complex = 0.3 + 0.1j, velocity: complex = 0.5 + 0.2j, slope: float = 0.7) -> Mechanism:
    """A block on a rail that rises by ``slope`` (rad), put and pushed beside it, with a rod; the world turned (rad)."""

    def turned(z: complex) -> tuple[float, float]:
        z *= complex(math.cos(turn), math.sin(turn))
        return z.real, z.imag

    gravity = turned(-9.81j)
    m = Mechanism("railed", gravity=gravity)
    block, rod = m.body("block", 1.0, inertia=0.01), m.bar("rod", 0.2, mass=0.5)
    m.prismatic("rail", m.ground.at(*turned(0.05 + 0.02j), turn + slope), block.origin)
    m.revolute("pin", block.at(0.01, 0.02), rod.start)
    m.start_near(block=(*turned(place), math.degrees(turn + slope)), rod=math.degrees(turn) - 60.0)
    m.start_moving(block=(*turned(velocity), 0.0), rod=1.0)
    return m


@pytest.mark.filterwarnings("ignore:.*start.*")
@pytest.mark.parametrize("turn", [0.9, -2.3])
def test_a_block_beside_its_rail_starts_where_it_is_nearest(turn: float) -> None:
    first, other = railed(0.0).simulate(0.2, steps=4), railed(turn).simulate(0.2, steps=4)
    z, there = (sol.body("block").x + 1j * sol.body("block").y for sol in (first, other))
    along = complex(math.cos(0.7), math.sin(0.7))
    start = 0.05 + 0.02j + along * ((0.3 + 0.1j - 0.05 - 0.02j) * along.conjugate()).real
    assert abs(z[0] - start) < 1e-12
    w = first.body("block").vx[0] + 1j * first.body("block").vy[0]
    assert abs(w - along * ((0.5 + 0.2j) * along.conjugate()).real) < 1e-12
    assert np.abs(there - z * complex(math.cos(turn), math.sin(turn))).max() < 1e-9


@pytest.mark.filterwarnings("ignore:.*start.*")
@pytest.mark.parametrize("beside", [0.0, 0.05])
def test_derivatives_by_the_place_of_a_rail_go_with_the_machine(beside: float) -> None:
    place = 0.05 + 0.02j + (0.2 + beside * 1j) * complex(math.cos(0.7), math.sin(0.7))
    rates: list[np.ndarray] = []
    for turn in (0.0, 0.9):
        s = railed(turn, place).sensitivities(["block.x", "block.y"], ["rail.x", "rail.y"], 0.2, 4)
        r = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
        rates.append(r.T @ np.stack([s["block.x"], s["block.y"]], axis=1) @ r)
    assert np.abs(rates[0] - rates[1]).max() < 1e-6
    along = np.array([math.cos(0.7), math.sin(0.7)])
    assert np.abs(rates[0][0] - (np.eye(2) - np.outer(along, along))).max() < 1e-8  # what is along the rail stays given


def test_rows_of_a_batch_are_held_as_single_starts_are() -> None:
    m, places = railed(0.0), np.array([[0.3, 0.1, 40.1], [0.2, 0.3, 40.1], [0.1, -0.1, 40.1]])
    slopes = np.array([0.6, 0.7, 0.8])
    vary, measure = {"rail": {"angle": slopes}}, {"x": final("block.x"), "y": final("block.y")}
    out = m.simulate_many(0.1, vary=vary, start={"block": places}, measure=measure, steps=2)
    for k, (x, y, _) in enumerate(places.tolist()):
        sol = railed(0.0, complex(x, y), slope=float(slopes[k])).simulate(0.1, steps=2)
        assert np.allclose([out["x"][k], out["y"][k]], [sol.body("block").x[-1], sol.body("block").y[-1]], atol=1e-7)


@pytest.mark.filterwarnings("ignore:.*start.*")
@pytest.mark.parametrize("turn", [0.9, -2.3])
def test_a_start_that_is_far_from_closing_turns_with_the_world(turn: float) -> None:
    def begun(turn: float) -> np.ndarray:
        c, s = math.cos(turn), math.sin(turn)
        m = Mechanism("apart", gravity=(0.0, 0.0))
        first, second = (m.body(name, 1.0, (0.1, 0.2), 0.1) for name in ("first", "second"))
        m.distance("tie", first.at(-0.12, -0.51), second.at(0.5, -0.18), length=0.7)
        (a, b), (d, e) = (-0.22, -0.36), (1.17, -0.53)
        m.start_near(
            first=(c * a - s * b, s * a + c * b, math.degrees(turn) - 36.0),
            second=(c * d - s * e, s * d + c * e, math.degrees(turn) + 28.0),
        )
        q = m.simulate(1e-6, steps=1).q[0, 1:]
        return np.column_stack([q[:, :2] @ np.array([[c, -s], [s, c]]), q[:, 2] - turn])

    assert np.abs(begun(turn) - begun(0.0)).max() < 1e-12


def test_a_sweep_holds_the_angles_of_wheels_whose_places_the_joints_correct() -> None:
    m = Mechanism("belted")
    wheels = [m.body(name, 1.0, (0.03, 0.02), 0.01) for name in ("small", "large")]
    for name, wheel, x in zip(("a", "b"), wheels, (0.0, 1.0), strict=True):
        m.revolute(name, m.ground.at(x, 0.0), wheel.origin)
    m.belt("belt", *(wheel.origin for wheel in wheels), radius_i=0.1, radius_j=0.2)
    m.drive_angle("motor", wheels[0], constant_rate(1.0))
    m.start_near(small=(0.0, 0.0, 0.0), large=(1.01, 0.02, 50.0))  # beside its shaft
    assert abs(m.sweep(times=[0.0]).body("large").theta[0] - math.radians(50.0)) < 1e-12
