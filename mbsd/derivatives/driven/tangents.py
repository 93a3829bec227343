"""How a driven motion and its multipliers change with numbers: its equations differentiated, with one inverse of J.

    J q' = -dPhi/dp        J v' = -d(J v - nu)        J a' = -d(J a - gamma)
    (J^T - dF/dlam) lam' = d(Q + F + m g - M a - J^T lam) - M a'

d(...) is the change with the number at a held state, and along q' and v' at held numbers; both are differences of
fourth order of what the kernels evaluate, along a known direction, so that nothing is solved again and any kind of
joint and force has its derivatives. Joints that repeat others share their loads with the least norm, and that share
changes too. Source: Haug 1989, ch. 3; Golub, Pereyra, SIAM J. Numer. Anal. 10 (1973) (the pseudo-inverse).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mbsd.base.errors import ModelError
from mbsd.derivatives.driven.differences import differ, displace
from mbsd.derivatives.numbers.terms import Along, Change, Left, Terms, stacked
from mbsd.derivatives.numbers.variants import FOURTH, STEP, Variant, Variants
from mbsd.derivatives.refused_motions import fits_alone
from mbsd.model.output_times import check_memory

REACH = 1e-4
"""How far a difference along a direction goes: sizes, rad, and parts of the fastest speed."""
LOOSE = 1e-9
"""Part of the largest singular value below which one is zero."""
PART_OF_LOAD, SLIGHT_LOAD, SHORTEST = 3e-3, 1e-6, 1e-4
"""Part of a load by which it may change in a difference; part of the largest load that counts as one; least part of a
usual step."""
AT_ONCE = 100_000
"""Numbers of Jacobians that are made at once: as many as stay near the processor."""
OPENED = 1e-6
"""Part of a change that no motion can follow, where redundant joints no longer fit."""


@dataclass
class Tangent:
    """By a number: how a motion changes with it. (T, 3 nb), (T, m), (T, s)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    lam: np.ndarray
    states: np.ndarray | None = None


def refuse_large(terms: Terms, count: int) -> None:
    """Raise ModelError where Jacobians of so many times, their inverses and what is made of them do not fit."""
    packed = terms.packed
    size = max(len(packed.ws.phi), packed.coordinates)
    check_memory(
        f"{packed.name}: derivatives at {count} times of {packed.coordinates} coordinates", 4 * count * size**2,
        "Take fewer steps",
    )  # fmt: skip


class Inverse:
    """J of a motion, (T, m, n), and its inverse."""

    def __init__(self, terms: Terms, along: Along, redundant: bool) -> None:
        self.terms, self.redundant = terms, redundant
        refuse_large(terms, len(along.t))
        self.compact = terms.rows(along)[2]
        self.jac = terms.packed.spread(self.compact)
        self.inverse = np.linalg.pinv(self.jac, rcond=LOOSE) if redundant else np.linalg.inv(self.jac)
        self.friction = self._friction(along)

    def solved(self, right: np.ndarray, name: str = "", slight: float = np.inf) -> np.ndarray:
        """(T, 3 nb) x of J x = right (T, m).

        Raises ModelError where joints that repeat others do not let it be, by more than ``slight``.
        """
        out = np.zeros((len(right), self.jac.shape[2] + 3))
        out[:, 3:] = np.einsum("tnm,tm->tn", self.inverse, right)
        if self.redundant and slight < np.inf:
            gap = right - np.einsum("tmn,tn->tm", self.jac, out[:, 3:])
            if np.abs(gap).max(initial=0.0) > max(OPENED * np.abs(right).max(initial=0.0), slight):
                raise ModelError(fits_alone(self.terms.packed.name, name))
        return out

    def multipliers(self, load: np.ndarray, share: np.ndarray | None) -> np.ndarray:
        """(T, m) lam of (J^T - dF/dlam) lam = load (T, 3 nb), and what redundant joints exchange, share (T, m)."""
        if self.friction is not None:
            matrix = self.jac.transpose(0, 2, 1) - self.friction
            return np.linalg.solve(matrix, load[:, 3:, None])[..., 0]
        lam = np.einsum("tnm,tn->tm", self.inverse, load[:, 3:])
        if share is not None:
            lam += share - np.einsum("tnm,tn->tm", self.inverse, np.einsum("tmn,tm->tn", self.jac, share))
        return lam

    def spread(self, lam: np.ndarray) -> np.ndarray:
        """(T, 3 nb) J^+ lam; see ``Along.spread``."""
        out = np.zeros((len(lam), self.jac.shape[2] + 3))
        out[:, 3:] = np.einsum("tnm,tm->tn", self.inverse, lam)
        return out

    def _friction(self, along: Along) -> np.ndarray | None:
        """(T, n, m) of dF/dlam; None where no joint has friction."""
        loads = self.terms.loads
        if loads is None or not len(loads.friction):
            return None
        if self.redundant:
            raise ModelError(
                f"{self.terms.packed.name}: derivatives of friction in joints of which some repeat others are not "
                "known; leave out the redundant joints"
            )
        lam, out = along.lam, np.zeros_like(self.jac.transpose(0, 2, 1))
        reach = REACH * np.maximum(np.abs(lam).max(axis=1, initial=0.0), 1e-300)
        for row in range(lam.shape[1]):
            for offset, weight in zip(*FOURTH, strict=True):
                moved = lam.copy()
                moved[:, row] += offset * reach
                force = self.terms.friction(along, self.compact, moved)
                out[:, :, row] += weight * force[:, 3:] / reach[:, None]
        return out


