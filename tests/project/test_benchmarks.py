"""The dynamics benchmarks pose their sources' problems to every code, and the stored settings keep the limits."""

from __future__ import annotations

import importlib
from pathlib import Path

import numpy as np
import pytest

from benchmarks import derivatives, machines, rows, synthesis, table
from benchmarks.dynamics import CODES, chain, n_four_bar, pins, squeezer
from benchmarks.dynamics.cases import BESIDE_PEERS, case
from benchmarks.dynamics.equations import Chain, Equations
from benchmarks.dynamics.settings import load
from benchmarks.machines import mbsd_code
from benchmarks.rows import Bar, Row

PACKAGES = {"exudyn": "exudyn", "mujoco": "mujoco", "sundials": "sksundae"}
QUICK = ("A01 pendulum", "A02 N=1", "A03 squeezer")
MARGIN = 3.0
"""Other machines round otherwise, and the cheapest settings lie close to the limits."""


def test_our_calls_solve_what_the_peers_calls_solve() -> None:
    from benchmarks.calls import BARS
    from benchmarks.calls.mbsd_code import calls

    errors = {call.problem: call.error(call.call()) for call in calls()}
    assert set(errors) == set(BARS)
    sweep, changed, simulation = errors.values()
    assert max(sweep, changed) < 1e-12
    assert 0.0 < simulation < 1e-5


