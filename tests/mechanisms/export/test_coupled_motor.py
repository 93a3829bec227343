"""The example of docs/fmi.md: a DC motor's unit on the crank of an exported four-bar, against Eksergian's equation."""

from __future__ import annotations

import importlib.util
import platform
import shutil
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

from mechanisms.stages.export.fmu import fmu
from shared.stage.paths import ROOT
from tools.models import linkages

pytest.importorskip("fmpy")
pytestmark = pytest.mark.skipif(
    not shutil.which("cc") or platform.system() != "Linux", reason="the example is compiled as on Linux"
)
VOLTAGE, RESISTANCE, INDUCTANCE, CONSTANT = 12.0, 2.0, 4e-3, 0.05


def example() -> Any:
    spec = importlib.util.spec_from_file_location("couple", ROOT / "docs" / "fmi" / "couple.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def four_bar(driven: bool) -> Any:
    m = linkages.four_bar(0.12, 0.04, 0.12, 0.09)
    for name in ("crank", "coupler", "rocker"):
        m.change(name, mass=0.1, inertia=1e-4)
    if not driven:
        m.drivers.clear()
    return m


def monolithic(duration: float) -> tuple[float, float]:
    """Speed and current at the end of I(a) a'' + I'(a) a'^2 / 2 + V'(a) = k i with L i' = u - R i - k a'.

    I and V over a turn of the crank come from the kinetic and potential energy of a sweep at 2 pi rad/s.
    """
    sol = four_bar(True).sweep(1.0, steps=720)
    turn = 2 * np.pi * sol.t
    inertia = 2.0 * sol.energy.kinetic / (2 * np.pi) ** 2
    inertia[-1], potential = inertia[0], sol.energy.potential.copy()
    potential[-1] = potential[0]
    i, v = (CubicSpline(turn, values, bc_type="periodic") for values in (inertia, potential))

    def rates(_: float, y: np.ndarray) -> list[float]:
        angle, speed, current = y
        push = CONSTANT * current - 0.5 * i(angle, 1) * speed**2 - v(angle, 1)
        return [speed, push / i(angle), (VOLTAGE - RESISTANCE * current - CONSTANT * speed) / INDUCTANCE]

    end = solve_ivp(rates, (0.0, duration), [0.0, 0.0, 0.0], rtol=1e-10, atol=1e-10).y[:, -1]
    return float(end[1]), float(end[2])


def test_the_coupled_units_converge_to_the_equation_of_both(tmp_path: Path) -> None:
    m = four_bar(False)
    m.start_moving(crank=0.0)
    file = tmp_path / "four.fmu"
    file.write_bytes(fmu(m.simulate(0.4, steps=40))[0])
    speed, current = monolithic(0.4)
    errors = []
    for step in (1e-3, 5e-4, 2.5e-4):
        _, reached, flowing = example().coupled(file, "crank", 0.4, step)[-1]
        errors.append(abs(reached - speed) / speed)
        assert flowing == pytest.approx(current, abs=0.05)
    assert errors[2] < 4e-3
    for coarse, fine in pairwise(errors):
        assert 1.6 < coarse / fine < 2.8, "of first order in the step, as both wait for the other"


def test_a_crank_whose_driver_imposes_its_motion_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "four.fmu"
    file.write_bytes(fmu(four_bar(True).sweep(1.0, steps=40))[0])
    with pytest.raises(SystemExit, match=r"driver 'motor' imposes a motion, whatever torque acts on 'crank'"):
        example().coupled(file, "crank", 0.01, 1e-3)
