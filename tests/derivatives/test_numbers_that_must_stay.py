"""Numbers that would take wheels out of mesh or open joints are refused, wherever the machine stands."""

from __future__ import annotations

import math

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate
from mbsd.numbers.names import number_named, with_values


def machine(kind: str, driven: bool, turn: float = 0.0) -> Mechanism:
    """Two wheels on pins in a line that is turned (rad), or a pinion on a rail above its rack."""
    m = Mechanism(kind, gravity=None)
    first, second = m.body("first", 1.0, inertia=0.01), m.body("second", 2.0, inertia=0.05)

    def at(x: float, y: float) -> tuple[float, float]:
        return x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)

    m.revolute("A", m.ground.at(*at(0, 0)), first.origin)
    if kind == "rack_and_pinion":
        m.prismatic("B", m.ground.at(*at(0, -0.2), turn), second.origin)
        m.rack_and_pinion("mesh", second.origin, first.origin, radius=0.2)
    else:
        m.revolute("B", m.ground.at(*at(0.5, 0)), second.origin)
    if kind == "gear_pair":
        m.gear_pair("mesh", first.origin, second.origin, radius_i=0.2, radius_j=0.3)
    if kind == "geneva":
        m.geneva("mesh", first.origin, second.origin, slots=4, radius=0.5 * math.sin(math.pi / 4))
    m.start_near(first=math.degrees(turn) + 100.0, second=(*at(0, -0.2), math.degrees(turn)))
    if kind != "rack_and_pinion":
        m.start_near(second=math.degrees(turn) + (225.0 if kind == "geneva" else 20.0))
    if driven:
        m.drive_angle("motor", first, constant_rate(1.0, turn + math.radians(100.0)))
    else:
        m.start_moving(first=1.0)
    return m


@pytest.mark.parametrize("driven", [False, True])
@pytest.mark.parametrize("turn", [0.0, 1.0])
@pytest.mark.parametrize(
    ("kind", "number"),
    [("gear_pair", "B.x"), ("gear_pair", "A.x"), ("gear_pair", "mesh.x"), ("geneva", "A.x"), ("geneva", "mesh.radius"),
     ("rack_and_pinion", "B.y"), ("rack_and_pinion", "mesh.second.y")],
)  # fmt: skip
def test_places_that_go_together_are_refused_one_by_one(kind: str, number: str, turn: float, driven: bool) -> None:
    if number == "mesh.second.y":
        number = "second.mesh.y"
    with pytest.raises(ModelError, match=rf"no derivative by '{number}': by itself it takes {kind} 'mesh' out of mesh"):
        machine(kind, driven, turn).sensitivities("first.theta", number, 0.2, 4)


@pytest.mark.parametrize("driven", [False, True])
def test_across_the_line_of_centres_wheels_stay_in_mesh(driven: bool) -> None:
    m, t = machine("gear_pair", driven), np.linspace(0.0, 0.2, 5)
    number = number_named(m, "B.y")

    def moved(h: float) -> np.ndarray:
        other = with_values(m, [number], [number.value + h])
        return (other.sweep(times=t) if driven else other.simulate(times=t, tolerance=1e-12)).body("second").theta

    slope = (moved(1e-5) - moved(-1e-5)) / 2e-5
    assert np.allclose(m.sensitivities("second.theta", "B.y", times=t)["second.theta"][:, 0], slope, atol=1e-6)


@pytest.mark.parametrize("kind", ["gear_pair", "geneva", "rack_and_pinion"])
def test_other_numbers_have_derivatives(kind: str) -> None:
    m = machine(kind, driven=False)
    m.torsion_spring("spring", m.ground, m.bodies["first"], stiffness=1.0)
    numbers = ["first.inertia", "second.mass", "spring.stiffness", "first.start.angle"]
    assert np.isfinite(m.sensitivities("first.theta", numbers, 0.2, 4)["first.theta"]).all()


def carried(free: bool) -> Mechanism:
    """A plate on three equal bars, of which one repeats what the others do."""
    m = Mechanism("plate")
    plate = m.body("plate", mass=2.0, inertia=0.05)
    for k, (x, y) in enumerate([(0.0, 0.0), (0.2, 0.1), (0.5, 0.2)]):
        bar = m.bar(f"bar{k}", 0.4, mass=0.5)
        m.revolute(f"foot{k}", m.ground.at(x, y), bar.start)
        m.revolute(f"head{k}", plate.at(x, y), bar.end)
        m.start_near(**{f"bar{k}": -50})
    m.start_near(plate=(0.4 * math.cos(math.radians(-50)), 0.4 * math.sin(math.radians(-50)), 0))
    if not free:
        m.drive_angle("motor", m.bodies["bar0"], constant_rate(1.0, math.radians(-50)))
    return m


@pytest.mark.parametrize("free", [True, False])
def test_a_place_of_a_joint_that_repeats_others_is_refused(free: bool) -> None:
    with pytest.raises(ModelError, match=r"no derivative by 'head1.y': joints repeat others"):
        carried(free).sensitivities("plate.y", "head1.y", 0.2, 4)
    assert np.isfinite(carried(free).sensitivities("plate.y", "plate.mass", 0.2, 4)["plate.y"]).all()
