"""The dynamics benchmarks pose their sources' problems to every code, and the stored settings keep the limits."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest

from benchmarks import derivatives, machines, rows, synthesis
from benchmarks.dynamics import CODES, pins
from benchmarks.dynamics.cases import BESIDE_PEERS, case
from benchmarks.dynamics.settings import load
from benchmarks.machines import mbsd_code
from benchmarks.rows import Bar, Row

PACKAGES = {"exudyn": "exudyn", "mujoco": "mujoco", "sundials": "sksundae"}
QUICK = ("A01 pendulum", "A02 N=1", "A03 squeezer")
MARGIN = 3.0
"""Other machines round otherwise, and the cheapest settings lie close to the limits."""


def test_our_calls_solve_what_the_peers_calls_solve() -> None:
    from benchmarks.calls.measure import CODES, prepared

    errors = []
    for problem in CODES:
        run = prepared("mbsd", problem)
        errors += run.errors(run.fresh()()).values()
    assert max(errors[:3]) < 1e-12
    assert 0.0 < errors[3] < 1e-5


def test_rows_are_written_whatever_their_numbers_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows, "out_root", lambda: tmp_path)
    error = np.float64(1e-9)
    every = [Row("gradient", "mbsd", "1", "", 1e-3, error, {"largest": error}, within_limits=error < 1e-6)]
    bars = [Bar("gradient, simulations", 4.0, np.float64(3.2), "", "", np.float64(3.2) <= 4.0, most=True)]
    rows.write(every, bars)
    assert rows.read() == (every, bars)


def test_settings_are_of_known_codes_and_ours_are_complete() -> None:
    """A peer whose sweep has not been run yet has no row."""
    assert list(load()) == list(BESIDE_PEERS)
    for name, codes in load().items():
        assert set(codes) <= set(CODES)
        assert "mbsd" in codes, name


@pytest.mark.parametrize("code", CODES)
@pytest.mark.parametrize("name", QUICK)
def test_the_stored_settings_keep_the_limits(code: str, name: str) -> None:
    if code in PACKAGES:
        pytest.importorskip(PACKAGES[code])
    problem, stored = case(name), load()[name].get(code)
    if stored is None:
        assert code != "mbsd"
        return
    if not stored["met"]:
        assert problem.excess(stored["errors"]) > 1
        return
    module = importlib.import_module(f"benchmarks.dynamics.{code}_code")
    fresh, record = module.prepare(problem, stored["settings"])
    fresh()()
    assert problem.excess(problem.errors(record())) < MARGIN


def test_a_result_that_stops_early_or_leaves_its_branch_keeps_no_limit() -> None:
    problem = case("A02 N=1")
    poses, velocities = (part[None] for part in problem.model.start)
    short = pins.Record(np.array([0.0]), poses, velocities)
    assert problem.errors(short) == {"energy drift (J)": 0.0, "angle (rad)": float("inf")}
    turned = pins.Record(np.array([10.0]), poses, velocities)
    assert problem.excess(problem.errors(turned)) > 1


def test_the_table_says_what_was_missed() -> None:
    both = [
        Row("A03", "mbsd", "1", "tolerance 1", 0.001, 1e-6, {"angle (rad)": 1e-6}),
        Row("A03", "peer", "2", "step 1", 0.002, 1.0, {"angle (rad)": 1.0}, within_limits=False),
    ]
    bars = rows.bars_table(both, [Bar("A03", 50.0, 2.0, "peer", "step 1", met=False)])
    assert "| A03 | 1 ms | 50x | 2x | peer | step 1 | **no** |" in bars
    every = rows.rows_table(both)
    assert "| A03 | peer | 2 | 2 ms | 2 | angle (rad) 1.0e+00; **beyond the limits** | step 1 |" in every


@pytest.mark.parametrize("problem", machines.PROBLEMS)
def test_our_machines_are_exact(problem: str) -> None:
    """Every machine within its limit, the sweeps to rounding."""
    fresh, error = mbsd_code.prepare(problem)
    assert error(fresh()()) < (machines.LIMITS[problem] if problem == machines.CONTACT else 1e-12)


def test_our_synthesis_passes_through_its_points() -> None:
    fitted = synthesis._ours()
    assert synthesis.error(fitted) < synthesis.EXACT
    point = fitted.traces["P"]
    fitted.traces["P"] = point.body.at(point.x + 1e-3, point.y)
    assert synthesis.error(fitted) > 1e-4


def test_our_gradients_are_those_of_whole_motions() -> None:
    make, numbers, duration, measure = derivatives.PROBLEMS[derivatives.SWEEP]
    m, numbers = make(), numbers[1:4]
    gradient = m.sensitivities({"of": measure}, numbers, duration, derivatives.STEPS)["of"]
    assert derivatives.error(m, numbers, duration, measure, gradient) < 1e-6
    assert derivatives.error(m, numbers, duration, measure, 1.001 * gradient) > 5e-4
