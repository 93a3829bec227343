"""The guard of numbers: it finds a last digit, and a few of its runs are as recorded."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np

from tools.numbers.digest import attempt, digest
from tools.numbers.runs import driven_four_bar

ROOT = Path(__file__).resolve().parents[2]


def test_one_last_digit_of_one_number_is_found() -> None:
    solution = driven_four_bar().sweep(steps=12)
    before = digest(solution)
    assert before == digest(driven_four_bar().sweep(steps=12))
    solution.lam[3, 5] = np.nextafter(solution.lam[3, 5], np.inf)
    assert digest(solution) != before


def test_an_error_counts_as_a_result() -> None:
    assert attempt(lambda: driven_four_bar().sweep(steps=0)) == attempt(lambda: driven_four_bar().sweep(steps=0))
    assert attempt(lambda: driven_four_bar().sweep(steps=0)) != attempt(lambda: driven_four_bar().batch())


def test_runs_are_as_recorded() -> None:
    command = [sys.executable, "-m", "tools.numbers", "check", "force spring_law"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "0 of 1 differ" in done.stdout
