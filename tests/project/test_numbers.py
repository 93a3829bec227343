"""The guard of numbers: it finds a last digit, and a few of its runs are as recorded."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np

from tools.numbers.contents import digest, outcome
from tools.numbers.kept import farthest, keep, kept, read
from tools.numbers.runs import driven_four_bar

ROOT = Path(__file__).resolve().parents[2]


def test_one_last_digit_of_one_number_is_found() -> None:
    solution = driven_four_bar().sweep(steps=12)
    before = digest(solution)
    assert before == digest(driven_four_bar().sweep(steps=12))
    solution.lam[3, 5] = np.nextafter(solution.lam[3, 5], np.inf)
    assert digest(solution) != before


def test_an_error_counts_as_a_result() -> None:
    assert digest(outcome(lambda: driven_four_bar().sweep(steps=0))) == digest(
        outcome(lambda: driven_four_bar().sweep(steps=0))
    )
    assert digest(outcome(lambda: driven_four_bar().sweep(steps=0))) != digest(
        outcome(lambda: driven_four_bar().batch())
    )


def test_runs_are_as_recorded() -> None:
    command = [sys.executable, "-m", "tools.numbers", "check", "force spring_law"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "0 of 1 differ" in done.stdout


def test_a_difference_is_measured_by_the_size_of_its_array() -> None:
    solution = driven_four_bar().sweep(steps=12)
    before = kept(solution)
    assert farthest(before, kept(solution)) == (0.0, "")
    top = np.abs(solution.lam).max()
    solution.lam[3, 5] += 1e-7 * top
    difference, where = farthest(before, kept(solution))
    assert 0.9e-7 < difference < 1.1e-7
    assert ".lam" in where
    solution.q[0, 1, 0] = np.nan
    assert farthest(before, kept(solution))[0] == np.inf


def test_numbers_in_texts_may_move_and_words_may_not() -> None:
    assert farthest(kept(("stops at 1.25 s",)), kept(("stops at 1.26 s",)))[0] < 0.01
    assert farthest(kept(("stops at 1.25 s",)), kept(("ends at 1.25 s",)))[0] == np.inf
    assert farthest(kept((3, 2.0)), kept((4, 2.0)))[0] == np.inf


def test_kept_numbers_are_read_again(tmp_path: Path) -> None:
    run = kept(driven_four_bar().sweep(steps=12))
    keep(tmp_path / "numbers", {"a": run})
    assert farthest(read(tmp_path / "numbers")["a"], run) == (0.0, "")
