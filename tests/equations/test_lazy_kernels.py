"""Kernels that are compiled when first called: not before, the same from the cache, and with errors that come out."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
KERNELS = """
from mbsd.compiling.jit import internal, kernel, lazy

@lazy(float)
def root(x, out):
    out[0] = 2.0 * x
    return x ** 0.5

@lazy(None)
def noted(out):
    out[1] = 7.0

@internal
def between(x, out):
    noted(out)
    return root(x, out)

@kernel
def value(x, out):
    if x > 1.0:
        return between(x, out)
    return 0.0

@lazy(int)
def wrong(x):
    return 0.5 * x

@kernel
def uses_wrong(x):
    return wrong(x)
"""
RUN = """
import numpy as np, kernels
out = np.zeros(2)
for x in (1.0, 4.0, 9.0):
    print(kernels.value(x, out), *out, len(kernels.root.kernel.overloads), len(kernels.noted.kernel.overloads))
print(sum(kernels.value.stats.cache_hits.values()), sum(kernels.root.kernel.stats.cache_hits.values()))
"""


def _run(folder: Path, code: str) -> subprocess.CompletedProcess[str]:
    (folder / "kernels.py").write_text(KERNELS)
    paths = os.pathsep.join([str(folder), str(ROOT)])
    variables = os.environ | {"PYTHONPATH": paths, "NUMBA_CACHE_DIR": str(folder / "kept")}
    return subprocess.run([sys.executable, "-c", code], env=variables, capture_output=True, text=True, check=False)


def test_a_kernel_is_compiled_when_first_called_and_read_from_the_cache_afterwards(tmp_path: Path) -> None:
    """Through a kernel whose code the caller contains, too."""
    for hits in (0, 1):
        done = _run(tmp_path, RUN)
        assert done.returncode == 0, done.stderr
        *values, cache = done.stdout.splitlines()
        assert values == ["0.0 0.0 0.0 0 0", "2.0 8.0 7.0 1 1", "3.0 18.0 7.0 1 1"]
        assert cache == f"{hits} {hits}"


def test_all_that_might_be_called_can_be_compiled_at_once(tmp_path: Path) -> None:
    code = """
        import numpy as np, kernels
        from mbsd.compiling.lazy_kernel import compile_all
        kernels.value(1.0, np.zeros(2))
        compile_all()
        print(len(kernels.root.kernel.overloads), len(kernels.noted.kernel.overloads))
    """
    done = _run(tmp_path, "\n".join(line.strip() for line in code.splitlines()))
    assert done.stdout.split() == ["1", "1"], done.stderr


def test_a_kernel_that_cannot_be_compiled_is_an_error(tmp_path: Path) -> None:
    done = _run(tmp_path, "import kernels\nkernels.uses_wrong(1.0)")
    assert "wrong returns float64" in done.stderr
    assert done.stderr.strip().endswith("RuntimeError: mbsd: a kernel could not be compiled")


def test_ctrl_c_while_one_is_compiled_comes_through_and_the_next_call_compiles_it(tmp_path: Path) -> None:
    code = """
import numpy as np, kernels
from mbsd.compiling.lazy_kernel import Cell
filled = Cell.fill
def interrupted(self):
    Cell.fill = filled
    raise KeyboardInterrupt
Cell.fill = interrupted
try:
    kernels.value(4.0, np.zeros(2))
except KeyboardInterrupt:
    print("interrupted", kernels.value(4.0, np.zeros(2)))
"""
    done = _run(tmp_path, code)
    assert done.stdout.split() == ["interrupted", "2.0"], done.stderr


USED = """
from mbsd import Mechanism
m = Mechanism("pendulum")
rod = m.bar("rod", 0.3, mass=0.2)
m.revolute("A", m.ground.origin, rod.start)
m.simulate(1.0, steps=20)
from mbsd.dynamics.independent import equations, groups
from mbsd.kinematics.groups.cases import PerCoordinate
from mbsd.kinematics.groups.kinds import rrp
from mbsd.dynamics import formulation
from mbsd.dynamics.reference import projection
from mbsd.dynamics.reference.arrays import Dynamics
from mbsd.equations.interactions.evaluation import apply
from mbsd.equations.loads import apply_user_forces
from mbsd.equations.relative.equation import relative_rows
from mbsd.dynamics.integrators.dop853 import crossing
unused = [
    formulation.derivative.kernel_of(Dynamics), projection.project, groups.bridge.kernel, equations.reduced.kernel,
    equations.write_alone,
    rrp.solve_rrp.kernel_of(PerCoordinate).kernel, relative_rows.kernel, apply_user_forces.kernel,
    crossing.crossing.kernel,
]
print([one.py_func.__name__ for one in unused if one.overloads], apply._wrapper_address is not None)
"""


def test_a_pendulum_waits_for_what_it_uses_alone() -> None:
    """Neither for reference coordinates, nor for groups, contacts and forces that it does not have."""
    variables = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, "-c", USED], env=variables, capture_output=True, text=True, check=False)
    assert done.stdout.strip() == "[] False", done.stdout + done.stderr
