"""What the bank angle decides, against closed forms; the tables of docs/engines.md are what is computed."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from mbsd import ModelError, four_stroke
from mbsd.machines.engines.bank_angles import FAMILIES, bank_angles, gas_torque
from mbsd.machines.engines.engine import engine
from tools.documents.bank_angles import ANGLES, LAYOUTS, layout_table
from tools.documents.pages import between

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
