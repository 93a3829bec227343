"""mbsd: DOP853 with projection, tolerance as found by the search."""

from __future__ import annotations

import time

import numpy as np

import mbsd
from benchmarks.dynamics.problems import Problem
from mbsd.dynamics.simulate import integrator_named

VERSION = mbsd.__version__
TOLERANCES = [{"tolerance": tolerance} for tolerance in (1e-4, 3e-5, 1e-5, 5e-6, 3e-6, 1e-6, 3e-7, 1e-7)]
CANDIDATES = dict.fromkeys(("A01", "A02 N=1", "A02 N=10", "A02 N=40", "A03"), TOLERANCES)


def run(problem: Problem, settings: dict, samples: int) -> tuple[float, np.ndarray, np.ndarray, np.ndarray]:
    """See the package."""
    ready, method = problem.ready, integrator_named(problem.name, "dop853")
    grid = np.linspace(0.0, problem.duration, samples)
    started = time.perf_counter()
    _, out = ready.run(method, grid, settings["tolerance"], problem.duration)
    seconds = time.perf_counter() - started
    states = out.y.reshape(samples, 2, -1, 3)[:, :, 1:]
    return seconds, out.t, states[:, 0], states[:, 1]
