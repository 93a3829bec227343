"""The wheel as a user gets it: a new environment, pip, and a four-bar whose angles are known."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from shared.stage.errors import UserError

FOUR_BAR = """
import math
import numpy as np
from mbsd import Mechanism, constant_rate
m = Mechanism("four_bar")
crank, coupler, rocker = m.bar("crank", 0.04), m.bar("coupler", 0.12), m.bar("rocker", 0.09)
m.revolute("A", m.ground.at(0, 0), crank.start)
m.revolute("B", crank.end, coupler.start)
m.revolute("C", coupler.end, rocker.end)
m.revolute("D", m.ground.at(0.12, 0), rocker.start)
m.drive_angle("motor", crank, constant_rate(2 * math.pi))
m.start_near(crank=0, coupler=45, rocker=100)
sol = m.sweep()
r, c = sol.body("rocker").theta, sol.body("crank").theta
dx = 0.12 + 0.09 * np.cos(r) - 0.04 * np.cos(c)
dy = 0.09 * np.sin(r) - 0.04 * np.sin(c)
assert len(r) == 361 and abs(dx**2 + dy**2 - 0.12**2).max() < 1e-14
"""
"""The coupler's length, squared (m^2), must be what it is at every angle."""
SAID = """
import sys
from importlib.metadata import metadata
import mbsd
assert mbsd.__file__.startswith(sys.prefix), mbsd.__file__
print(metadata("mbsd")["Version"], metadata("mbsd")["License-Expression"], f"{np.degrees(np.ptp(r)):.2f}")
"""


def four_bar_in_a_new_environment(wheel: Path, folder: Path) -> str:
    """Install the wheel in ``folder`` and solve. Raises UserError where a step fails, with the last lines of it."""
    _run([sys.executable, "-m", "venv", str(folder)], "a new environment could not be made")
    pip = [str(folder / "bin" / "pip"), "--disable-pip-version-check"]
    _run([*pip, "install", "--quiet", str(wheel)], "pip could not install the wheel (a network is needed)")
    _run([*pip, "check"], "the installed packages do not fit each other")
    said = _run(
        [str(folder / "bin" / "python"), "-P", "-c", FOUR_BAR + SAID], "the four-bar could not be solved", folder
    )
    version, licence, swing = said.split()
    expected = wheel.name.split("-")[1]
    if version != expected:
        raise UserError(f"the installed package says {version}, its wheel {expected}")
    return f"mbsd {version} ({licence}) solves a four-bar whose rocker swings through {swing} degrees"


def _run(command: list[str], refusal: str, cwd: Path | None = None) -> str:
    away = ("PYTHONPATH", "NUMBA_CACHE_DIR", "NUMBA_DISABLE_JIT")
    environment = {name: value for name, value in os.environ.items() if name not in away}
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True)
    if done.returncode:
        raise UserError(f"{refusal}: {' '.join((done.stderr or done.stdout).split())[-600:]}")
    return done.stdout
