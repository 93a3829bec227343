"""All kernels that models and methods use, compiled for a wheel."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from shared.stage.console import say
from shared.stage.errors import UserError

PARTS = {
    "equations at addresses": """
import importlib, pkgutil, mbsd
for module in pkgutil.walk_packages(mbsd.__path__, "mbsd."):
    if not module.name.endswith("__main__"):
        importlib.import_module(module.name)
""",
    "events and contacts": """
from mbsd import Mechanism
m = Mechanism("ball")
ball = m.body("ball", mass=0.2, inertia=1e-5)
m.rigid_contact("floor", m.ground.origin, ball.origin, radius=0.01)
m.start_near(ball=(0.0, 0.1, 0.0))
m.simulate(0.5)
""",
    "integrators": """
import importlib, pkgutil
import mbsd.dynamics.integrators as methods
for module in pkgutil.iter_modules(methods.__path__, methods.__name__ + "."):
    importlib.import_module(module.name)
from mbsd import Mechanism
from mbsd.dynamics.integrators.kind import INTEGRATORS
m = Mechanism("pendulum")
rod = m.bar("rod", 1.0, mass=1.0)
m.revolute("A", m.ground.at(0, 0), rod.start)
for name, method in INTEGRATORS.items():
    if method.package in ("", "scipy"):
        m.simulate(0.1, steps=4, method=name, **({"step": 0.01} if method.fixed_step else {}))
m.equilibrium()
m.modes()
""",
}
"""Beside what ``python -m mbsd compile`` compiles."""


def compile_into(folder: Path, sources: Path) -> None:
    """Compile the kernels of the package below ``sources`` and put them into ``folder``."""
    with tempfile.TemporaryDirectory() as cache:
        say("wheel", "compiling all kernels, which takes minutes")
        _python(["-m", "mbsd", "compile"], sources, cache)
        for what, code in PARTS.items():
            say("wheel", f"compiling {what}")
            _python(["-c", code], sources, cache)
        shutil.copytree(Path(cache) / "kernels", folder, ignore=shutil.ignore_patterns(".lock", "*.tmp.*"))


def _python(arguments: list[str], sources: Path, cache: str) -> None:
    environment = os.environ | {"PYTHONPATH": str(sources), "NUMBA_CACHE_DIR": cache}
    done = subprocess.run([sys.executable, *arguments], cwd=sources, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        raise UserError(f"wheel: kernels could not be compiled: {done.stderr.strip()[-500:]}")
