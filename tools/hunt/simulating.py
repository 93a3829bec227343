"""Variations of a free motion: each takes the case and gives its outcome."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from mbsd.base.errors import SimulationError
from mbsd.dynamics.integrators.kind import INTEGRATORS
from mbsd.dynamics.simulate import integrator_named
from tools.hunt.agreement import Words
from tools.hunt.checks import balanced, closed, finite
from tools.hunt.free_case import OUTPUTS, Free, nudged
from tools.hunt.mixed_rows import beside_single_ones, mixed_rows
from tools.hunt.moved_derivatives import beside_its_own
from tools.hunt.outcome import AGREED, REFUSED, UNCLEAR, WRONG, Outcome, Variations
from tools.hunt.rewordings import IN_OTHER_WORDS, KEPT_AND_CHANGED, random_pose, size_of
from tools.hunt.sweeping import HEALTHY
from tools.random_mechanisms.described import duplicate, restarted
from tools.random_mechanisms.subject import TOLERANCE, attempt

STEPS = (1, 2, 3, 5, 12, 30, 360, 1440)
FIXED_STEPS = 400
"""Number of steps of methods without an error estimate, over the duration; then twice as many."""

RUNS: Variations[Free] = Variations()
variation = RUNS.enter


RUNS.update(IN_OTHER_WORDS)


def _outputs(count: int) -> Callable[[Free], Outcome]:
    def run(case: Free) -> Outcome:
        return case.compared(f"{count} outputs", case.m, times=np.linspace(0.0, case.subject.duration, count + 1))

    return run


for _count in STEPS:
    RUNS[f"{_count} outputs"] = _outputs(_count)


@variation("irregular outputs")
def _irregular(case: Free) -> Outcome:
    keep = case.rng.random(len(case.grid)) < case.rng.uniform(0.05, 0.9)
    keep[[0, int(case.rng.integers(1, len(keep)))]] = True
    return case.compared("irregular outputs", case.m, times=case.grid[keep])


@variation("another tolerance")
def _tolerance(case: Free) -> Outcome:
    tolerance = float(10.0 ** -case.rng.integers(5, 11))
    return case.compared(f"tolerance {tolerance:.0e}", case.m, tolerance=tolerance)


@variation("reference coordinates")
def _reference(case: Free) -> Outcome:
    tolerance = float(10 ** case.rng.uniform(-9, -7))
    return case.compared("reference coordinates", case.m, formulation="reference", tolerance=tolerance)


@variation("independent coordinates")
def _independent(case: Free) -> Outcome:
    tolerance = float(10 ** case.rng.uniform(-9, -7))
    return case.compared("independent coordinates", case.m, formulation="independent", tolerance=tolerance)


RUNS.update(KEPT_AND_CHANGED)


@variation("mixed rows at once")
def _rows(case: Free) -> Outcome:
    name, rows = "mixed rows at once", mixed_rows(case.built, case.rng)
    if rows is None or case.first is None:
        return Outcome(name, UNCLEAR, "nothing to vary, or refused as built")
    return beside_single_ones(name, rows, case.subject.duration, TOLERANCE, nudged)


@variation("derivatives of the moved machine")
def _derivatives(case: Free) -> Outcome:
    name = "derivatives of the moved machine"
    if case.first is None or case.margin < HEALTHY or {"bifurcates", "jumps"} & case.subject.traits:
        return Outcome(name, UNCLEAR, "refused as built, near a singular pose, or accelerations jump")
    pose = random_pose(case.rng, size_of(case))
    return beside_its_own(name, case.built, case.rng, pose, case.first, is_free=True, nudged=nudged)


@variation("from the middle on")
def _middle(case: Free) -> Outcome:
    name = "from the middle on"
    if case.first is None or case.touches():
        return Outcome(name, UNCLEAR, "refused as built, or contacts remember")
    k = int(case.rng.integers(1, OUTPUTS - 1))
    if case.remembers(k):
        return Outcome(name, UNCLEAR, "a contact remembers how it began")
    m = restarted(duplicate(case.m), case.first, k)
    other, error = case.run(m, times=case.grid[k:])
    if error is not None:
        return case.refusal(name, error)
    assert other is not None
    begun = np.abs(other.q[0] - case.first.q[k]).max()
    if begun > 1e-3 * size_of(case):  # a warning says so
        return Outcome(name, UNCLEAR, "a disc near a crossing of its curve begins on the nearest branch")
    outcome = case.agreement(name, other, Words({}), TOLERANCE)
    if outcome.detail.startswith("energies"):  # counted from another start
        return Outcome(name, AGREED)
    return outcome


@variation("asked between outputs")
def _between(case: Free) -> Outcome:
    name = "asked between outputs"
    times = np.linspace(0.0, case.subject.duration, 4)
    coarse, error = case.run(case.m, times=times)
    if error is not None:
        return case.refusal(name, error)
    assert coarse is not None
    wanted = case.grid[np.sort(case.rng.choice(np.arange(1, OUTPUTS), 5, replace=False))]
    other, error = attempt(lambda: coarse.at(wanted))
    if error is not None:
        return case.refusal(name, error)
    assert other is not None
    outcome = case.agreement(name, other, Words({}), TOLERANCE)
    if outcome.detail.startswith("energies"):
        return Outcome(name, AGREED)
    return outcome


@variation("another integrator")
def _integrator(case: Free) -> Outcome:
    integrator_named("hunt", "rk4")
    known = [method for method in INTEGRATORS.values() if method.installed and method.name != "dop853"]
    method = known[int(case.rng.integers(len(known)))]
    name = f"integrator {method.name}"
    if case.first is None:
        return Outcome(name, UNCLEAR, "refused as built")
    if not method.fixed_step:
        tolerance = 1e-8
        return case.compared(name, case.m, method=method.name, tolerance=tolerance)
    return _converges(case, name, method.name, method.order)


def _converges(case: Free, name: str, method: str, order: int) -> Outcome:
    """A method of fixed steps comes nearer with half the step; how near depends on the mechanism."""
    if case.touches() or {"stiff", "jumps"} & case.subject.traits:
        return Outcome(name, UNCLEAR, "fixed steps over events, jumps or stiff forces")
    assert case.first is not None
    shares, last = [], None
    for count in (FIXED_STEPS, 2 * FIXED_STEPS) if not case.notes else (4 * FIXED_STEPS, 16 * FIXED_STEPS):
        other, error = case.run(case.m, method=method, step=case.subject.duration / count)
        if error is not None:
            if isinstance(error, SimulationError):
                return Outcome(name, REFUSED, "SimulationError, asks for smaller steps", str(error))
            return case.refusal(name, error)
        assert other is not None
        problems = finite(other) if method == "baumgarte" else finite(other) or closed(other)
        if problems:
            return Outcome(name, WRONG, "against its own equations", "; ".join(problems))
        last = case.verdict(other, Words({}), 1e-6)
        shares.append(last.worst)
    if min(shares) <= 1.0 or shares[1] <= 0.7 ** min(order, 2) * shares[0]:
        return Outcome(name, AGREED)
    if case.margin < HEALTHY:
        return Outcome(name, UNCLEAR, "fixed steps near a singular pose")
    if case.less_sure():
        return _converges(case, name, method, order)
    return Outcome(
        name, WRONG, "does not converge", f"{shares[0]:.3g} bounds, then {shares[1]:.3g}: {last and last.words}"
    )


@variation("energy")
def _energy(case: Free) -> Outcome:
    if case.first is None or case.growth is None:
        return Outcome("energy", UNCLEAR, "refused as built")
    first = case.first
    scale = max(float(first.energy.kinetic.max()), float(np.ptp(first.energy.potential)), 1e-6)
    if first.work is not None:
        scale = max(scale, float(np.abs(first.work).max()))
    grown = float(case.growth.of["energies"].max()) if "energies" in case.growth.of else 0.0
    problems = balanced(first, TOLERANCE, grown, scale)
    return Outcome("energy", WRONG, "is not kept", problems[0]) if problems else Outcome("energy", AGREED)
