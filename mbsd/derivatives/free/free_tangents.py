"""How a free motion changes with numbers, between two events: the equations of motion differentiated along it.

    J q' = -dPhi/dp,  Z q' = s             s: changes of as many coordinates as the motion has freedoms
    M a' + E lam' = d(Q - M a - J^T lam),  J a' = -d(J a - gamma)     =>   s'' = A0 s + A1 s' + b

Z is a basis of the motions that J allows at one moment; where they have turned too far from it, another moment's is
taken. d(...) are differences along a direction of what the kernels evaluate. Rows that stick hold the place where they
stuck, whatever that is. Source: Haug, Ehle, Mech. Mach. Theory 17 (1982); Wehage, Haug 1982 (partitioning).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from mbsd.arrays.curve_branches import CurveBranches
from mbsd.arrays.laws import pack_laws
from mbsd.arrays.loads import pack_loads
from mbsd.arrays.outline_pairs import kept_pairs
from mbsd.derivatives.driven.differences import accelerate_along, close, combine
from mbsd.derivatives.driven.tangents import (
    along_directions,
    by_numbers,
    combined,
    differences,
    has_kinks,
    per_scales,
    refuse_large,
    shortened,
    steps_along,
)
from mbsd.derivatives.free.differentiated import Made, Nodes, Own, Scratch, differentiate
from mbsd.derivatives.free.explicit_time import Stencil, stencil_at
from mbsd.derivatives.free.linear_motion import NODES, ByTime, carried
from mbsd.derivatives.numbers.terms import Along, Change, Left, Terms, stacked
from mbsd.derivatives.numbers.variants import Variants
from mbsd.kinematics.pose.mobility import better_rows

REACH = 3e-6
"""How far differences along a direction go: sizes, rad, parts of the fastest speed."""
SLIGHT = 1e-3
"""Changes of the motion below this, in sizes, rad, and parts of the fastest speed, count as small."""
AT_ONCE = 800
"""Nodes at once."""
WORST = 30.0
"""Condition of [J; Z] beyond which another Z is taken."""


@dataclass
class Stretch:
    """T times of a motion between two events, nodes and others, with the rows that hold there."""

    along: Along
    compact: np.ndarray
    """(T, m, 6) J."""
    rows: np.ndarray
    """Independent rows that hold."""
    holding: np.ndarray
    """All rows that hold."""
    dependent: list[tuple[int, int]]
    """Rows of sliding and of the gap whose normal force makes their friction."""
    asked: np.ndarray
    """(T,) whether tangents are wanted there."""
    nodes: np.ndarray
    """(T,) whether it is one of the nodes of whole steps, the first and the last among them."""
    autonomous: bool = False
    """True if time itself changes nothing, so that the motion's own rates are one of its changes."""
    passing: np.ndarray | None = None
    """(T,) True where the motion passes a toggle, by ``find_toggles``; None is nowhere."""
    solved: bool = True
    """True if accelerations and multipliers are known; else accelerations are estimates."""
    own: Left | None = None
    """How the equations change with P numbers at the held motion, (P, T, ...), where that is known."""


@dataclass
class Tangents:
    """By P numbers: how a motion changes with them at R times. (P, R, 3 nb), (P, R, m)."""

    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    lam: np.ndarray

    def parts(self) -> tuple[np.ndarray, ...]:
        """All of it."""
        return self.q, self.v, self.a, self.lam


@dataclass
class Carried:
    """Tangents along some nodes."""

    asked: Tangents
    """Where they were asked for."""
    q: np.ndarray
    """(P, 3 nb) q' at the last node."""
    v: np.ndarray
    lam: np.ndarray
    """(P, m) lam' there."""
    errors: np.ndarray
    """(d, 3) what each step adds, and what it leaves out inside alone, as parts of the largest so far; and the part of
    them at the last node that errors of the motion leave unknown."""
    off: float
    """By how much accelerations were other than about what was known, as part of the largest."""


def joined(parts: list[Tangents]) -> Tangents:
    """One stretch after the other."""
    return Tangents(*(np.concatenate(own, axis=1) for own in zip(*(part.parts() for part in parts), strict=True)))


def slight_changes(f: int, fastest: float, sizes: np.ndarray) -> np.ndarray:
    """(2 f, P) changes of s and s' that are rounding where numbers change by all of their ``sizes`` (P,)."""
    return SLIGHT * np.repeat([1.0, fastest], f)[:, None] / sizes


