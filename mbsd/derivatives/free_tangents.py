"""How a free motion changes with numbers, between two events: the equations of motion differentiated along it.

    J q' = -dPhi/dp,  Z q' = s             s: changes of as many coordinates as the motion has freedoms
    M a' + E lam' = d(Q - M a - J^T lam),  J a' = -d(J a - gamma)     =>   s'' = A0 s + A1 s' + b

Z is a basis of the motions that J allows at one moment; where they have turned too far from it, another moment's is
taken. d(...) are differences along a direction of what the kernels evaluate. Rows that stick hold the place where they
stuck, whatever that is. Source: Haug, Ehle, Mech. Mach. Theory 17 (1982); Wehage, Haug 1982 (partitioning).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from mbsd.derivatives.linear_motion import carried
from mbsd.derivatives.tangents import LOOSE, Tangent, along_direction, combined
from mbsd.derivatives.terms import Along, Left, Terms
from mbsd.derivatives.variants import SECOND, Variants

REACH = 1e-5
"""How far differences along a direction go: sizes, rad, parts of the fastest speed."""
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


class FreeTangents:
    """Tangents along one stretch, from q' and v' (P, 3 nb) at its start."""

    def __init__(self, terms: Terms, stretch: Stretch, every: list[Variants]) -> None:
        self.terms, self.along, self.rows, self.every = terms, stretch.along, stretch.rows, every
        self.dependent = stretch.dependent
        packed = terms.packed
        self.compact = terms.rows(self.along)[2]
        self.scale = packed.column_scale()
        self.jac = packed.spread(self.compact)
        self.held = self.jac[:, self.rows]

    def carry(self, q: np.ndarray, v: np.ndarray) -> tuple[list[Tangent], float]:
        """Tangents at all nodes by each number, and the largest error of the integration, as part of the largest."""
        count, first = len(self.along.t), 0
        parts: list[list[Tangent]] = [[] for _ in self.every]
        worst = 0.0
        while first < count - 1:
            basis, last = self._basis(first)
            piece = _Piece(self, first, last, basis)
            made, error = piece.carry(q, v)
            worst = max(worst, error)
            skip = 0 if first == 0 else 1
            for part, own in zip(parts, made, strict=True):
                part.append(_taken(own, slice(skip, None)))
            q, v = (np.stack([getattr(own, key)[-1] for own in made]) for key in ("q", "v"))
            first = last
        return [_joined(part) for part in parts], worst

    def _basis(self, first: int) -> tuple[np.ndarray, int]:
        """Z (f, n) at node ``first``, and the last node, an even number of nodes away, to which it serves."""
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
        last = min(first + max(2, (beyond - 1) // 2 * 2), len(self.along.t) - 1)
        return basis, last


class _Piece:
    """Nodes with one Z."""

    def __init__(self, whole: FreeTangents, first: int, last: int, basis: np.ndarray) -> None:
        at = slice(first, last + 1)
        self.terms, self.every, self.rows, self.dependent = whole.terms, whole.every, whole.rows, whole.dependent
        self.along, self.basis = whole.along.take(at), basis
        self.jac, self.held = whole.jac[at], whole.held[at]
        count, n = len(self.along.t), self.jac.shape[2]
        square = np.concatenate([self.held, np.broadcast_to(basis, (count, *basis.shape))], axis=1)
        self.inverse = np.linalg.inv(square)
        self.fixed, self.free = self.inverse[:, :, : len(self.rows)], self.inverse[:, :, len(self.rows) :]
        self.f, self.n = len(basis), n
        self.inertia = self.terms.inertia[3:]
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

    def carry(self, q: np.ndarray, v: np.ndarray) -> tuple[list[Tangent], float]:
        """See :meth:`FreeTangents.carry`."""
        f, count = self.f, len(self.along.t)
        a = np.zeros((count, 2 * f, 2 * f))
        a[:, :f, f:] = np.eye(f)
        zero = np.zeros((count, self.n))
        motions: list[tuple[np.ndarray, ...]] = []
        for k in range(2 * f):
            along = self.free[:, :, k % f]
            speeds = self._speeds(along) if k < f else along
            positions = along if k < f else zero
            motions.append((positions, speeds, *self._accelerations(self._change(positions, speeds))))
            a[:, f:, k] = motions[-1][2] @ self.basis.T
        own = [self._by_number(variants, q[p]) for p, variants in enumerate(self.every)]
        b = np.zeros((count, 2 * f, len(own)))
        for p, part in enumerate(own):
            b[:, f:, p] = part[2] @ self.basis.T
        begun = np.concatenate([self.basis @ q[:, 3:].T, self.basis @ v[:, 3:].T])
        y, error = carried(self.along.t, a, b, begun)
        out = []
        for p, part in enumerate(own):
            total = [own_part + sum(y[:, k, p, None] * motions[k][c] for k in range(2 * f))
                     for c, own_part in enumerate(part)]  # fmt: skip
            out.append(Tangent(*(_wide(x) for x in total[:3]), total[3]))
        return out, error

    def _change(self, q: np.ndarray, v: np.ndarray) -> Left:
        """Along a direction (T, n)."""
        return along_direction(self.terms, self.along, _wide(q), _wide(v), SECOND, REACH)

    def _speeds(self, q: np.ndarray) -> np.ndarray:
        """(T, n) v' that belongs to q' alone: Z v' = 0."""
        return -np.einsum("tnr,tr->tn", self.fixed, self._change(q, np.zeros_like(q)).velocity[:, self.rows])

    def _accelerations(self, left: Left) -> tuple[np.ndarray, np.ndarray]:
        """a' (T, n) and lam' (T, m) where the equations change by ``left``."""
        load, lam = left.load[:, 3:], np.zeros_like(self.along.lam)
        fixed = -np.einsum("tnr,tr->tn", self.fixed, left.acceleration[:, self.rows])
        if self.effort is not None:
            r = len(self.rows)
            matrix = np.zeros((len(load), self.n + r, self.n + r))
            matrix[:, : self.n, : self.n] = np.diag(self.inertia)
            matrix[:, : self.n, self.n :] = self.effort
            matrix[:, self.n :, : self.n] = self.held
            right = np.concatenate([load, -left.acceleration[:, self.rows]], axis=1)
            solved = np.linalg.solve(matrix, right[..., None])[..., 0]
            lam[:, self.rows] = solved[:, self.n :]
            for way, gap in self.dependent:
                lam[:, way] = _ratio(self.along, way, gap) * lam[:, gap]
            return solved[:, : self.n], lam
        wanted = np.einsum("tnf,tn->tf", self.free, load - self.inertia * fixed)
        a = fixed + np.einsum("tnf,tf->tn", self.free, np.linalg.solve(self.mass, wanted[..., None])[..., 0])
        lam[:, self.rows] = np.einsum("tnr,tn->tr", self.fixed, load - self.inertia * a)
        return a, lam

    def _by_number(self, variants: Variants, begun: np.ndarray) -> tuple[np.ndarray, ...]:
        """q', v', a', lam' by a number with s and s' at zero; ``begun`` (3 nb,) is q' at the first node."""
        parts = [variant.terms.left(self.along) for variant in variants.variants]
        own = combined(parts, variants.weights / variants.step)
        position = own.position[:, self.rows]
        opened = self.held[0] @ begun[3:] + position[0]  # of what sticks: where it stuck changes too
        q = np.einsum("tnr,tr->tn", self.fixed, opened - position)
        v = -np.einsum("tnr,tr->tn", self.fixed, own.velocity[:, self.rows])
        left = own
        if q.any():
            v += self._speeds(q)
        if q.any() or v.any():
            change = self._change(q, v)
            left = Left(own.position, own.velocity, own.acceleration + change.acceleration,
                        own.load + change.load, None)  # fmt: skip
        rubbed = self._rubbed(variants)
        if not rubbed.any():
            return (q, v, *self._accelerations(left))
        left.load[:, 3:] -= np.einsum("tmn,tm->tn", self.jac, rubbed)
        a, lam = self._accelerations(left)
        return q, v, a, lam + rubbed

    def _rubbed(self, variants: Variants) -> np.ndarray:
        """(T, m) how the friction of sliding contacts changes with their coefficients."""
        out, packed = np.zeros_like(self.along.lam), self.terms.packed
        for way, _ in self.dependent:
            number = packed.joints.index(packed.joint_of_row(way))
            slope = float(variants.slope(lambda v, k=number: np.float64(v.terms.packed.joints[k].params["friction"])))
            out[:, way] = self.along.lam[:, way] * slope / packed.joints[number].params["friction"]
        return out


def _ratio(along: Along, way: int, gap: int) -> np.ndarray:
    """(T,) friction of a sliding contact by its normal force."""
    return along.lam[:, way] / np.where(along.lam[:, gap] == 0.0, 1.0, along.lam[:, gap])


def _wide(x: np.ndarray) -> np.ndarray:
    """(T, 3 nb) with ground's zeros before (T, n)."""
    return np.concatenate([np.zeros((len(x), 3)), x], axis=1)


def _taken(tangent: Tangent, at: slice) -> Tangent:
    return Tangent(tangent.q[at], tangent.v[at], tangent.a[at], tangent.lam[at])


def _joined(parts: list[Tangent]) -> Tangent:
    return Tangent(*(np.concatenate([getattr(part, key) for part in parts]) for key in ("q", "v", "a", "lam")))