def tangent(terms: Terms, along: Along, inverse: Inverse, variants: Variants) -> Tangent:
    """How the motion changes with a number. Raises ModelError where no motion can follow it."""
    name = variants.number.name
    if inverse.redundant:
        along = along.take(slice(None))
        along.spread = inverse.spread(along.lam)
    own = by_number(terms, along, variants, inverse.compact)
    still = np.zeros_like(along.q)
    slight = OPENED * terms.packed.size / max(abs(variants.step) / STEP, 1e-300)
    q = inverse.solved(-own.position, name, slight)
    turned = along_direction(terms, along, q, still).velocity
    v = inverse.solved(-own.velocity - turned)
    moved = along_direction(terms, along, q, v)
    a = inverse.solved(-own.acceleration - moved.acceleration)
    load = own.load + moved.load - terms.inertia * a
    share = None if own.spread is None or moved.spread is None else own.spread + moved.spread
    return Tangent(q, v, a, inverse.multipliers(load, share))


def by_number(terms: Terms, along: Along, variants: Variants, compact: np.ndarray) -> Left:
    """How the equations change with a number at the held motion, whose compact J is (T, m, 6)."""
    weights = variants.weights / variants.step
    if along.spread is None and all(variant.same_places for variant in variants.variants):
        rows = np.zeros((len(along.t), len(terms.packed.ws.phi)))
        pushed = [_pushed(variant.terms, _as_met(along, variant), compact) for variant in variants.variants]
        return Left(rows, rows, rows, np.sum([w * part for w, part in zip(weights, pushed, strict=True)], axis=0), None)
    return combined([variant.terms.left(_as_met(along, variant)) for variant in variants.variants], weights)


def by_numbers(terms: Terms, along: Along, every: list[Variants], compact: np.ndarray) -> Left:
    """The same by P numbers along a simulation: (P, T, m), loads (P, T, 3 nb)."""
    count, rows = len(along.t), len(terms.packed.ws.phi)
    position, velocity, acceleration = np.zeros((3, len(every), count, rows))
    out = Left(position, velocity, acceleration, np.zeros((len(every), *along.q.shape)), None)
    for k, variants in enumerate(every):
        own, weights = variants.variants, variants.weights / variants.step
        pushed = terms.rough or not all(variant.same_loads for variant in own)
        if all(variant.same_places for variant in own):
            weight, inertia = (
                variants.slope(lambda v, key=key: getattr(v.terms, key)) for key in ("weight", "inertia")
            )
            if weight.any() or inertia.any():
                out.load[k] = weight - inertia * along.a
            if pushed:
                for w, variant in zip(weights, own, strict=True):
                    out.load[k] += w * variant.terms.forces(along, compact)
            continue
        for w, variant in zip(weights, own, strict=True):
            for whole, part in zip(out[:4], variant.terms.left(along, pushed=pushed), strict=False):
                assert whole is not None
                whole[k] += w * part
    return out


def _pushed(terms: Terms, along: Along, compact: np.ndarray) -> np.ndarray:
    return terms.forces(along, compact) + (terms.weight - terms.inertia * along.a)


def _as_met(along: Along, variant: Variant) -> Along:
    """The motion, with contacts as a variant meets them."""
    return along if along.approached is None else replace(along, approached=variant.terms.approaches(along))


def combined(parts: list[Left], weights: np.ndarray) -> Left:
    """The sum of parts by weights (k,) or (k, T, 1)."""
    return stacked(parts, lambda own: np.sum([w * part for w, part in zip(weights, own, strict=True)], axis=0))