def at_rows(terms: Terms, stretch: Stretch, every: list[Variants], basis: np.ndarray, y: np.ndarray) -> Tangents:
    """Tangents at all times of a stretch, from s = Z q' for Z = ``basis`` (f, n) and s' there: y (T, 2 f, P)."""
    whole = FreeTangents(terms, stretch, every)
    return _Piece(whole, 0, whole.rows, basis, whole.inverses(basis)).at_all(y)


class FreeTangents:
    """Tangents along one stretch, from q' and v' (P, 3 nb) at its start."""

    def __init__(self, terms: Terms, stretch: Stretch, every: list[Variants]) -> None:
        self.terms, self.along, self.rows, self.every = terms, stretch.along, stretch.rows, every
        self.dependent, self.asked, self.compact = stretch.dependent, stretch.asked, stretch.compact
        self.nodes, self.solved, self.own = stretch.nodes, stretch.solved, stretch.own
        self.autonomous, self.stencil = stretch.autonomous, None
        if stretch.passing is not None and stretch.passing.any() and not stretch.autonomous:
            self.stencil = stencil_at(self.along.t, self.along.t[self.nodes], stretch.passing)
        packed = terms.packed
        refuse_large(terms, len(self.along.t))
        self.scale = packed.column_scale()
        self.jac = packed.spread(stretch.compact)
        self.holding = stretch.holding

    def carry(self, q: np.ndarray, v: np.ndarray) -> Carried:
        """Tangents where they are asked for, and at the end."""
        count, first = len(self.along.t), 0
        parts: list[Carried] = []
        while first < count - 1:
            rows = self._rows(first)
            basis, inverse = self._basis(first, rows)
            parts.append(_Piece(self, first, rows, basis, inverse).carry(q, v))
            q, v = parts[-1].q, parts[-1].v
            first += len(inverse) - 1
        errors, off = np.concatenate([part.errors for part in parts]), max(part.off for part in parts)
        return Carried(joined([part.asked for part in parts]), q, v, parts[-1].lam, errors, off)

    def _rows(self, first: int) -> np.ndarray:
        """Return the rows that hold from node ``first`` on: those farthest from a toggle, where some repeat others.

        Rods of a platform that repeat each other have toggles, if one row is left out, that the platform has not.
        """
        if len(self.rows) == len(self.holding) or self.dependent:
            return self.rows
        scaled = self.jac[first] * self.terms.packed.row_scale()[:, None] * self.scale
        better = better_rows(scaled[self.holding], np.searchsorted(self.holding, self.rows), 1.0)
        return self.rows if better is None else self.holding[better]

    def _basis(self, first: int, rows: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Z (f, n) at node ``first``, and inverses of [J; Z] up to the last node, whole steps on, that it serves."""
        scaled, count = self.jac[first, rows] * self.scale, len(self.along.t) - first
        if not len(scaled):
            return np.diag(1.0 / self.scale), np.broadcast_to(np.diag(self.scale), (count, *2 * self.scale.shape))
        size = np.abs(scaled).max(axis=1, keepdims=True)
        beyond = np.linalg.svd(scaled / size)[2][len(scaled) :]
        inverse, norms = self._inverted(first, rows, beyond)
        # of unit rows: its smallest singular value falls as motions turn away from the basis
        size = np.abs(inverse).max(axis=(1, 2))
        far = size > WORST * size[0]
        edges = np.flatnonzero(self.nodes[first:])[::NODES]
        last = int(edges[max(1, np.searchsorted(edges, np.argmax(far)) - 1)] if far.any() else edges[-1])
        return beyond / self.scale, self._in_sizes(inverse[: last + 1], norms[: last + 1])

    def inverses(self, basis: np.ndarray) -> np.ndarray:
        """(T, n, n) inverses of [J; Z], Z = ``basis`` (f, n), at all times."""
        return self._in_sizes(*self._inverted(0, self.rows, basis * self.scale))

    def _inverted(self, first: int, rows: np.ndarray, scaled: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Inverses of [J; Z] in sizes, J by unit rows, from node ``first`` on, and what makes rows of J unit rows."""
        rank = len(self.scale) - len(scaled)
        square = np.empty((len(self.along.t) - first, len(self.scale), len(self.scale)))
        square[:, rank:] = scaled
        np.multiply(self.jac[first:, rows], self.scale, out=square[:, :rank])
        norms = np.maximum(np.sqrt(np.einsum("trn,trn->tr", square[:, :rank], square[:, :rank])), 1e-300)
        square[:, :rank] /= norms[..., None]
        return np.linalg.inv(square), norms

    def _in_sizes(self, inverse: np.ndarray, norms: np.ndarray) -> np.ndarray:
        inverse = inverse * self.scale[:, None]
        inverse[:, :, : norms.shape[1]] /= norms[:, None]
        return inverse


class _Piece:
    """Nodes with one Z."""

    def __init__(
        self, whole: FreeTangents, first: int, rows: np.ndarray, basis: np.ndarray, inverse: np.ndarray
    ) -> None:
        at = slice(first, first + len(inverse))
        self.terms, self.every, self.rows, self.dependent = whole.terms, whole.every, rows, whole.dependent
        self.along, self.basis = whole.along.take(at), basis
        self.own = None if whole.own is None else whole.own.each(lambda part: part[:, at])
        self.compact = whole.compact[at]
        asked = whole.asked[at].copy()
        asked[0] &= first == 0
        self.asked, self.nodes = np.flatnonzero(asked), np.flatnonzero(whole.nodes[at])
        self.jac, self.held = whole.jac[at], whole.jac[at][:, rows]
        self.fixed = np.ascontiguousarray(inverse[:, :, : len(self.rows)])
        self.free = np.ascontiguousarray(inverse[:, :, len(self.rows) :])
        self.f, self.n = len(basis), inverse.shape[1]
        self.autonomous = whole.autonomous
        self.stencil = None if whole.stencil is None else whole.stencil.sliced(at)
        self.inertia, self._scale = self.terms.inertia[3:], 1.0 / whole.scale
        self.reach = self._reaches()
        self.effort = self._efforts(whole)
        self.off = 0.0 if whole.solved else self._solve()

    def _solve(self) -> float:
        """Find accelerations and multipliers; returns by how much accelerations change, as part of the largest."""
        about, (_, gamma, compact) = self.along.a, self.terms.rows(self.along)
        load = self.terms.forces(self.along, compact) + self.terms.weight
        a, lam = self._accelerations(-gamma[None], load[None])
        a = _wide(a[0])
        self.along = replace(self.along, a=a, lam=lam[0])
        return float(np.abs(a - about).max(initial=0.0)) / max(float(np.abs(a).max(initial=0.0)), 1e-300)

    def _reaches(self) -> np.ndarray:
        """(T,) how far differences go: less where a contact is stiff."""
        part = np.ones(len(self.along.t))
        if has_kinks(self.terms):
            for i in range(self.f):
                way = _wide(self.free[:, :, i])
                step = steps_along(self.terms, self.along, way, np.zeros_like(way), REACH)
                part = np.minimum(part, shortened(self.terms, self.along, way, np.zeros_like(way), step))
        return REACH * part

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

    def carry(self, q: np.ndarray, v: np.ndarray) -> Carried:
        """See :meth:`FreeTangents.carry`."""
        last, asked, numbers = len(self.along.t) - 1, len(self.asked), len(self.every)
        at = self.asked if asked and self.asked[-1] == last else np.append(self.asked, last)
        plain = self.effort is None and can_differentiate(self.terms)
        first = q if self.stencil is None else np.concatenate([q, self.along.v[:1]])
        made = self._node_by_node(first, at) if plain else self._in_arrays(first, at)
        begun = np.concatenate([self.basis @ q[:, 3:].T, self.basis @ v[:, 3:].T])
        nodes = self.nodes
        fastest = float(np.abs(self.along.v[:, 3:] * self._scale).max(initial=0.0)) or 1.0
        line = carried(
            self.along.t[nodes],
            made.matrix[nodes],
            made.right[nodes, :, :numbers],
            begun,
            slight_changes(self.f, fastest, np.array([variants.size for variants in self.every])),
            flow=self._rates() if self.autonomous or self.stencil is not None else None,
            by_time=None
            if self.stencil is None
            else ByTime(made.right[nodes, :, numbers], self.stencil.passing[nodes]),
        )
        y, parts = line.at(self.along.t[at]), [np.zeros((len(self.every), *part.shape[1:])) for part in made[2:]]
        for out, part in zip(parts, made[2:], strict=True):
            combine(y, part, out)
        q, v, _, lam = (part[:, -1] for part in parts)
        errors = line.errors_of(self.along.t[self.asked])
        return Carried(Tangents(*(part[:, :asked] for part in parts)), q, v, lam, errors, self.off)

    def _rates(self) -> np.ndarray:
        """(8 d + 1, 2 f) rates of the motion itself at the nodes, in coordinates of the basis."""
        along = self.along.take(self.nodes)
        return np.concatenate([along.v[:, 3:] @ self.basis.T, along.a[:, 3:] @ self.basis.T], axis=1)

    def at_all(self, y: np.ndarray) -> Tangents:
        """Tangents at all times, from s and s' there: y (T, 2 f, P)."""
        made = self._node_by_node(None, np.arange(len(self.along.t)))
        parts = [np.zeros((len(self.every), *part.shape[1:])) for part in made[2:]]
        for out, part in zip(parts, made[2:], strict=True):
            combine(y, part, out)
        return Tangents(*parts)

    def _node_by_node(self, begun: np.ndarray | None, at: np.ndarray) -> Made:
        """Differentiate by the kernel, some nodes at once, so that what is known of them stays in the cache."""
        parts: list[Made] = []
        along, per_scale, first = self.along, per_scales(self.terms, self.along), None
        drives = self.terms.packed.drives(along.t)
        for begin in range(0, len(along.t), AT_ONCE):
            here = slice(begin, begin + AT_ONCE)
            own = self._own(here)
            if first is None:
                first = np.zeros((len(self.every), 1, self.jac.shape[1])) if begun is None else self._first(begun, own)
            position, some = self._opened(own, first)
            known = (along.t, along.q, along.v, along.a, along.lam, drives, self.fixed, self.free)
            inside = at[(at >= begin) & (at < begin + AT_ONCE)] - begin
            slots = np.full(len(along.t[here]), -1)
            slots[inside] = np.arange(len(inside))
            held = (np.ascontiguousarray(part[here]) for part in known)
            nodes = Nodes(*held, rows=self.rows, reach=self.reach[here], slots=slots)
            changes = Own(position, own.velocity, own.acceleration, own.load, some)
            with kept_pairs(self.terms.packed, None if along.pairs is None else along.pairs[0]):
                parts.append(differentiated(self.terms, nodes, changes, *per_scale))
        if len(parts) == 1:
            return parts[0]
        joined_parts = zip(*parts, strict=True)
        return Made(*(np.concatenate(part, axis=0 if k < 2 else 1) for k, part in enumerate(joined_parts)))

    def _in_arrays(self, begun: np.ndarray, at: np.ndarray) -> Made:
        """Differentiate all nodes at once in numpy, for friction in joints and contacts that slide as well.

        There accelerations depend on multipliers in return, so that each node is one dense system of both. The kernel
        solves for accelerations first and multipliers then, and is several times as fast; so both routes stay.
        """
        f, count = self.f, len(self.along.t)
        own = self._own(slice(None))
        numbers = len(own.load)
        position, some = self._opened(own, self._first(begun, own))
        positions, velocities = np.zeros((2, 2 * f + numbers, count, 3 + self.n))
        positions[:f, :, 3:] = velocities[f : 2 * f, :, 3:] = np.moveaxis(self.free, 2, 0)
        close(self.fixed, self.rows, some, position, positions[2 * f :])
        self._speeds(positions, velocities, some, own)
        change = along_directions(self.terms, self.along, positions, velocities, self.reach)
        bend, load = change.acceleration, change.load
        bend[2 * f :] += own.acceleration
        load[2 * f :] += own.load
        rubbed = [self._rubbed(variants) for variants in self.every]
        for p, part in enumerate(rubbed):
            if part is not None:
                load[2 * f + p, :, 3:] -= np.einsum("tmn,tm->tn", self.jac, part)
        a, lam = self._accelerations(bend, load)
        for p, part in enumerate(rubbed):
            if part is not None:
                lam[2 * f + p] += part
        bent = (a @ self.basis.T).transpose(1, 2, 0)  # (T, f, D)
        return Made(
            bent[..., : 2 * f],
            bent[..., 2 * f :],
            *(np.ascontiguousarray(p[:, at]) for p in (positions, velocities, _wide(a), lam)),
        )

    def _own(self, at: slice) -> Left:
        """How the equations change with the numbers at some nodes of the held motion, and then, if asked, with time."""
        if self.own is not None:
            own = self.own.each(lambda part: part[:, at])
        else:
            own = by_numbers(self.terms, self.along.take(at), self.every, self.compact[at])
        return (
            own if self.stencil is None else stacked([own, self._by_time(self.stencil.sliced(at), at)], np.concatenate)
        )

    def _by_time(self, stencil: Stencil, at: slice) -> Left:
        """Return (1, T, ...) slopes of the equations by time alone at some nodes of the held motion."""
        along = self.along.take(at)
        parts = [self.terms.left(replace(along, t=t)) for t in stencil.times]
        return combined(parts, stencil.weights[..., None]).each(lambda part: part[None])

    def _first(self, begun: np.ndarray, own: Left) -> np.ndarray:
        """(P, 1, m) what J q' and the numbers leave open at the first node, q' being ``begun`` (P, 3 nb) there."""
        first = np.zeros((len(begun), 1, self.jac.shape[1]))
        first[:, 0, self.rows] = begun[:, 3:] @ self.held[0].T + own.position[:, 0, self.rows]
        return first

    def _opened(self, own: Left, first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(P, T, m) what the numbers open of J q' with s at zero, and those that change places or speeds.

        Of what sticks, where it stuck changes too: that is ``first``.
        """
        moved = [part.any(axis=(1, 2)) for part in (first, own.position, own.velocity)]
        return (own.position - first if first.any() else own.position), np.flatnonzero(np.logical_or.reduce(moved))

    def _speeds(self, positions: np.ndarray, out: np.ndarray, numbers: np.ndarray, own: Left) -> None:
        """Fill out (2 f + P, T, 3 nb) with v' that belongs to positions, and to ``numbers``: Z v' = 0."""
        some, rows = np.concatenate([np.arange(self.f), 2 * self.f + numbers]), self.jac.shape[1]
        change = Change(*(np.zeros((len(out), len(self.along.t), size)) for size in (rows, rows, 3 + self.n)))
        still = np.zeros_like(positions)
        differences(self.terms, self.along, positions, still, self.reach, some, change, forces=False)
        change.velocity[2 * self.f :] += own.velocity
        close(self.fixed, self.rows, some, change.velocity, out)

    def _accelerations(self, bend: np.ndarray, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """a' (D, T, n), lam' (D, T, m) where the equations change by ``bend`` (D, T, m) and ``load`` (D, T, 3 nb)."""
        lam, a = np.zeros((*load.shape[:2], self.jac.shape[1])), np.empty((*load.shape[:2], self.n))
        if self.effort is None:
            scratch = np.zeros((self.f + 1, max(1, self.f))), np.zeros((self.f, len(self.rows)))
            accelerate_along(self.fixed, self.free, self.inertia, self.rows, bend, load, *scratch, a, lam)
            return a, lam
        r = len(self.rows)
        matrix = np.zeros((load.shape[1], self.n + r, self.n + r))
        matrix[:, : self.n, : self.n] = np.diag(self.inertia)
        matrix[:, : self.n, self.n :] = self.effort
        matrix[:, self.n :, : self.n] = self.held
        right = np.concatenate([load[..., 3:], -bend[..., self.rows]], axis=2).transpose(1, 2, 0)
        solved = np.linalg.solve(matrix, right).transpose(2, 0, 1)
        lam[..., self.rows] = solved[..., self.n :]
        for way, gap in self.dependent:
            lam[..., way] = _ratio(self.along, way, gap) * lam[..., gap]
        return np.ascontiguousarray(solved[..., : self.n]), lam

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


def differentiated(terms: Terms, nodes: Nodes, own: Own, per_size: np.ndarray, per_speed: float) -> Made:
    """Return what ``differentiate`` makes."""
    packed, (count, n, f), numbers = terms.packed, nodes.free.shape, len(own.load)
    rows, width = nodes.lam.shape[1], nodes.q.shape[1]
    ways, first = 2 * f + len(own.moving), f + len(own.moving)
    scratch = Scratch(
        np.zeros(width), np.zeros(ways), np.zeros((ways + 1, width)), np.zeros((ways + 1, width)),
        np.zeros((ways + 1, width)), np.zeros((ways + 1, rows)), np.zeros(rows), np.zeros(n),
        np.zeros((f + 1, max(1, f))), np.zeros((f, len(nodes.rows))), np.zeros((2 * first, width)),
        np.zeros((2 * ways, width)),
        np.zeros((2 * ways, width)), np.zeros((2 * ways, width)), np.zeros(2 * ways), np.zeros(2 * ways),
        np.zeros((2 * ways, *nodes.drives.shape[1:])), np.zeros((2 * ways, rows)), np.zeros((2 * ways, rows)),
        np.zeros((2 * ways, rows, 6)),
    )  # fmt: skip
    all_ways = 2 * f + numbers
    made = Made(
        np.zeros((count, f, 2 * f)), np.zeros((count, f, numbers)),
        *(np.zeros((all_ways, int((nodes.slots >= 0).sum()), size)) for size in (width, width, width, rows)),
    )  # fmt: skip
    loads = pack_loads(packed) if terms.loads is None else terms.loads
    laws = pack_laws(()) if terms.laws is None else terms.laws
    differentiate(
        packed.system, loads, laws, packed.ws, nodes, own, terms.inertia[3:], per_size, per_speed, scratch, made,
    )  # fmt: skip
    packed.specials.check()
    return made


def can_differentiate(terms: Terms) -> bool:
    """Return True if ``differentiate`` knows the mechanism: no friction in joints, and no curve that crosses itself."""
    return not terms.rough and not CurveBranches(terms.packed)
