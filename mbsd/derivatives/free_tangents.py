"""How a free motion changes with numbers, between two events: the equations of motion differentiated along it.

    J q' = -dPhi/dp,  Z q' = s             s: changes of as many coordinates as the motion has freedoms
    M a' + E lam' = d(Q - M a - J^T lam),  J a' = -d(J a - gamma)     =>   s'' = A0 s + A1 s' + b

Z is a basis of the motions that J allows at one moment; where they have turned too far from it, another moment's is
taken. d(...) are differences along a direction of what the kernels evaluate. Rows that stick hold the place where they
stuck, whatever that is. Source: Haug, Ehle, Mech. Mach. Theory 17 (1982); Wehage, Haug 1982 (partitioning).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.derivatives.linear_motion import NODES, carried
from mbsd.derivatives.tangents import LOOSE, along_directions, refuse_large
from mbsd.derivatives.terms import Along, Left, Terms, stacked
from mbsd.derivatives.variants import TINY, Variants

REACH = 1e-5
"""How far differences along a direction go: sizes, rad, parts of the fastest speed."""
SLIGHT = 1e-3
"""Changes of the motion below this, in sizes, rad, and parts of the fastest speed, count as small."""
WORST = 30.0
"""Condition of [J; Z] beyond which another Z is taken."""


@dataclass
class Stretch:
    """Nodes of a motion between two events, with the rows that hold there."""

    along: Along
    rows: np.ndarray
    """Independent rows that hold."""
    dependent: list[tuple[int, int]]
    """Rows of sliding and of the gap whose normal force makes their friction."""


@dataclass
class Tangents:
    """By P numbers: how a motion changes with them. (P, T, 3 nb), (P, T, m)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    lam: np.ndarray

    def parts(self) -> tuple[np.ndarray, ...]:
        """All of it."""
        return self.q, self.v, self.a, self.lam

    def take(self, rows: Any) -> Tangents:
        """Some of the times."""
        return Tangents(*(part[:, rows] for part in self.parts()))


def joined(parts: list[Tangents]) -> Tangents:
    """One stretch after the other."""
    return Tangents(*(np.concatenate(own, axis=1) for own in zip(*(part.parts() for part in parts), strict=True)))