def along_direction(
    terms: Terms,
    along: Along,
    q: np.ndarray,
    v: np.ndarray,
    order: tuple[np.ndarray, np.ndarray] = FOURTH,
    reach: float = REACH,
) -> Left:
    """Return residuals, differentiated along a direction q, v (T, 3 nb) of the motion at held numbers."""
    step = steps_along(terms, along, q, v, reach)
    offsets, weights = order
    if along.approached is None:
        step = step * shortened(terms, along, q, v, step)
        shifts, width = offsets[:, None, None] * step[:, None], q.shape[1]
        moved_q, moved_v = along.q + shifts * q, along.v + shifts * v
        left = terms.left(along, moved_q.reshape(-1, width), moved_v.reshape(-1, width))
        shape = len(offsets), len(along.t), -1
        parts = [left.each(lambda part, k=k: part.reshape(shape)[k]) for k in range(len(offsets))]
    else:
        parts, step = [], np.full(len(step), step.min())
        for offset in offsets:
            moved = along.moved(along.q + offset * step[0] * q, along.v + offset * step[0] * v)
            moved.approached = terms.approaches(moved)
            parts.append(terms.left(moved))
    return combined(parts, weights[:, None, None] / step[:, None])


def has_kinks(terms: Terms) -> bool:
    """Return True if forces may change within much less than the size of the mechanism, as those of contacts do."""
    loads = terms.loads
    return loads is not None and len(loads.interaction) + len(loads.user) > 0


def shortened(terms: Terms, along: Along, q: np.ndarray, v: np.ndarray, step: np.ndarray) -> np.ndarray:
    """(T,) parts of the steps (T,) along a direction q, v (T, 3 nb) within which forces change by little of themselves.

    A stiff contact yields by less than a usual step, which would go from one side of its kink to the other.
    """
    if not has_kinks(terms):
        return np.ones(len(step))
    own = np.abs(terms.applied(along)).max(axis=1)
    ahead, behind = (
        terms.applied(along.moved(along.q + side * step[:, None] * q, along.v + side * step[:, None] * v))
        for side in (1.0, -1.0)
    )
    change = np.abs(ahead - behind).max(axis=1)
    least = np.maximum(own, SLIGHT_LOAD * own.max(initial=0.0))
    return np.clip(
        PART_OF_LOAD * least / np.where(change > 0.0, change, np.inf),
        SHORTEST,
        1.0,
        where=change > 0.0,
        out=np.ones(len(step)),
    )


def along_directions(terms: Terms, along: Along, q: np.ndarray, v: np.ndarray, reach: np.ndarray) -> Change:
    """The same along D directions (D, T, 3 nb) at once, by central differences of second order that reach (T,) far."""
    out = Change(*(np.zeros((len(q), len(along.t), size)) for size in (*[len(terms.packed.ws.phi)] * 2, q.shape[2])))
    differences(terms, along, q, v, reach, np.flatnonzero(q.any(axis=(1, 2)) | v.any(axis=(1, 2))), out)
    return out


def differences(
    terms: Terms, along: Along, q: np.ndarray, v: np.ndarray, reach: np.ndarray, some: np.ndarray, out: Change,
    forces: bool = True,
) -> None:  # fmt: skip
    """Fill what belongs to directions ``some`` of D, (D, T, 3 nb), in ``out``; without ``forces`` as if none acted."""
    packed, (_, count, width) = terms.packed, q.shape
    rows, drives = len(packed.ws.phi), packed.drives(along.t)
    at_once = max(1, AT_ONCE // (2 * count * max(1, 6 * rows)))
    per_size, per_speed = per_scales(terms, along)
    for first in range(0, len(some), at_once):
        at = some[first : first + at_once]
        steps, (beside_q, beside_v) = np.empty((len(at), count)), np.empty((2, 2, len(at), count, width))
        displace(along.q, along.v, q, v, at, per_size, per_speed, reach, beside_q, beside_v, steps)
        beside = along.beside(beside_q.reshape(-1, width), beside_v.reshape(-1, width), terms.rough)
        _, gamma, compact = terms.rows(beside, np.concatenate([drives] * (2 * len(at))))
        force = terms.forces(beside, compact) if forces else np.zeros_like(beside.q)
        differ(packed.system.row_body, steps, at, beside.v, along.a, along.lam, compact, gamma, force, *out)


def per_scales(terms: Terms, along: Along) -> tuple[np.ndarray, float]:
    """Return factors that make coordinates (3 nb,), then speeds, parts of their sizes and of the fastest."""
    scale, fastest = _scales(terms, along)
    return 1.0 / scale, 1.0 / fastest


def _scales(terms: Terms, along: Along) -> tuple[np.ndarray, float]:
    """(3 nb,) sizes of coordinates, and the fastest speed in them."""
    scale = np.concatenate([np.ones(3), terms.packed.column_scale()])
    return scale, float(np.abs(along.v / scale).max(initial=0.0)) or 1.0


def steps_along(terms: Terms, along: Along, q: np.ndarray, v: np.ndarray, reach: float) -> np.ndarray:
    """(T,) steps of the direction q, v (T, 3 nb) that go as far as ``reach``."""
    scale, fastest = _scales(terms, along)
    far = np.maximum(np.abs(q / scale).max(axis=1), np.abs(v / scale).max(axis=1) / fastest)
    return reach / np.where(far > 0.0, far, 1.0)
