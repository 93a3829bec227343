"""The search for a pose that balances, on the constraints.

    g = -T^T Q,   step -|K|^-1 g along the tangent basis T, put back onto the constraints

Downhill: K with its negative curvatures turned positive, steps limited in length; a step counts if the loads do work on
it, so no potential is needed. A pose that balances but is unstable is left along its softest direction. Near the end
this is Newton's method. Nearest: Newton on g = 0, which also finds unstable equilibria.

Source: Nocedal, Wright, Numerical Optimization, ch. 3.4 (modified Newton); Haug 1989, ch. 7.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.analyses.statics import STEP, Statics, longest_step, pose_step, tangent
from mbsd.base.errors import EquilibriumError
from mbsd.base.names import Suggesting
from mbsd.base.quantity import written
from mbsd.kinematics.pose.close import CLOSED, close

LONGEST = 0.3
"""Longest step, in sizes and rad."""
MOST_STEPS = 400
BALANCED = 1e-13
"""Part of the largest load that may stay unbalanced."""
NOISE = 1e-14
"""Fraction of the stiffness: what a displacement by rounding changes in the loads."""
ACCEPTED = 1e-9
"""Residual that counts as balanced where rounding allows no further step."""
AWAY, TURNED = 20.0, 25.0
"""Sizes, and rad, from its start beyond which a mechanism runs away."""
GROWN = 1e3
"""Times the loads at the start: beyond it they grow without bound."""
FLAT = 1e-8
"""Part of the largest stiffness below which a direction is neutral."""


@dataclass
class Balance(Suggesting):
    """A pose as the search sees it."""

    basis: np.ndarray
    load: np.ndarray
    lam: np.ndarray
    slope: np.ndarray
    """(f,) g = -T^T Q."""
    largest: float

    def balanced(self, part: float, stiffness: np.ndarray) -> bool:
        """True if no more than this part of the largest load is left, or rounding."""
        noise = NOISE * float(np.abs(stiffness).max(initial=0.0))
        return bool(np.abs(self.slope).max(initial=0.0) <= part * self.largest + noise)


def look(ready: Statics, q: np.ndarray) -> Balance:
    """Tangent, loads and multipliers at q (3 nb,). Raises EquilibriumError where a load is not finite."""
    jacobian = ready.jacobian(q)
    basis = tangent(ready.packed, jacobian, ready.among)
    load = ready.load(q)
    ready.packed.specials.check()
    if not np.isfinite(load).all():
        raise EquilibriumError(
            f"{ready.packed.name}: the load of '{_worst(ready, np.isnan(load))}' is not finite at the last pose of "
            "the search. Start nearer with start_near, or check the forces on this body"
        )
    slope = -(basis * ready.packed.column_scale()[:, None]).T @ load
    return Balance(basis, load, ready.multipliers(jacobian, load), slope, ready.size_of_load(q))


def _worst(ready: Statics, generalised: np.ndarray) -> str:
    return ready.packed.body_names[1 + int(np.argmax(np.abs(generalised * ready.packed.column_scale()))) // 3]


def _moved(ready: Statics, q: np.ndarray, step: np.ndarray) -> np.ndarray | None:
    """The closed pose nearest to q + step (n,), None if there is none near."""
    trial = q.copy()
    trial[3:] += step * ready.packed.column_scale()
    closed, gap = close(ready.packed, trial, ready.drive)
    back = np.linalg.norm((closed - trial)[3:] / ready.packed.column_scale())
    return closed if gap <= CLOSED and back <= 0.5 * np.linalg.norm(step) else None


def descend(ready: Statics, q: np.ndarray) -> tuple[np.ndarray, int]:
    """Downhill from q (3 nb,): the stable pose and the steps taken. Raises EquilibriumError."""
    start = here = look(ready, q)
    began = q
    for count in range(MOST_STEPS):
        stiffness = ready.stiffness(q, here.lam, here.basis, pose_step(ready.packed, q, STEP))
        value, direction = np.linalg.eigh(0.5 * (stiffness + stiffness.T))
        flat = FLAT * float(np.abs(value).max(initial=0.0))
        if here.balanced(BALANCED, stiffness):
            if not len(value) or value[0] >= -max(flat, 1e-9 * here.largest):
                return q, count
            step = (
                longest_step(ready.packed, LONGEST)
                / 3.0
                * direction[:, 0]
                * (1.0 if direction[:, 0].sum() >= 0.0 else -1.0)
            )
            better = _leave(ready, q, here.basis, step)
        else:
            step = -np.linalg.solve(stiffness, here.slope) if value[0] > flat else None
            if step is None or step @ here.slope >= 0.0:
                least = max(flat, 1e-3 * float(np.abs(here.slope).max()))
                step = -direction @ (direction.T @ here.slope / np.maximum(np.abs(value), least))
            step *= min(1.0, longest_step(ready.packed, LONGEST) / max(float(np.linalg.norm(step)), 1e-300))
            better = _downhill(ready, q, here, step)
        if better is None:
            if here.balanced(ACCEPTED, stiffness):
                return q, count
            break
        q, here = better
    raise _none(ready, here, start, q, began)


def _downhill(ready: Statics, q: np.ndarray, here: Balance, step: np.ndarray) -> tuple[np.ndarray, Balance] | None:
    """The step, halved until the loads do work on it; None if they never do."""
    part = 1.0
    for _ in range(40):
        moved = _moved(ready, q, here.basis @ (part * step))
        if moved is not None:
            there = look(ready, moved)
            work = 0.5 * (here.load + there.load) @ (moved - q)[3:]
            smaller = np.linalg.norm(there.slope) < 0.5 * np.linalg.norm(here.slope)
            if work >= -1e-4 * part * (step @ here.slope) or (smaller and work > 0.0):
                return moved, there
            if smaller and np.linalg.norm(here.slope) < 1e-6 * here.largest:
                return moved, there
        part /= 2.0
    return None


def _leave(ready: Statics, q: np.ndarray, basis: np.ndarray, step: np.ndarray) -> tuple[np.ndarray, Balance] | None:
    """Off an unstable pose, one way or the other."""
    for part in (1.0, -1.0, 0.3, -0.3, 0.1, -0.1):
        moved = _moved(ready, q, basis @ (part * step))
        if moved is not None:
            return moved, look(ready, moved)
    return None


def newton(ready: Statics, q: np.ndarray) -> tuple[np.ndarray, int]:
    """The nearest pose that balances, stable or not, and the steps taken. Raises EquilibriumError."""
    start = here = look(ready, q)
    began = q
    for count in range(MOST_STEPS):
        stiffness = ready.stiffness(q, here.lam, here.basis, pose_step(ready.packed, q, STEP))
        if here.balanced(BALANCED, stiffness):
            return q, count
        step = -np.linalg.lstsq(stiffness, here.slope, rcond=1e-10)[0]
        step *= min(1.0, longest_step(ready.packed, LONGEST) / max(float(np.linalg.norm(step)), 1e-300))
        part, better = 1.0, None
        for _ in range(30):
            moved = _moved(ready, q, here.basis @ (part * step))
            there = look(ready, moved) if moved is not None else None
            if moved is not None and there is not None and _norm(there) < (1.0 - 1e-4 * part) * _norm(here):
                better = moved, there
                break
            part /= 2.0
        if better is None:
            if here.balanced(ACCEPTED, stiffness):
                return q, count
            break
        q, here = better
    raise _none(ready, here, start, q, began)


def _norm(here: Balance) -> float:
    return float(np.linalg.norm(here.slope))


class NoneFound(EquilibriumError):
    """Where a search ended without an equilibrium: ``pose`` (3 nb,), and its text up to the remedy."""

    def __init__(self, said: str, remedy: str, pose: np.ndarray) -> None:
        super().__init__(f"{said} {remedy}")
        self.said, self.pose = said, pose


def _none(ready: Statics, here: Balance, start: Balance, q: np.ndarray, began: np.ndarray) -> NoneFound:
    packed = ready.packed
    body = _worst(ready, here.basis @ here.slope / packed.column_scale())
    left = np.abs(here.slope).max() / packed.size
    gone = np.abs(q - began).reshape(-1, 3)[1:]
    far, turned = np.hypot(gone[:, 0], gone[:, 1]), gone[:, 2]
    remedy = (
        "If nothing holds the mechanism, add a spring, a stop, a driver or a joint; if something does, start nearer to "
        "the equilibrium with start_near."
    )
    if here.largest > GROWN * start.largest:
        remedy = (
            f"Its loads have grown from {written(start.largest / packed.size, 'N')} to "
            f"{written(here.largest / packed.size, 'N')} on the way: a pull that grows without bound as bodies come "
            "near each other has no equilibrium there. Keep them apart by a joint or spring, or start nearer to one "
            "with start_near."
        )
    elif far.max() > AWAY * packed.size:
        remedy = (
            f"It runs away: the loads have drawn '{packed.body_names[1 + int(np.argmax(far))]}' {far.max():.3g} m from "
            "its start, and on and on. Hold it by a spring, a stop, a driver or a joint; "
            "equilibrium(nearest=True) also looks for an unstable one."
        )
    elif turned.max() > TURNED:
        remedy = (
            f"Its loads drive '{packed.body_names[1 + int(np.argmax(turned))]}' round and round, "
            f"{turned.max() / (2 * np.pi):.3g} turns so far: they have no potential with a least value. Take the "
            "torque off, or hold it by a spring or a joint."
        )
    return NoneFound(
        f"{packed.name}: no equilibrium was found: '{body}' is still driven by {written(left, 'N')} (or N m over the "
        f"size of {packed.size:.3g} m) where the search has come to.",
        remedy,
        q,
    )