def test_rows_are_written_whatever_their_numbers_are(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(rows, "out_root", lambda: tmp_path)
    error = np.float64(1e-9)
    every = [Row("gradient", "mbsd", "1", "", 1e-3, error, {"largest": error}, within_limits=error < 1e-6)]
    bars = [Bar("gradient, simulations", 4.0, np.float64(3.2), "", "", np.float64(3.2) <= 4.0, most=True)]
    rows.write(every, bars)
    assert rows.read() == (every, bars)


def test_the_error_of_a_call_sees_what_is_wrong() -> None:
    from benchmarks.calls import energy_drift, rocker_error
    from benchmarks.four_bar import ANGLES, exact

    assert rocker_error(ANGLES, exact(ANGLES)[1]) == 0.0
    assert rocker_error(ANGLES, exact(ANGLES)[1] + 1e-3) == pytest.approx(1e-3)
    angle = np.linspace(0.0, -np.pi, 50)
    speed = np.sqrt(3.0 * 9.81 * -np.sin(angle).clip(max=0.0))  # inertia l^2 / 3 of a rod of 1 m
    assert energy_drift(angle, speed) < 1e-12
    assert energy_drift(angle, 1.01 * speed) > 0.05


@pytest.mark.parametrize("name", BESIDE_PEERS)
def test_the_start_is_consistent(name: str) -> None:
    model = case(name).model
    assert pins.closure(model) < 1e-14
    if not all(solid.inertia for solid in model.solids):
        assert not model.start[1].any()  # the pendulum, at rest, which nobody solves in these coordinates
        return
    written = Equations(model)
    q, v = (part.ravel() for part in model.start)
    arms = written.arms(q)
    assert np.abs(written.residual(q, arms)).max() < 1e-14
    assert np.abs(written.jacobian(arms) @ v).max() < 1e-14


def test_the_squeezer_starts_with_the_published_accelerations() -> None:
    model = squeezer.model()
    q, v = (part.ravel() for part in model.start)
    accelerations = Equations(model).acceleration(q, v)[2::3]
    # beta'' and Theta'' at rest, of the Test Set for IVP Solvers.
    assert accelerations[0] == pytest.approx(14222.4439199541138705911625887, rel=1e-9)
    assert accelerations[1] - accelerations[0] == pytest.approx(-10666.8329399655854029433719415, rel=1e-9)


def test_the_four_bars_turn_as_published() -> None:
    """Place of the first rod's top at 10 s for N = 2: IFToMM's library, Exudyn's converged values."""
    angle = n_four_bar.exact_angle(2)
    assert (np.cos(angle), np.sin(angle)) == pytest.approx((0.3284581, 0.9445185), abs=1e-6)


def test_the_band_form_says_the_same_as_the_dense() -> None:
    model = case("A02 N=10").model
    dense, band = Equations(model), Chain(model)
    y = np.concatenate([part.ravel() for part in model.start])
    y = y + 0.01 * np.random.default_rng(3).normal(size=y.shape)
    assert band.projected_rates(0.0, y) == pytest.approx(dense.projected_rates(0.0, y), abs=1e-9)
    assert band.rates(0.0, y) == pytest.approx(dense.rates(0.0, y), abs=1e-9)
    assert band.project(y) == pytest.approx(dense.project(y), abs=1e-11)


@pytest.mark.parametrize("index", [1, 2])
def test_the_matrix_written_for_ida_is_the_derivative(index: int) -> None:
    from benchmarks.dynamics.dae import Dae

    dae = Dae(squeezer.model(), index, feedback=7.0)
    y, slope = dae.start()
    rng = np.random.default_rng(1)
    y, slope = (part + 0.01 * rng.normal(size=part.shape) for part in (y, slope))
    y[2 * dae.n + dae.m :] = 0.0
    rate, step = 3.0, 1e-6
    written, ahead, behind = np.zeros((dae.length, dae.length)), np.zeros(dae.length), np.zeros(dae.length)
    dae.fill_dense(0.0, y, slope, None, rate, written)
    for k in range(dae.length):
        moved = np.zeros(dae.length)
        moved[k] = step
        dae.residual(0.0, y + moved, slope + rate * moved, ahead)
        dae.residual(0.0, y - moved, slope - rate * moved, behind)
        assert written[:, k] == pytest.approx((ahead - behind) / (2 * step), abs=1e-8 * np.abs(written).max())


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
    rows = [
        Row("A03", "mbsd", "1", "tolerance 1", 0.001, 1e-6, {"angle (rad)": 1e-6}),
        Row("A03", "peer", "2", "step 1", 0.002, 1.0, {"angle (rad)": 1.0}, within_limits=False),
    ]
    bars = table.bars_table(rows, [Bar("A03", 50.0, 2.0, "peer", "step 1", met=False)])
    assert "| A03 | 1 ms | 50x | 2x | peer | step 1 | **no** |" in bars
    every = table.rows_table(rows)
    assert "| A03 | peer | 2 | 2 ms | 2 | angle (rad) 1.0e+00; **beyond the limits** | step 1 |" in every


@pytest.mark.parametrize("links", [1, 5])
def test_the_chains_equations_are_those_of_its_bars(links: int) -> None:
    """The written equations against the chain solved in reference coordinates."""
    from mbsd import Mechanism

    m = Mechanism("chain", gravity=(0.0, -chain.GRAVITY))
    above = m.ground.origin
    for k in range(links):
        link = m.bar(f"link{k}", chain.LENGTH, chain.MASS)
        m.revolute(f"pin{k}", above, link.start)
        m.start_near(**{link.name: np.degrees(chain.SLANT)})
        above = link.end
    sol = m.simulate(0.3, steps=2, tolerance=1e-10)
    wanted = chain.angles(links, 0.3)
    assert [sol.body(f"link{k}").theta[-1] for k in range(links)] == pytest.approx(wanted, abs=1e-7)


@pytest.mark.parametrize("problem", machines.PROBLEMS)
def test_our_machines_are_exact(problem: str) -> None:
    """Every machine within its limit, the sweeps to rounding."""
    fresh, error = mbsd_code.prepare(problem)
    assert error(fresh()()) < (machines.LIMITS[problem] if problem == machines.CONTACT else 1e-12)


def test_the_ball_comes_back() -> None:
    """Between bounces it is as high as it was let go from, less nothing."""
    tops = [machines.height(t) for t in np.linspace(0.8, 1.0, 20_001)]
    assert max(tops) == pytest.approx(machines.HEIGHT, abs=1e-6)
    assert machines.height(0.0) == machines.HEIGHT


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
