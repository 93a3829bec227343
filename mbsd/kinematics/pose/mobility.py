"""Mobility: freedoms by count and by rank, redundant joints, undriven and doubly driven freedoms.

    nominal  3 (nb - 1) - rows of all joints          (Gruebler)
    dof      n - rank J of the joints

The rank at one pose may be low by accident (a toggle, a change point), so it is also taken at closed poses nearby
and the largest counts.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import MobilityError, SingularPoseError
from mbsd.base.quantity import counted
from mbsd.base.running import Kept
from mbsd.equations.assembly import residual_and_jacobian
from mbsd.kinematics.pose.close import CLOSED, close, rough_pose
from mbsd.kinematics.pose.held_values import RANK_TOLERANCE, SMALL, independent_rows
from mbsd.kinematics.pose.phases import let_phases_go, take_phases
from mbsd.model.mechanism import Model
from mbsd.results.views import Mobility

BETTER = 4.0
"""Rows are exchanged for others whose least singular value is this many times larger."""
CLEARER = 30.0
"""The same before a motion begins: rows that are near a toggle of their own are left for others."""


_MOBILITY: Kept[Mobility] = Kept()
_ROWS: Kept[tuple[int, ...]] = Kept()
_CHOSEN: Kept[tuple[int, ...]] = Kept()
"""Ranks by all that J at a pose depends on."""


def joint_mobility(packed: Packed, q: np.ndarray) -> Mobility:
    """Return mobility of the joints alone at the closed pose q (3 nb,)."""
    key = _key(packed, q)
    return _joint_mobility(packed, q) if key is None else _MOBILITY.get(key, lambda: _joint_mobility(packed, q))


def rows_at(packed: Packed, q: np.ndarray) -> list[int]:
    """Return rows of J at q (3 nb,) that are independent of those before them."""

    def independent() -> tuple[int, ...]:
        return tuple(independent_rows(scaled_jacobian(packed, q)))

    key = _key(packed, q)
    return list(independent() if key is None else _ROWS.get(key, independent))


def _key(packed: Packed, q: np.ndarray) -> tuple[object, ...] | None:
    """Return all that J at q (3 nb,) and its words depend on; None if that is more than numbers."""
    numbers = packed.numbers()
    if numbers is None:
        return None
    return *numbers, q.tobytes(), *packed.body_names, *(joint.name for joint in packed.joints), packed.driver_rows


def _joint_mobility(packed: Packed, q: np.ndarray) -> Mobility:
    """Return the groups of a mechanism without a look at those kept; None without such a plan."""
    rows = packed.driver_rows
    here = scaled_jacobian(packed, q)[:rows]
    best, start = here, len(independent_rows(here))
    kept = independent_rows(best)
    for tries, seed in ((3, 1), (9, 2)):
        if len(kept) == rows or (seed > 1 and start == len(kept)):
            break  # no rank is higher; more are tried where branches of other rank meet at the start
        for near in _nearby(packed, q, tries, seed):
            jac = scaled_jacobian(packed, near)[:rows]
            rank = independent_rows(jac)
            if len(rank) > len(kept):
                best, kept = jac, rank
    dropped = [row for row in range(rows) if row not in set(kept)]
    free = packed.coordinates - len(kept)
    return Mobility(
        nominal=packed.coordinates - rows,
        dof=free,
        redundant_rows=len(dropped),
        redundant=tuple(dict.fromkeys(packed.joint_of_row(row).name for row in dropped)),
        singular=start < len(kept),
        free_bodies=_free_bodies(packed, best, q) if free else (),
    )


def _free_bodies(packed: Packed, jac: np.ndarray, q: np.ndarray) -> tuple[str, ...]:
    """Return bodies that can move at the pose of ``jac`` or near q (3 nb,).

    At a dead centre a slider rests.
    """
    moving = {*moving_bodies(packed, jac)}
    if len(moving) + len(_fastened(packed)) < len(packed.body_names):
        for near in _nearby(packed, q):
            moving.update(moving_bodies(packed, scaled_jacobian(packed, near)[: packed.driver_rows]))
    return tuple(name for name in packed.body_names if name in moving)


def _fastened(packed: Packed) -> set[int]:
    """Return ground and the bodies that joints of three rows hold on it: they never move."""
    joints = packed.joints[: int(np.searchsorted(packed.first_row, packed.driver_rows))]
    ends = packed.system.marker_body[packed.markers[: len(joints)]]
    pairs = [tuple(pair) for pair, rows in zip(ends.tolist(), np.diff(packed.first_row), strict=False) if rows == 3]
    held, before = {0}, 0
    while len(held) > before:
        before = len(held)
        held.update(body for pair in pairs if held.intersection(pair) for body in pair)
    return held


def refuse_overdriven(m: Model, packed: Packed, time: float) -> None:
    """Raise MobilityError if the joints close without the drivers, and these are too many."""
    none = np.zeros((len(packed.motions) + 1, 3))
    let_phases_go(packed)
    q, worst = close(packed, rough_pose(m, packed, none, 0), none, packed.driver_rows)
    take_phases(packed, q, none)
    if worst <= CLOSED:
        refuse_idle_drivers(packed, joint_mobility(packed, q), _best_rows(packed, q)[1], time)


def choose_rows(packed: Packed, q: np.ndarray, time: float, joints: Mobility) -> np.ndarray:
    """Return (n,) independent rows that fix all coordinates, drivers included.

    ``joints`` is the mobility of the joints at q.

    Raises MobilityError for a missing or superfluous driver, SingularPoseError where only this pose is at fault.
    """

    def chosen() -> tuple[int, ...]:
        return tuple(_chosen(packed, q, time, joints))

    key = _key(packed, q)
    return np.array(chosen() if key is None else _CHOSEN.get(key, chosen))


def _chosen(packed: Packed, q: np.ndarray, time: float, joints: Mobility) -> list[int]:
    here, kept, best = _best_rows(packed, q)
    refuse_idle_drivers(packed, joints, kept, time)
    if len(kept) < packed.coordinates:
        missing = packed.coordinates - len(kept)
        free = moving_bodies(packed, scaled_jacobian(packed, best))
        raise MobilityError(
            f"{packed.name}: at t = {time:.6g} s {missing} of {counted(joints.dof, 'degree')} of freedom "
            f"{'is' if missing == 1 else 'are'} not driven: {', '.join(free)} can still move. "
            f"Add {'a driver' if missing == 1 else f'{missing} drivers'}, "
            "for example m.drive_angle(...)." + _of_play(packed)
        )
    if len(here) < len(kept):
        raise SingularPoseError(
            f"{packed.name}: the start pose at t = {time:.6g} s is singular (a toggle or change point): "
            "the drivers do not fix the motion here. Start a little before or after it, or drive another body."
        )
    return choose_clear_rows(packed, q, kept)


def choose_clear_rows(packed: Packed, q: np.ndarray, kept: list[int]) -> list[int]:
    """Return ``kept`` rows at q (3 nb,), or others in their place where they alone are near a toggle.

    Joints that repeat each other let a choice of rows be singular at a pose at which all of them are not.
    """
    if not 0 < len(kept) < len(packed.ws.phi):
        return kept
    clear = better_rows(scaled_jacobian(packed, q), kept, CLEARER)
    return kept if clear is None else clear.tolist()


def best_rows(packed: Packed, known: np.ndarray) -> np.ndarray | None:
    """Return (n,) least dependent rows of the last J; None if ``known`` (n,) are nearly as good.

    Where joints repeat each other, rows that serve at one pose may be dependent at another. Near a change point one
    singular value vanishes whatever rows are kept, and a second one for some of them: there they pass two at once.
    """
    return better_rows(packed.jacobian() * packed.row_scale()[:, None] * packed.column_scale(), known, least=2)


def better_rows(
    jac: np.ndarray, known: Sequence[int] | np.ndarray, better: float = BETTER, least: int = 1
) -> np.ndarray | None:
    """Return (r,) rows of jac (m, n) that are further from dependent than ``known`` (r,); None if there are none.

    One of their ``least`` smallest singular values is ``better`` times that of ``known``. jac is dimensionless. Source:
    pivoted QR.
    """
    from scipy.linalg import qr, svdvals

    chosen = np.sort(qr(jac.T, mode="r", pivoting=True)[-1][: len(known)])
    own, others = (np.asarray(svdvals(jac[rows]))[-least:] for rows in (known, chosen))
    return chosen if (others > better * own).any() else None


def _best_rows(packed: Packed, q: np.ndarray) -> tuple[list[int], list[int], np.ndarray]:
    """Return independent rows at q, at the pose near it (or q) that has most of them, and that pose."""
    here = independent_rows(scaled_jacobian(packed, q))
    if len(here) == min(packed.coordinates, len(packed.ws.phi)):
        return here, here, q
    poses = [q, *_nearby(packed, q)]
    ranked = [here, *(independent_rows(scaled_jacobian(packed, pose)) for pose in poses[1:])]
    best = max(range(len(poses)), key=lambda k: len(ranked[k]))
    return ranked[0], ranked[best], poses[best]


def refuse_idle_drivers(packed: Packed, joints: Mobility, kept: list[int], time: float) -> None:
    """Raise MobilityError where a driver's row is not among ``kept``, the independent ones."""
    drivers = packed.drivers
    idle = [d for k, d in enumerate(drivers) if packed.driver_rows + k not in set(kept)]
    if not idle:
        return
    others = [f"'{d.name}'" for d in drivers if d not in idle]
    fixed = "the joints" + (f" and driver{'s' * (len(others) > 1)} {', '.join(others)}" if others else "")
    raise MobilityError(
        f"{packed.name}: at t = {time:.6g} s driver '{idle[0].name}' drives a freedom that {fixed} already fix: "
        f"{counted(joints.dof, 'degree')} of freedom, {counted(len(drivers), 'driver')}. "
        "Remove one driver or free a joint."
    )


