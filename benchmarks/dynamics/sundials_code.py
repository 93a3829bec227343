"""SUNDIALS through scikit-sundae: IDA on M v' + J^T lam = Q, CVODE on the same solved for v'.

IDA holds the constraint as acceleration (index 1), or as velocity with positions pulled onto theirs (index 2 of Gear,
Gupta and Leimkuhler), or as acceleration with Baumgarte's feedback; its Newton matrix is written out by hand. CVODE may
take its rates at the projected state. The pendulum is its one angle.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from importlib import metadata
from typing import Any

import numpy as np
from sksundae.cvode import CVODE
from sksundae.ida import IDA

from benchmarks.dynamics.cases import Case
from benchmarks.dynamics.dae import Dae
from benchmarks.dynamics.equations import equations
from benchmarks.dynamics.pins import Record
from benchmarks.dynamics.scipy_code import angle
from benchmarks.dynamics.settings import tolerances

VERSION = f"{metadata.version('scikit-sundae')}"
MOST_STEPS = 20_000
MOST_EVALUATIONS = 60_000
"""Number of evaluations in one run, after which IDA gets no numbers and stops: it may creep for ever at a singular
pose."""
SAMPLES = 1000


def ladders(case: Case) -> Iterator[list[dict[str, Any]]]:
    """Settings to try, each ladder from cheap to exact."""
    if case.name.startswith("A01"):
        for solver in ("CVODE Adams", "CVODE BDF", "IDA"):
            yield [{"model": "angle", "solver": solver, "tolerance": tol} for tol in tolerances(1e-3, 1e-12, 4)]
        return
    small = len(case.model.pins) < 15
    # Without projection the swings leave their branch; the smallest problem shows it.
    for within in (True,) if len(case.model.pins) > 15 else (True, False):
        yield [
            {"model": "pins", "solver": "CVODE Adams", "projected rates": within, "tolerance": tol}
            for tol in tolerances(1e-3, 1e-11)
        ]
    for index, feedback in ((1, 100.0), (1, 20.0), (1, 0.0), (2, 0.0)):
        for linear in ("dense", "lapackdense") if small else ("sparse",):
            yield [
                {"model": "pins", "solver": "IDA", "index": index, "feedback": feedback, "linear": linear,
                 "tolerance": tol}
                for tol in tolerances(1e-4, 1e-10)
            ]  # fmt: skip


def prepare(case: Case, settings: dict[str, Any]) -> tuple[Callable[[], Callable[[], Any]], Callable[[], Record]]:
    """``fresh`` gives a run that starts anew, whose making is not timed; ``record`` what it computes."""
    solve, unpack = (_cvode if settings["solver"].startswith("CVODE") else _ida)(case, settings)
    ends = np.array([0.0, case.duration])

    def fresh() -> Callable[[], Any]:
        return lambda: solve(ends)

    def record() -> Record:
        solved = solve(np.linspace(0, case.duration, SAMPLES + 1))
        states = [unpack(y) for y in solved.y]
        return Record(np.array(solved.t), np.array([q for q, _ in states]), np.array([v for _, v in states]))

    return fresh, record


Solving = tuple[Callable[[np.ndarray], Any], Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]]


def _options(settings: dict[str, Any]) -> dict[str, Any]:
    tolerance = settings["tolerance"]
    return {"rtol": tolerance, "atol": tolerance, "max_num_steps": MOST_STEPS}


def _cvode(case: Case, settings: dict[str, Any]) -> Solving:
    if settings["model"] == "angle":
        start, rates, unpack = angle(case)
    else:
        written = equations(case.model)
        start, size = np.concatenate([part.ravel() for part in case.model.start]), written.size
        rates = written.projected_rates if settings["projected rates"] else written.rates

        def unpack(y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            y = written.project(y) if settings["projected rates"] else y
            return y[:size].reshape(-1, 3), y[size:].reshape(-1, 3)

    def fill(t: float, y: np.ndarray, yp: np.ndarray) -> None:
        yp[:] = rates(t, y)

    solver = CVODE(fill, method=settings["solver"].split()[1], **_options(settings))
    return lambda times: solver.solve(times, start), unpack


def _ida(case: Case, settings: dict[str, Any]) -> Solving:
    if settings["model"] == "angle":
        start, rates, unpack = angle(case)

        def residual(t: float, y: np.ndarray, yp: np.ndarray, res: np.ndarray) -> None:
            res[:] = yp - rates(t, y)

        solver = IDA(residual, **_options(settings))
        slope = np.array(rates(0.0, start))
        return lambda times: solver.solve(times, start, slope), unpack

    dae = Dae(case.model, settings["index"], settings["feedback"])
    sparse = settings["linear"] == "sparse"
    count = [0]

    def counted(t: float, y: np.ndarray, yp: np.ndarray, res: np.ndarray) -> None:
        count[0] += 1
        dae.residual(t, y, yp, res)
        if count[0] > MOST_EVALUATIONS:
            res[:] = np.nan

    solver = IDA(
        counted, jacfn=dae.fill_sparse if sparse else dae.fill_dense, algebraic_idx=dae.algebraic,
        linsolver=settings["linear"], **({"sparsity": dae.sparsity} if sparse else {}),
        **_options(settings) | {"atol": dae.tolerances(settings["tolerance"])},
    )  # fmt: skip
    start, slope = dae.start()

    def solve(times: np.ndarray) -> Any:
        count[0] = 0
        return solver.solve(times, start, slope)

    return solve, dae.unpack
