"""Gas and oil in cylinders: in data.json, the report, indicator diagrams and plots."""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from mbsd import GasView, HydraulicView, Mechanism, constant_rate, harmonic
from mechanisms.stages.solve.motion_file import to_motion
from render.plots import plots_of
from render.plots.figures import WHOLE
from render.plots.pages.pressures import gas
from render.plots.style import apart
from render.report import report
from shared.contract import Motion, read_motion, write_motion
from shared.stage.errors import UserError
from tools.models.engines import slider_crank


def motion_of(m: Mechanism, **more) -> Motion:
    sources = {name: "mechanism" for name in m.bodies if name != "ground"}
    return to_motion(m.sweep(event_rows=True, **more), None, "0" * 64, {}, sources)  # pyright: ignore[reportArgumentType]


@cache
def engine() -> Motion:
    return motion_of(slider_crank(), steps=720)


def air_spring() -> Motion:
    m = Mechanism("air_spring", gravity=None)
    piston = m.body("piston", 1.0)
    m.prismatic("rail", m.ground.origin, piston.origin)
    m.gas("air", m.ground.at(-0.1, 0), piston.origin, area=1e-3, pressure=2e5, at=0.1)
    m.drive_coordinate("drive", m.ground.origin, piston.origin, harmonic(0.05, 10.0))
    return motion_of(m, steps=180)


def double_acting() -> Motion:
    """A piston with gas on both sides: two chambers that push one body."""
    m = Mechanism("double_acting", gravity=None)
    piston = m.body("piston", 1.0)
    m.prismatic("rail", m.ground.origin, piston.origin)
    m.gas("head", m.ground.at(-0.1, 0), piston.origin, area=1e-3, pressure=2e5, at=0.1)
    m.gas("crank_side", m.ground.at(0.1, 0, math.pi), piston.origin, area=8e-4, pressure=2e5, at=0.1)
    m.drive_coordinate("drive", m.ground.origin, piston.origin, harmonic(0.05, 10.0))
    return motion_of(m, steps=180)


def test_chambers_of_one_piston_have_colours_of_their_own() -> None:
    motion = double_acting()
    page = gas(motion)
    for axes in page.axes:
        inks = {line.get_label(): line.get_color() for line in axes.get_lines() if line.get_label() in motion.forces}
        assert set(inks) == {"head", "crank_side"}
        assert len(set(inks.values())) == 2
        assert motion.bodies["piston"].colour in inks.values()
    assert apart(["#111111"] * 3 + ["#222222"])[-1] == "#222222"
    assert len(set(apart(["#111111"] * 9))) == 9


def test_gas_comes_back_from_data_json(tmp_path: Path) -> None:
    motion = engine()
    write_motion(tmp_path / "data.json", motion)
    gas = read_motion(tmp_path / "data.json").forces["gas"].gas
    view = slider_crank().sweep(steps=720).force("gas")
    assert gas is not None
    assert isinstance(view, GasView)
    assert gas.indicated_work == pytest.approx(view.indicated_work)
    assert (gas.crank, gas.outside) == ("crank", 101325.0)
    assert max(gas.pressure) == pytest.approx(view.pressure.max())
    gas.crank = "cranc"
    write = motion.forces["gas"].gas
    assert write is not None
    write.crank = "cranc"
    with pytest.raises(UserError, match=r"forces\.gas\.gas\.crank names 'cranc'"):
        write_motion(tmp_path / "data.json", motion)
    write.crank = "crank"


def test_the_report_has_peak_work_and_mean_pressure() -> None:
    gas = engine().forces["gas"].gas
    assert gas is not None
    assert gas.indicated_work
    assert gas.displaced
    [row] = [line for line in report(engine(), None, None).splitlines() if line.startswith("| gas |") and "MPa" in line]
    cells = [cell.strip() for cell in row.split("|")]
    assert cells[2] == f"{max(gas.pressure) / 1e6:.3g} MPa"
    assert cells[6:9] == [
        "1",
        f"{gas.indicated_work[0]:.3g} J",
        f"{gas.indicated_work[0] / gas.displaced / 1e6:.3g} MPa",
    ]
    air = report(air_spring(), None, None)
    assert "| air | 492 kPa |" in air
    assert "after the top" not in air


def test_the_indicator_diagram_encloses_the_work() -> None:
    motion = engine()
    gas = motion.forces["gas"].gas
    assert gas is not None
    assert gas.indicated_work
    assert "gas" in plots_of(motion)
    left, right = WHOLE["gas"](motion).axes
    volume, pressure = (np.asarray(part, float) for part in left.lines[0].get_data())
    area = 0.1 * float(np.trapezoid(np.append(pressure, pressure[0]), np.append(volume, volume[0])))  # bar cm^3
    assert area == pytest.approx(gas.indicated_work[0], rel=2e-3)
    assert right.get_xlim() == (-360.0, 360.0)
    angle, height = (np.concatenate([np.asarray(line.get_data()[k], float) for line in right.lines]) for k in (0, 1))
    assert 10.0 < angle[height.argmax()] < 25.0


def test_gas_without_a_cycle_is_drawn_over_time_and_other_motions_have_no_page() -> None:
    _, right = WHOLE["gas"](air_spring()).axes
    assert right.get_xlabel() == "time / s"
    m = Mechanism("turning")
    bar = m.bar("bar", 0.1, 1.0)
    m.revolute("pin", m.ground.origin, bar.start)
    m.drive_angle("motor", bar, constant_rate(2 * math.pi))
    assert "gas" not in plots_of(motion_of(m, steps=12))


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