def scaled_jacobian(packed: Packed, q: np.ndarray) -> np.ndarray:
    """Return (m, n) dimensionless Jacobian at q, ground's columns left out."""
    residual_and_jacobian(packed.system, q, np.zeros((len(packed.motions) + 1, 3)), packed.ws)
    return packed.jacobian() * packed.row_scale()[:, None] * packed.column_scale()


def _nearby(packed: Packed, q: np.ndarray, tries: int = 3, seed: int = 1) -> list[np.ndarray]:
    """Return closed poses near q, with the drivers released."""
    random = np.random.default_rng(seed)
    scale = packed.column_scale()
    none = np.zeros((len(packed.motions) + 1, 3))
    poses = []
    for _ in range(tries):
        moved = q.copy()
        moved[3:] += 0.1 * scale * random.standard_normal(packed.coordinates)
        moved, worst = close(packed, moved, none, packed.driver_rows)
        if worst <= CLOSED:
            poses.append(moved)
    return poses


def moving_bodies(packed: Packed, jac: np.ndarray, each: int = 3) -> tuple[str, ...]:
    """Return bodies that the null space of J moves; a body has ``each`` columns."""
    size = _kept_motion(jac.tobytes(), jac.shape, each) if jac.size <= SMALL else _motion(jac, each)
    return tuple(name for name, moved in zip(packed.body_names[1:], size, strict=True) if moved > 1e-6)


@lru_cache(maxsize=64)
def _kept_motion(numbers: bytes, shape: tuple[int, int], each: int) -> np.ndarray:
    return _motion(np.frombuffer(numbers).reshape(shape).copy(), each)


def _motion(jac: np.ndarray, each: int) -> np.ndarray:
    """Return (bodies,) largest number of each body in unit vectors that span the null space of J."""
    _, singular, v = np.linalg.svd(jac, full_matrices=True)
    rank = int((singular > RANK_TOLERANCE * max(1.0, singular.max(initial=0.0))).sum())
    null = v[rank:]
    return np.linalg.norm(null, axis=0).reshape(-1, each).max(axis=1)


def _of_play(packed: Packed) -> str:
    """Return a sentence where forces take the place of joints."""
    names = [f"'{force.name}'" for force in packed.forces if force.kind.ideal is not None]
    if not names:
        return ""
    return f" What has play ({', '.join(names)}) is free to move in it, and no driver moves that: simulate() does."
