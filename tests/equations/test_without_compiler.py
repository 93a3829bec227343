"""The kernels are plain Python too: the solver's tests pass with the compiler switched off."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
FILES = (
    "equations/test_joints.py",
    "kinematics/test_mobility.py",
    "kinematics/test_kinematics.py",
    "kinematics/test_dynamics.py",
    "published/test_reference.py",
    "model/test_user_constraint.py",
)


@pytest.mark.slow
def test_the_solver_passes_its_tests_without_numba() -> None:
    environment = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", "-p", "no:xdist"]
    files = [str(ROOT / "tests" / name) for name in FILES]
    run = subprocess.run([*command, *files], cwd=ROOT, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-2000:]
    assert "passed" in run.stdout


def test_compiled_and_plain_kernels_give_the_same_numbers() -> None:
    code = (
        "from tools.models.four_bars import model; import hashlib, numpy as np;"
        "s = model((4.0, 1.0, 3.5, 3.0), 2.0, {'rocker': (1.0, (1.0, 0.2), 0.3)}).sweep(steps=20);"
        "print(' '.join(f'{x:.9e}' for x in [*s.q[-1].ravel(), *s.a[7].ravel(), *s.lam[13]]))"
    )
    outputs = []
    for switch in ("0", "1"):
        environment = os.environ | {"NUMBA_DISABLE_JIT": switch, "PYTHONPATH": str(ROOT)}
        run = subprocess.run(
            [sys.executable, "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True, check=True
        )
        outputs.append([float(x) for x in run.stdout.split()])
    largest = max(map(abs, outputs[0]))
    assert max(abs(a - b) for a, b in zip(*outputs, strict=True)) < 1e-9 * largest
