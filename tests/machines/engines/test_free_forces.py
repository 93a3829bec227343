"""Free forces of engines and their bank angles, against published coefficients, closed forms and the solver."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from mbsd import Mechanism, ModelError, constant_rate, four_stroke
from mbsd.machines.engines.bank_angles import FAMILIES, bank_angles, gas_torque
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.free_forces import free_forces, piston_harmonics, rotating_forces
from mbsd.machines.engines.layout import INLINE_THROWS, Layout, boxer, even_split, fan, inline, layout, staggered, vee
from tools.documents.bank_angles import ANGLES, LAYOUTS, layout_table
from tools.documents.pages import between

CASE = json.loads((Path(__file__).parents[2] / "published/reference/engine_free_forces.json").read_text())
CROSS, FLAT = (0, 90, 270, 180), (0, 180, 180, 0)


@pytest.mark.parametrize("engine", CASE["engines"], ids=lambda engine: engine["engine"])
def test_coefficients_of_published_layouts(engine: dict) -> None:
    banks, throws, z = zip(*engine["bank_throw_z"], strict=True)
    of = layout(engine["engine"], banks, throws, z)
    forces, rotating = free_forces(of), rotating_forces(of)
    for name, free, row in [("rot", rotating, 0), *((str(n), forces, forces.index(n)) for n in (1, 2, 4, 6))]:
        for what, vector in (("force", free.force), ("couple", free.couple)):
            expected = engine[f"order_{name}"][what]
            got = [abs(vector.forward[row]), abs(vector.backward[row])]
            assert got == pytest.approx(expected, abs=CASE["tolerance"]), (name, what)


@pytest.mark.parametrize("ratio", CASE["piston_harmonics"]["ratio"])
def test_piston_harmonics(ratio: str) -> None:
    exact = {"0.3333": 1 / 3}.get(ratio, float(ratio))
    got = piston_harmonics(exact)
    for order, value in CASE["piston_harmonics"]["ratio"][ratio].items():
        assert got[int(order) - 1] == pytest.approx(value, abs=CASE["piston_harmonics"]["tolerance"])
    assert np.abs(got[[2, 4, 6]]).max() < 1e-12


@pytest.mark.parametrize(
    ("of", "order", "what", "largest", "smallest"),
    [
        (inline(INLINE_THROWS[3]), 1, "couple", math.sqrt(3), 0.0),
        (inline(INLINE_THROWS[4]), 2, "force", 4.0, 0.0),
        (inline(CROSS), 1, "couple", math.sqrt(10), 0.0),
        (inline(INLINE_THROWS[6]), 1, "couple", 0.0, 0.0),
        (vee(60, (0,)), 1, "force", 1.5, 0.5),
        (vee(45, (0,)), 1, "force", 1 + math.cos(math.pi / 4), 1 - math.cos(math.pi / 4)),
        (vee(90, (0,)), 2, "force", math.sqrt(2), 0.0),
        (vee(90, (0, 120, 240), even_split(90, 6)), 1, "couple", 1.5 * math.sqrt(2), math.sqrt(1.5)),
        (vee(60, (0, 120, 240), even_split(60, 6)), 1, "couple", 1.5, 1.5),
        (vee(90, FLAT), 2, "force", 4 * math.sqrt(2), 0.0),
        (vee(90, CROSS), 1, "couple", math.sqrt(10), math.sqrt(10)),
        (vee(90, CROSS), 2, "couple", 0.0, 0.0),
        (vee(90, CROSS), 4, "force", 4 * math.sqrt(2), 0.0),
        (vee(60, CROSS), 1, "couple", 1.5 * math.sqrt(10), 0.5 * math.sqrt(10)),
        (boxer((0, 180, 180, 0)), 2, "couple", 2.0, 0.0),
        (boxer((0, 180, 120, 300, 240, 60)), 1, "couple", 0.0, 0.0),
        (vee(45, INLINE_THROWS[6]), 2, "couple", 0.0, 0.0),
        (fan((0, 72, 144, 216, 288), (0,)), 1, "force", 2.5, 2.5),
    ],
)
def test_closed_forms(of: Layout, order: int, what: str, largest: float, smallest: float) -> None:
    free = free_forces(of)
    vector, row = getattr(free, what), free.index(order)
    assert vector.largest[row] == pytest.approx(largest, abs=1e-9)
    assert vector.smallest[row] == pytest.approx(smallest, abs=1e-9)


def test_a_ninety_degree_v_of_two_rods_on_one_pin_has_no_backward_first_order() -> None:
    backward = {angle: abs(free_forces(vee(angle, (0,))).force.backward[0]) for angle in range(0, 181, 5)}
    assert backward[90] < 1e-12
    assert min(size for angle, size in backward.items() if angle != 90) > 0.04


def test_a_narrow_v_of_six_throws_has_no_forces_of_the_first_orders() -> None:
    free = free_forces(staggered(10.6, INLINE_THROWS[6]))
    assert free.force.largest[:3] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(
    "of", [vee(60, (0,)), vee(72, (0, 200), 30.0), fan((-60, 0, 60), (0, 90))], ids=lambda of: of.name
)
def test_forces_are_those_of_the_solver(of: Layout) -> None:
    r, rod, mass, speed, offset = 0.04, 0.13, 0.5, 90.0, 0.006
    m = Mechanism("engine")
    m.gravity = None
    crank = m.body("crank")
    m.revolute("main", m.ground.origin, crank.origin)
    m.drive_angle("motor", crank, constant_rate(speed, math.pi / 2))
    poses: dict[str, float] = {"crank": 90.0}
    for k, cylinder in enumerate(of.cylinders):
        con, piston = m.bar(f"rod_{k}", rod), m.body(f"piston_{k}", mass=mass)
        m.revolute(f"pin_{k}", crank.at(r * math.cos(cylinder.throw), r * math.sin(cylinder.throw)), con.start)
        m.revolute(f"wrist_{k}", con.end, piston.origin)
        axis = math.pi / 2 + cylinder.bank
        m.prismatic(f"bore_{k}", m.ground.at(-offset * math.sin(axis), offset * math.cos(axis), axis), piston.origin)
        lean = math.asin((r * math.sin(cylinder.throw - cylinder.bank) - offset) / rod)
        poses[f"rod_{k}"] = math.degrees(axis - lean)
    m.start_near(**poses)
    sol = m.sweep(steps=360)
    got = sol.orders(sol.shaking().force, crank="crank")
    harmonics = piston_harmonics(r / rod, 6, offset / r)
    unit = mass * r * speed**2
    # The solver's shaft angle is the body's, a quarter ahead of the layout's; both count from where throw 0 points up.
    for order in (1, 2, 3, 4, 6):
        row, back = got.index(order), np.exp(1j * order * math.pi / 2)
        share = free_forces(of, None, (order,))
        size = harmonics[order - 1]
        assert got.forward[row] * back == pytest.approx(unit * size * share.force.forward[0], abs=1e-8 * unit)
        assert got.backward[row] / back == pytest.approx(
            unit * size.conjugate() * share.force.backward[0], abs=1e-8 * unit
        )


def test_bad_layouts_are_refused() -> None:
    with pytest.raises(ModelError, match="2 banks, 1 throw and 2 places"):
        layout("x", [0, 0], [0])
    with pytest.raises(ModelError, match="cylinder 2: bank is nan"):
        layout("x", [0, math.nan], [0, 0])
    with pytest.raises(ModelError, match="use a longer rod"):
        piston_harmonics(1.0)
    with pytest.raises(ModelError, match="at least one bank"):
        fan([], [0])


PAGE = (Path(__file__).resolve().parents[3] / "docs/engines.md").read_text()
OF = {family.name: family for family in FAMILIES}
CYCLE = four_stroke(10.0, heat_density=2e6)


@pytest.mark.parametrize("name", ["V2, one pin", "V8, cross crank"])
def test_counterweights_leave_the_backward_first_order(name: str) -> None:
    """|cos b| of one pin's two rods, times what the throws add."""
    compared = bank_angles(OF[name], angles=range(0, 181, 10))
    throws = {"V2, one pin": 1.0, "V8, cross crank": math.sqrt(10)}[name]
    left = compared.left(counterweights=True).rank(0)
    assert left == pytest.approx(throws * np.abs(np.cos(np.radians(compared.angle))), abs=1e-12)
    assert compared.best == 90
    assert "alone no first order turns against the shaft" in compared.reasons()[0]
    plain = compared.left().rank(0)
    assert plain == pytest.approx(throws * (1 + np.abs(np.cos(np.radians(compared.angle)))), abs=1e-12)


