"""Checks that any solution must pass by itself, and refusals that the program promises."""

from __future__ import annotations

import numpy as np
from numpy.lib.stride_tricks import sliding_window_view

from mbsd import Mechanism
from mbsd.base.errors import MechanismError
from mbsd.equations.assembly import tabulate
from mbsd.model.force import FORCE_KINDS
from mbsd.model.joint import KINDS
from mbsd.model.laws.function import Function
from mbsd.results.solution import Solution
from tools.random_mechanisms.described import Raised
from tools.random_mechanisms.subject import Subject

# What any solution must fulfil by itself, judged from its numbers alone.


RESIDUAL = 1e-7
"""Largest gap of a joint, in sizes."""
FLAT = 1e-6
"""Part of the largest singularity margin below which a pose is a change point."""
RESOLVED = 0.02
"""Singularity margin above which DENSE outputs show every bend of the motion."""
DENSE = 90
"""Outputs a turn from which on differences say something."""
BESIDE = 2
"""Steps; at DENSE outputs a turn they hold the narrowest rise of a cam that is drawn, its accelerations up and down."""

FINER, FEW = 256, 3
"""Steps for one that is looked at again; of more than FEW steps none is."""


def finite(sol: Solution) -> list[str]:
    """Numbers that are none; reactions may be none at a change point itself."""
    margin = sol.singularity_margin
    is_clear = ~(margin <= FLAT * margin.max(initial=0.0))
    arrays = {"q": sol.q, "v": sol.v, "a": sol.a, "reactions": sol.wrench[is_clear]}
    return [f"{name} is not finite" for name, array in arrays.items() if not np.isfinite(array).all()]


def closed(sol: Solution) -> list[str]:
    """Pins whose two points are apart, measured from the bodies' poses."""
    out = []
    for name, joint in sol.mechanism.joints.items():
        if joint.kind.name not in ("revolute", "weld"):
            continue
        ends = []
        for marker in (joint.i, joint.j):
            pose = sol.q[:, sol.packed.body_names.index(marker.body.name)]
            com = marker.body.com if marker.body.name != "ground" else (0.0, 0.0)
            arm = (marker.x - com[0] + 1j * (marker.y - com[1])) * np.exp(1j * pose[:, 2])
            ends.append(pose[:, 0] + 1j * pose[:, 1] + arm)
        gap = np.abs(ends[1] - ends[0])
        if not gap.max() <= RESIDUAL * sol.packed.size:
            out.append(f"pin '{name}' is open by {gap.max():.3g} m at t = {sol.t[int(np.argmax(gap))]:.6g} s")
    return out


def smooth(sol: Solution) -> list[str]:
    """Steps of a dense motion against its velocities and accelerations.

    Within a step, q' - q - h (v + v') / 2 is half the integral of (h - 2 t) a, at most h^2 R / 8 where the acceleration
    stays within a range R; with the correction of the trapezium, h^2 (a' - a) / 12, less than h^2 R / 4. R is taken
    from the outputs up to BESIDE steps before and after: between two of them an acceleration may turn back, or jump up
    and down. A branch that is left, or an angle that takes a whole turn more, is more than that. What a sweep does
    within one step alone, as at the sharp end of a curve, is looked at again in FINER steps, which must meet the same
    poses.
    """
    odd = odd_steps(sol)
    if not odd or sol.work is not None or len(odd) > FEW:
        return [problem for _, problem in odd[:1]]
    between = [np.linspace(sol.t[k], sol.t[k + 1], FINER + 1)[1:-1] for k, _ in odd]
    assert isinstance(sol.mechanism, Mechanism)
    fine = sol.mechanism.sweep(times=np.sort(np.concatenate([sol.t, *between])))
    apart = float(np.abs(fine.q[np.searchsorted(fine.t, sol.t)] - sol.q).max())
    still = {int(np.searchsorted(sol.t, fine.t[k], side="right")) - 1 for k, _ in odd_steps(fine)}
    return [problem for k, problem in odd if k in still or apart > RESIDUAL * max(sol.packed.size, 1.0)][:1]


