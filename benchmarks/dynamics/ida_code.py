"""SUNDIALS IDA through scikit-sundae: equations by hand with numpy, of index 1 or stabilised (Gear, Gupta, Leimkuhler).

q' = v + J^T mu,   M v' = Q - J^T lam,   0 = Phi,   0 = J v
"""

from __future__ import annotations

import itertools
import time
from importlib import metadata

import numpy as np
from sksundae.ida import IDA

from benchmarks.dynamics.index1 import Index1
from benchmarks.dynamics.problems import Problem

VERSION = metadata.version("scikit-sundae")


def _candidates(tolerances: tuple[float, ...]) -> list[dict]:
    return [{"form": form, "rtol": rtol} for rtol, form in itertools.product(tolerances, ("index 1", "stabilised"))]


_LOOPS = _candidates((1e-4, 1e-5, 1e-6, 1e-7))
CANDIDATES = {
    "A01": _candidates((1e-5, 1e-6, 1e-7, 1e-8, 1e-9)),
    "A02 N=1": _LOOPS,
    "A02 N=10": _LOOPS,
    "A02 N=40": [],
    "A03": _candidates((1e-5, 1e-6, 1e-7, 1e-8, 1e-9)),
}
"""N=40 takes minutes with dense differences: not run."""


def run(problem: Problem, settings: dict, samples: int) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """See the package."""
    equations = Index1(problem.plain)
    n, m = equations.n, equations.m
    stabilised = settings["form"] == "stabilised"
    q, v = problem.plain.q.ravel(), problem.plain.v.ravel()
    _, jac = equations.constraints(q)
    acceleration = equations.accelerations(q, v)
    lam = np.linalg.lstsq(jac.T, equations.loads(q) - equations.inertia * acceleration, rcond=None)[0]
    y = np.concatenate([q, v, lam, np.zeros(m if stabilised else 0)])
    yp = np.concatenate([v, acceleration, np.zeros(len(y) - 2 * n)])

    def residual(_: float, y: np.ndarray, yp: np.ndarray, out: np.ndarray) -> None:
        q, v, lam = y[:n], y[n : 2 * n], y[2 * n : 2 * n + m]
        phi, jac = equations.constraints(q)
        out[:n] = yp[:n] - v
        out[n : 2 * n] = equations.inertia * yp[n : 2 * n] + jac.T @ lam - equations.loads(q)
        if stabilised:
            out[:n] -= jac.T @ y[2 * n + m :]
            out[2 * n : 2 * n + m] = jac @ v
            out[2 * n + m :] = phi
        else:
            out[2 * n :] = jac @ yp[n : 2 * n] - equations.gamma(q, v)

    solver = IDA(
        residual, rtol=settings["rtol"], atol=settings["rtol"] * 1e-2, max_num_steps=200_000,
        algebraic_idx=np.arange(2 * n, len(y)),
    )  # fmt: skip
    grid = np.linspace(0.0, problem.duration, samples)
    started = time.perf_counter()
    out = solver.solve(grid, y, yp)
    seconds = time.perf_counter() - started
    times, states = np.asarray(out.t), np.asarray(out.y)[:, : 2 * n]
    if not out.success or times[-1] < problem.duration * (1 - 1e-9):
        raise ArithmeticError(str(out.message))
    states = states.reshape(len(times), 2, -1, 3)  # every step of its own where two times are asked for
    return seconds, times, states[:, 0], states[:, 1]
