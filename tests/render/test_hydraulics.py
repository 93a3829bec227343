"""Hydraulic cylinders in data.json, in the report and in the plots."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from mbsd import HydraulicView, Mechanism
from mechanisms.stages.solve.motion_file import to_motion
from render.plots import plots_of
from render.plots.figures import WHOLE
from render.report import report
from shared.contract import Motion, read_motion, write_motion


def press() -> Mechanism:
    m = Mechanism("press")
    table = m.body("table", 500.0, inertia=1.0)
    m.prismatic("rail", m.ground.at(0, 0, math.pi / 2), table.at(0, 0, math.pi / 2))
    m.hydraulic_cylinder(
        "ram", m.ground.origin, table.origin, bore=0.08, rod=0.05, stroke=0.5, retracted=0.6, supply=16e6,
        valve=lambda t: 0.3 * math.sin(3.0 * t), rated_flow=1e-3,
    )  # fmt: skip
    m.start_near(table=(0.0, 0.7, 0.0))
    return m


@cache
def motion() -> Motion:
    return to_motion(press().simulate(2.0, steps=100), None, "0" * 64, {}, {"table": "mechanism"})


def test_hydraulics_come_back_from_data_json(tmp_path: Path) -> None:
    write_motion(tmp_path / "data.json", motion())
    hydraulics = read_motion(tmp_path / "data.json").forces["ram"].hydraulics
    view = press().simulate(2.0, steps=100).force("ram")
    assert hydraulics is not None
    assert isinstance(view, HydraulicView)
    assert hydraulics.pressure_a == pytest.approx(view.pressure_a)
    assert hydraulics.supply_power == pytest.approx(view.supply_power)


def test_the_report_has_pressures_and_energy() -> None:
    hydraulics = motion().forces["ram"].hydraulics
    assert hydraulics is not None
    [row] = [line for line in report(motion(), None, None).splitlines() if line.startswith("| ram |")]
    assert f"to {max(hydraulics.pressure_a) / 1e6:.3g} MPa" in row
    assert f"{np.trapezoid(hydraulics.supply_power, motion().time) / 1e3:.3g} kJ" in row


def test_a_page_has_pressure_flow_and_power() -> None:
    assert "hydraulics" in plots_of(motion())
    pressures, flows, powers = WHOLE["hydraulics"](motion()).axes
    hydraulics = motion().forces["ram"].hydraulics
    assert hydraulics is not None
    assert pressures.lines[0].get_ydata() == pytest.approx(np.array(hydraulics.pressure_a) / 1e5)
    assert flows.lines[0].get_ydata() == pytest.approx(np.array(hydraulics.flow_a) * 6e4)
    assert powers.lines[0].get_ydata() == pytest.approx(np.array(hydraulics.supply_power))
