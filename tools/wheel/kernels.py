"""All kernels that models and methods use, compiled for a wheel."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.metadata import distribution
from pathlib import Path

from shared.stage.console import say
from shared.stage.errors import UserError
from shared.stage.paths import ROOT

PARTS = {
    "equations at addresses": """
import importlib, pkgutil, mbsd
for module in pkgutil.walk_packages(mbsd.__path__, "mbsd."):
    if not module.name.endswith("__main__"):
        importlib.import_module(module.name)
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


def compile_into(folder: Path, sources: Path, python: Path = Path(sys.executable)) -> None:
    """Compile the kernels of the package below ``sources`` with this Python and put them into ``folder``."""
    with tempfile.TemporaryDirectory() as cache:
        say("wheel", "compiling all kernels, which takes minutes")
        _run(python, ["-m", "mbsd", "compile"], sources, cache)
        for what, code in PARTS.items():
            say("wheel", f"compiling {what}")
            _run(python, ["-c", code], sources, cache)
        shutil.copytree(Path(cache) / "kernels", folder, ignore=shutil.ignore_patterns(".lock", "*.tmp.*"))


@contextmanager
def interpreter(version: str) -> Iterator[Path]:
    """Yield a Python of this version that has what the solver and its wheel need.

    It is ours where the version is ours.

    Raises UserError if uv finds no such Python, or its packages cannot be installed.
    """
    if version in ("", f"{sys.version_info.major}.{sys.version_info.minor}"):
        yield Path(sys.executable)
        return
    with tempfile.TemporaryDirectory(prefix="mbsd-wheel-") as folder:
        python = Path(folder) / "venv" / "bin" / "python"
        uv = _output(["sh", str(ROOT / "tools" / "find_uv.sh")], "uv is missing")
        _output(
            [uv, "venv", "--quiet", "--python", _installed(version), str(python.parent.parent)],
            f"there is no Python {version}",
        )
        packages = [f"numba=={distribution('numba').version}", "numpy", "scipy", "setuptools"]
        command = [uv, "pip", "install", "--quiet", "--python", str(python), *packages]
        _output(command, f"packages for Python {version} could not be installed")
        yield python


def _installed(version: str) -> str:
    """Return the path of a Python of this version that runs here.

    Where there is none, its version, for uv to fetch.
    """
    try:
        command = [f"python{version}", "-c", "import sys; print(sys.executable)"]
        return subprocess.run(command, check=True, capture_output=True, text=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return version


def _output(command: list[str], otherwise: str) -> str:
    """Return what a command prints. Raises UserError, which begins with ``otherwise``, if it fails."""
    run = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    if run.returncode != 0:
        raise UserError(f"wheel: {otherwise}: {' '.join(run.stderr.split())[-400:]}")
    return run.stdout.strip()


def _run(python: Path, arguments: list[str], sources: Path, cache: str) -> None:
    environment = os.environ | {"PYTHONPATH": str(sources), "NUMBA_CACHE_DIR": cache}
    run = subprocess.run([str(python), *arguments], cwd=sources, env=environment, capture_output=True, text=True)
    if run.returncode != 0:
        raise UserError(f"wheel: kernels could not be compiled: {run.stderr.strip()[-500:]}")