def odd_steps(sol: Solution) -> list[tuple[int, str]]:
    """The steps that pass their limit, in words, the worst one first."""
    h = np.diff(sol.t)[:, None, None]
    q, v, a = sol.q[:, 1:], sol.v[:, 1:], sol.a[:, 1:]
    expected = h * (v[1:] + v[:-1]) / 2 - h**2 * np.diff(a, axis=0) / 12
    gap = np.abs(np.diff(q, axis=0) - expected)
    size = np.array([sol.packed.size, sol.packed.size, 1.0])
    around = sliding_window_view(np.pad(a, ((BESIDE, BESIDE), (0, 0), (0, 0)), "edge"), 2 * BESIDE + 2, axis=0)
    reach = np.maximum(np.ptp(around, axis=-1), 0.02 * np.abs(a[1:])).max(axis=1, keepdims=True)
    limit = 0.25 * h**2 * reach + 1e-9 * size + 1e-8 * h * np.abs(v[1:]).max(axis=1, keepdims=True)
    share = gap / limit
    worst = share.reshape(len(share), -1).max(axis=1)
    out = []
    for k in sorted(np.flatnonzero(worst > 1.0), key=lambda k: -worst[k]):
        b, c = np.unravel_index(int(np.argmax(share[k])), share.shape[1:])
        out.append(
            (
                int(k),
                f"'{sol.packed.body_names[1 + b]}' {('x', 'y', 'theta')[c]} goes on by "
                f"{sol.q[k + 1, 1 + b, c] - sol.q[k, 1 + b, c]:.6g} from t = {sol.t[k]:.6g} to {sol.t[k + 1]:.6g} s, "
                f"its velocity by {expected[k, b, c]:.6g}",
            )
        )
    return out


def one_assembly(sol: Solution, subject: Subject) -> list[str]:
    """The sign of det J, which only a change point turns round."""
    rows, packed = len(sol.packed.ws.phi), sol.packed
    if rows != packed.coordinates or "bifurcates" in subject.traits or sol.mobility.redundant_rows:
        return []
    count = len(sol.t)
    q, v = sol.q.reshape(count, -1), sol.v.reshape(count, -1)
    phi, gamma, compact = np.zeros((count, rows)), np.zeros((count, rows)), np.zeros((count, rows, 6))
    tabulate(
        packed.system, sol.drives, np.ascontiguousarray(q), np.ascontiguousarray(v), packed.ws, phi, compact, gamma
    )
    sign = np.linalg.slogdet(packed.spread(compact))[0]
    turned = np.flatnonzero(sign != sign[0])
    if not len(turned):
        return []
    return [f"det J changes its sign before t = {sol.t[turned[0]]:.9g} s: the other assembly, or a toggle passed"]


def balanced(sol: Solution, tolerance: float, growth: float, scale: float) -> list[str]:
    """Energy less work, of a simulation without impacts."""
    if sol.audit is None:
        return []
    later = [event for event in sol.events if event.time > sol.t[0]]  # what happens at the start is in the first output
    lost = sum(np.where(sol.t > event.time, event.energy, 0.0) for event in later)
    audit = sol.audit - lost
    limit = 1e4 * tolerance * (scale + growth)
    if np.ptp(audit) <= limit:
        return []
    return [f"energy less work changes by {np.ptp(audit):.3g} J, bound {limit:.3g} J"]


def driven_problems(sol: Solution, subject: Subject) -> list[str]:
    """Problems of a sweep."""
    out = finite(sol) or closed(sol)
    if out:
        return out
    if subject.truth is not None:
        out += subject.truth(sol)
    out += one_assembly(sol, subject)
    per_turn = (len(sol.t) - 1) / subject.turns
    even = len(sol.t) > 1 and np.ptp(np.diff(sol.t)) < 1e-6 * sol.t[-1]
    if even and per_turn >= DENSE and sol.singularity_margin.min() > RESOLVED < subject.distance:
        out += smooth(sol)
    return out


# Which refusals are expected of a variation, by what the program promises.


PROMISED = (
    "is not possible here",
    "does not know",
    "does not take",
    "need scikit-sundae",
    "in reference coordinates",
    "do not end there",
    "is lost in rounding",
    "may be on the other branch",
)
"""Words of refusals that say what a method or formulation is not made for.

How far masses are apart, and so what is lost in rounding, depends on the frames of bodies by a factor of two.
"""


def expected_refusal(error: MechanismError) -> bool:
    """Return True if the program says beforehand that it refuses."""
    return any(words in str(error) for words in PROMISED)


def cannot_be_saved(m: Mechanism) -> bool:
    """Return True if the model holds a Python function, or events."""
    laws = [driver.motion for driver in m.drivers.values()]
    laws += [law for force in m.forces.values() for law in force.laws.values()]
    kinds = [KINDS[joint.kind.name].saved for joint in m.joints.values()]
    kinds += [FORCE_KINDS[force.kind.name].saved for force in m.forces.values()]
    return bool(m.events) or not all(kinds) or any(isinstance(law, Function | Raised) for law in laws)