@pytest.mark.parametrize(
    ("name", "best", "words"),
    [
        ("V6, six pins, even", 60, "It fires evenly, every 120 degrees."),
        ("V6, three pins", 90, "It would fire evenly at 120 degrees."),
        ("V10, five pins", 90, "It would fire evenly at 72, 144 degrees."),
        ("V12", 60, "It has no first order at any angle."),
    ],
)
def test_the_best_angle_and_its_reason(name: str, best: float, words: str) -> None:
    compared = bank_angles(OF[name], angles=(36, 45, 60, 72, 90, 108, 120, 144))
    assert compared.best == best
    assert words in compared.reasons()


def test_shafts_take_their_order() -> None:
    compared = bank_angles(OF["V8, flat crank"], angles=(90,))
    assert compared.left().force[0, 1] > 1.0
    assert compared.left(shafts=(2,)).force[0, 1] == 0.0
    with pytest.raises(ModelError, match="shafts of order 3"):
        compared.left(shafts=(3,))


def test_the_torque_of_the_gas_is_the_sum_over_the_cylinders() -> None:
    """As the solver finds it for the whole engine."""
    compared = bank_angles(OF["V4, two pins"], cycle=CYCLE, angles=(90,))
    size = {"bore": 0.08, "stroke": 0.08, "rod": 0.04 / 0.28, "speed": 1.0}
    whole = engine("V4", angle=90, gas=CYCLE, order=compared.order[0], **size).sweep(duration=4 * math.pi, steps=1440)
    torque = -whole.driver("motor").effort
    assert compared.ripple is not None
    assert compared.ripple[0] == pytest.approx(np.ptp(torque) / torque[:-1].mean(), rel=2e-3)
    single = gas_torque(CYCLE, 0.28)
    assert torque[:-1].mean() == pytest.approx(4 * single.mean(), rel=1e-3)


def test_the_page_shows_the_table_of_layouts_and_all_families() -> None:
    shown = between(PAGE, *LAYOUTS)
    assert shown == f"\n{layout_table()}\n", "docs/engines.md shows something else: make study-engines"
    rows = between(PAGE, *ANGLES).strip().splitlines()[2:]
    assert [row.split(" | ")[0].removeprefix("| ") for row in rows] == [family.name for family in FAMILIES]
    for row, family in zip(rows, FAMILIES, strict=True):
        assert row.endswith(f"{' '.join(bank_angles(family, angles=range(0, 181, 6)).reasons())} |")
