"""scipy: solve_ivp on the index-1 equations written by hand with numpy, Baumgarte's stabilisation where it helps."""

from __future__ import annotations

import itertools
import time

import numpy as np
import scipy
from scipy.integrate import solve_ivp

from benchmarks.dynamics.index1 import Index1
from benchmarks.dynamics.problems import Problem

VERSION = scipy.__version__


def _candidates(tolerances: tuple[float, ...], rates: tuple[float, ...], methods=("DOP853", "LSODA")) -> list[dict]:
    return [
        {"method": method, "rtol": tolerance, "stabilise": rate}
        for tolerance, rate, method in itertools.product(tolerances, rates, methods)
    ]


_LOOPS = _candidates((1e-4, 1e-6, 1e-8), (0.0, 5.0, 20.0), ("DOP853",))
CANDIDATES = {
    "A01": _candidates((1e-4, 1e-5, 1e-6, 1e-7), (0.0,)),
    "A02 N=1": _LOOPS,
    "A02 N=10": _LOOPS,
    "A02 N=40": [],
    "A03": _candidates((1e-4, 1e-5, 1e-6, 1e-7, 1e-8), (0.0,)),
}
"""N=40 takes minutes with dense matrices: not run."""


def run(problem: Problem, settings: dict, samples: int) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """See the package."""
    equations = Index1(problem.plain)
    n = equations.n
    start = np.concatenate([problem.plain.q.ravel(), problem.plain.v.ravel()])

    def rates(_: float, y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[n:], equations.accelerations(y[:n], y[n:], settings["stabilise"])])

    grid = np.linspace(0.0, problem.duration, samples)
    started = time.perf_counter()
    out = solve_ivp(
        rates, (0.0, problem.duration), start, settings["method"], t_eval=grid, rtol=settings["rtol"],
        atol=settings["rtol"] * 1e-2,
    )  # fmt: skip
    seconds = time.perf_counter() - started
    if out.status != 0:
        raise ArithmeticError(out.message)
    y = out.y.T.reshape(samples, 2, -1, 3)
    return seconds, out.t, y[:, 0], y[:, 1]