class FreeTangents:
    """Tangents along one stretch, from q' and v' (P, 3 nb) at its start.

    ``own``: how the equations change with each number at the held motion.
    """

    def __init__(self, terms: Terms, stretch: Stretch, every: list[Variants], own: list[Left]) -> None:
        self.terms, self.along, self.rows, self.every = terms, stretch.along, stretch.rows, every
        self.dependent, self.own = stretch.dependent, own
        packed = terms.packed
        refuse_large(terms, len(self.along.t))
        self.compact = terms.rows(self.along)[2]
        self.scale = packed.column_scale()
        self.jac = packed.spread(self.compact)
        self.held = self.jac[:, self.rows]

    def carry(self, q: np.ndarray, v: np.ndarray) -> tuple[Tangents, np.ndarray]:
        """Tangents at all nodes, and the error that each double step adds, as part of the largest."""
        count, first = len(self.along.t), 0
        errors: list[np.ndarray] = []
        parts: list[Tangents] = []
        while first < count - 1:
            basis, last = self._basis(first)
            made, error = _Piece(self, first, last, basis).carry(q, v)
            errors.append(error)
            q, v = made.q[:, -1], made.v[:, -1]
            parts.append(made if first == 0 else made.take(slice(1, None)))
            first = last
        return joined(parts), np.concatenate(errors)

    def _basis(self, first: int) -> tuple[np.ndarray, int]:
        """Z (f, n) at node ``first``, and the last node, whole double steps away, to which it serves."""
        scaled = self.held[first] * self.scale
        if not len(scaled):
            return np.diag(1.0 / self.scale), len(self.along.t) - 1
        size = np.abs(scaled).max(axis=1, keepdims=True)
        _, singular, right = np.linalg.svd(scaled / size)
        rank = int((singular > LOOSE * singular.max(initial=0.0)).sum())
        basis = right[rank:] / self.scale
        rows = self.held[first:] * self.scale
        rows = rows / np.maximum(np.linalg.norm(rows, axis=2, keepdims=True), 1e-300)
        square = np.concatenate([rows, np.broadcast_to(right[rank:], (len(rows), *right[rank:].shape))], axis=1)
        # of unit rows: its smallest singular value falls as motions turn away from the basis
        inverse = np.linalg.inv(square)
        far = np.abs(inverse).max(axis=(1, 2)) > WORST * np.abs(inverse[0]).max()
        beyond = int(np.argmax(far)) if far.any() else len(far)
        last = min(first + max(NODES, (beyond - 1) // NODES * NODES), len(self.along.t) - 1)
        return basis, last


class _Piece:
    """Nodes with one Z."""

    def __init__(self, whole: FreeTangents, first: int, last: int, basis: np.ndarray) -> None:
        at = slice(first, last + 1)
        self.terms, self.every, self.rows, self.dependent = whole.terms, whole.every, whole.rows, whole.dependent
        self.along, self.basis = whole.along.take(at), basis
        self.own = [own.each(lambda part: part[at]) for own in whole.own]
        self.jac, self.held = whole.jac[at], whole.held[at]
        count, n = len(self.along.t), self.jac.shape[2]
        square = np.concatenate([self.held, np.broadcast_to(basis, (count, *basis.shape))], axis=1)
        self.inverse = np.linalg.inv(square)
        self.fixed, self.free = self.inverse[:, :, : len(self.rows)], self.inverse[:, :, len(self.rows) :]
        self.f, self.n = len(basis), n
        self.inertia, self._scale = self.terms.inertia[3:], 1.0 / whole.scale
        self.effort = self._efforts(whole)
        self.mass = np.einsum("tnf,n,tng->tfg", self.free, self.inertia, self.free)

    def _efforts(self, whole: FreeTangents) -> np.ndarray | None:
        """(T, n, r) E of the rows that hold, where that is more than J^T: with friction in them; else None."""
        loads, along = self.terms.loads, self.along
        rough = loads is not None and len(loads.friction) > 0
        if not rough and not whole.dependent:
            return None
        effort, compact = self.held.transpose(0, 2, 1).copy(), self.terms.rows(along)[2]
        for way, gap in whole.dependent:
            effort[:, :, list(self.rows).index(gap)] += self.jac[:, way] * _ratio(along, way, gap)[:, None]
        if rough:
            for k, row in enumerate(self.rows):
                shift = np.zeros_like(along.lam)
                reach = REACH * np.maximum(np.abs(along.lam).max(axis=1), 1e-300)
                shift[:, row] = reach
                parts = [self.terms.friction(along, compact, along.lam + sign * shift) for sign in (1.0, -1.0)]
                effort[:, :, k] -= ((parts[0] - parts[1]) / (2 * reach[:, None]))[:, 3:]
        return effort

    # -- derivatives ------------------------------------------------------------------------------------------------

    def carry(self, q: np.ndarray, v: np.ndarray) -> tuple[Tangents, np.ndarray]:
        """See :meth:`FreeTangents.carry`."""
        f, numbers, count = self.f, len(self.own), len(self.along.t)
        free = np.moveaxis(self.free, 2, 0)  # (f, T, n)
        position, velocity, given = self._by_numbers(q)
        turned = self._speeds(np.concatenate([free, position]))
        none = np.zeros_like(free)
        positions = np.concatenate([free, none, position])
        velocities = np.concatenate([turned[:f], free, velocity + turned[f:]])
        change = self._change(positions, velocities)
        bend, load = change.acceleration, change.load
        bend[2 * f :] += given.acceleration
        load[2 * f :] += given.load
        rubbed = [self._rubbed(variants) for variants in self.every]
        for p, part in enumerate(rubbed):
            if part is not None:
                load[2 * f + p, :, 3:] -= np.einsum("tmn,tm->tn", self.jac, part)
        a, lam = self._accelerations(bend[..., self.rows], load[..., 3:])
        for p, part in enumerate(rubbed):
            if part is not None:
                lam[2 * f + p] += part
        matrix = np.zeros((count, 2 * f, 2 * f))
        matrix[:, :f, f:] = np.eye(f)
        bent = a @ self.basis.T  # (D, T, f)
        matrix[:, f:] = bent[: 2 * f].transpose(1, 2, 0)
        right = np.zeros((count, 2 * f, numbers))
        right[:, f:] = bent[2 * f :].transpose(1, 2, 0)
        begun = np.concatenate([self.basis @ q[:, 3:].T, self.basis @ v[:, 3:].T])
        y, error = carried(self.along.t, matrix, right, begun, self._slight())

        def total(part: np.ndarray) -> np.ndarray:
            return part[2 * f :] + np.einsum("tkp,ktn->ptn", y, part[: 2 * f])

        out = Tangents(_wide(total(positions)), _wide(total(velocities)), _wide(total(a)), total(lam))
        return out, error

    def _slight(self) -> np.ndarray:
        """(2 f, P) changes of s and s' that are rounding where the number changes by all of itself."""
        fastest = float(np.abs(self.along.v[:, 3:] * self._scale).max(initial=0.0)) or 1.0
        numbers = np.array([abs(variants.step) / TINY for variants in self.every])
        return SLIGHT * np.repeat([1.0, fastest], self.f)[:, None] / numbers

    def _change(self, q: np.ndarray, v: np.ndarray) -> Left:
        """Along directions (D, T, n)."""
        return along_directions(self.terms, self.along, _wide(q), _wide(v), REACH)

    def _speeds(self, q: np.ndarray) -> np.ndarray:
        """(D, T, n) v' that belongs to q' alone: Z v' = 0."""
        out = np.zeros_like(q)
        some = q.any(axis=(1, 2))
        if some.any() and len(self.rows):
            change = self._change(q[some], np.zeros_like(q[some]))
            out[some] = -np.einsum("tnr,dtr->dtn", self.fixed, change.velocity[..., self.rows])
        return out

    def _accelerations(self, bend: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """a' (D, T, n) and lam' (D, T, m) where the equations change by ``bend`` (D, T, r) and ``load`` (D, T, n)."""
        lam = np.zeros((*load.shape[:2], self.jac.shape[1]))
        if self.effort is not None:
            r = len(self.rows)
            matrix = np.zeros((load.shape[1], self.n + r, self.n + r))
            matrix[:, : self.n, : self.n] = np.diag(self.inertia)
            matrix[:, : self.n, self.n :] = self.effort
            matrix[:, self.n :, : self.n] = self.held
            right = np.concatenate([load, -bend], axis=2).transpose(1, 2, 0)
            solved = np.linalg.solve(matrix, right).transpose(2, 0, 1)
            lam[..., self.rows] = solved[..., self.n :]
            for way, gap in self.dependent:
                lam[..., way] = _ratio(self.along, way, gap) * lam[..., gap]
            return solved[..., : self.n], lam
        fixed = -np.einsum("tnr,dtr->dtn", self.fixed, bend)
        wanted = np.einsum("tnf,dtn->tfd", self.free, load - self.inertia * fixed)
        a = fixed + np.einsum("tnf,tfd->dtn", self.free, np.linalg.solve(self.mass, wanted))
        lam[..., self.rows] = np.einsum("tnr,dtn->dtr", self.fixed, load - self.inertia * a)
        return a, lam

    def _by_numbers(self, begun: np.ndarray) -> tuple[np.ndarray, np.ndarray, Left]:
        """q', v' (P, T, n) by numbers with s and s' at zero, and how the equations change with the numbers alone.

        ``begun`` (P, 3 nb) is q' at the first node.
        """
        own = stacked(self.own, np.stack)
        position = own.position[..., self.rows]
        opened = begun[:, 3:] @ self.held[0].T + position[:, 0]  # of what sticks: where it stuck changes too
        q = np.einsum("tnr,ptr->ptn", self.fixed, opened[:, None] - position)
        v = -np.einsum("tnr,ptr->ptn", self.fixed, own.velocity[..., self.rows])
        return q, v, own

    def _rubbed(self, variants: Variants) -> np.ndarray | None:
        """(T, m) how the friction of sliding contacts changes with their coefficients; None where it does not."""
        if not self.dependent:
            return None
        out, packed = np.zeros_like(self.along.lam), self.terms.packed
        for way, _ in self.dependent:
            number = packed.joints.index(packed.joint_of_row(way))
            slope = float(variants.slope(lambda v, k=number: np.array(v.terms.packed.joints[k].params["friction"])))
            out[:, way] = self.along.lam[:, way] * slope / packed.joints[number].params["friction"]
        return out


def _ratio(along: Along, way: int, gap: int) -> np.ndarray:
    """(T,) friction of a sliding contact by its normal force."""
    return along.lam[:, way] / np.where(along.lam[:, gap] == 0.0, 1.0, along.lam[:, gap])


def _wide(x: np.ndarray) -> np.ndarray:
    """(..., 3 nb) with ground's zeros before (..., n)."""
    return np.concatenate([np.zeros((*x.shape[:-1], 3)), x], axis=-1)
