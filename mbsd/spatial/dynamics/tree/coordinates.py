"""A mechanism in the coordinates of a spanning tree: its arrays, and its start from a closed pose."""

from __future__ import annotations

import itertools
import math
from collections import Counter
from typing import Any

import numpy as np

from mbsd.equations.interactions.switching import WIDTH
from mbsd.spatial.arrays.packing import Packed, pack
from mbsd.spatial.dynamics.envelope import OWN, Envelope, Factors
from mbsd.spatial.dynamics.formulation import Switches
from mbsd.spatial.dynamics.tree import arrays
from mbsd.spatial.dynamics.tree.arrays import Tree, work_for
from mbsd.spatial.dynamics.tree.formulation import TreeDynamics, begin
from mbsd.spatial.dynamics.tree.spanning import Link, spanning_tree
from mbsd.spatial.model.body import Marker
from mbsd.spatial.model.joint import Joint
from mbsd.spatial.model.mechanism import Model
from mbsd.spatial.model.rotation import euler_parameters, product, rotation_matrix
from mbsd.spatial.model.rows import Row, Term

CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])
ABOUT_Z = np.array([0.0, 0.0, 0.0, 1.0])
CROSS = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])
"""Axes of the second marker of a universal joint in those of the first, at turns of zero."""


class TreeCoordinates:
    """A spanning tree of a mechanism with its start."""

    def __init__(self, m: Model, packed: Packed, q: np.ndarray, v: np.ndarray, turns: np.ndarray, rank: int) -> None:
        """Start from a closed pose q (3 + 7 n,) with velocities v (3 + 6 n,) in the world and counted turns.

        ``rank``: rows of all joints and drivers that are independent.
        """
        self.packed = packed
        self.links = spanning_tree(packed.bodies, packed.passive_joints)
        self._first: dict[int, tuple[int, int]] = {}
        entries, rates = 3, 3
        for link in self.links:
            self._first[link.body] = entries, rates
            entries, rates = entries + arrays.COORDINATES[link.kind], rates + arrays.RATES[link.kind]
        self.entries, self.rates = entries, rates - 3
        jointed = [(link.joint, link) for link in self.links if link.joint is not None]
        self._held = {id(joint) for joint, _ in jointed}
        self._between_markers = {(id(joint.i), id(joint.j)): link for joint, link in jointed}
        self.cut = pack(m, rows_of=self._rows_of)
        self.ws = self.cut.ws
        self.used = rank - (packed.freedoms - self.rates)
        self._turn_sources = self._sources_of_turns()
        self.tree = self._tree(q)
        for n, (source, is_cut) in enumerate(self._turn_sources):
            if is_cut:
                self.ws.guess[source] = turns[n]
        self.work = work_for(len(packed.bodies), self.rates, len(self.ws.phi))
        self.y = np.zeros((2, entries))
        self._set_coordinates(q, turns)
        self._v = v

    def dynamics(self, laws: Any, turns: np.ndarray, drive: np.ndarray) -> TreeDynamics:
        """Return the arrays of a run with laws; turns (T, turns) takes counted angles, drive are laws at the start."""
        used, rows = self.used, len(self.ws.phi)
        held = self.cut.system.held
        per_size = np.zeros(self.entries)
        per_size[3 : 3 + self.rates] = [1.0 / self.packed.size if part else 1.0 for part in self._metres(rates=True)]
        dyn = TreeDynamics(
            system=self.cut.system,
            laws=laws,
            loads=Switches(np.zeros((1, WIDTH))),
            tree=self.tree,
            work=self.work,
            envelope=Envelope(np.arange(used), np.zeros(used, np.int64), *np.zeros((2, 0, 5), np.int64)),
            factors=Factors(np.zeros((used, used)), np.zeros(used), np.zeros((2, used))),
            chosen=np.ones(used),
            per_size=per_size,
            pushed=np.zeros(rows),
            limit=np.array([OWN if used < held else 0.0]),
            turns=turns,
        )
        begin(dyn, self.ws, self.y[0], self.y[1], drive)
        self._set_rates()
        return dyn

    def check_callbacks(self, accepted: bool) -> None:
        """Raise what functions of the user raised; see Packed."""
        self.cut.check_callbacks(accepted)

    def nanoseconds(self) -> float:
        """Return about what an evaluation takes on one processor (ns); see docs/decisions/space/formulation.md."""
        tree, rates = self.tree, self.tree.index[:, arrays.COUNT]
        ends = itertools.pairwise(tree.begin[: self.cut.system.held + 1].tolist())
        paths = Counter(tuple(tree.path[first:last].tolist()) for first, last in ends)
        total = 160.0 * len(self.links) + 40.0 * self.rates
        before: list[tuple[set[int], int]] = []
        for path, count in paths.items():
            columns, on = int(rates[list(path)].sum()), set(path)
            meeting = 0.5 * (count + 1) + sum(rows for other, rows in before if not on.isdisjoint(other))
            total += count * (130.0 + columns * (15.0 + 2.5 * meeting))
            before.append((on, count))
        return total

    def allowed(self, tolerance: float) -> tuple[np.ndarray, np.ndarray]:
        """Return absolute and growing tolerances (2, 3 + nq) of the state."""
        absolute = np.full((2, self.entries), tolerance)
        growing = absolute.copy()
        for part in range(2):
            metres = np.array(self._metres(rates=part == 1), bool)
            absolute[part, 3 : 3 + len(metres)][metres] *= self.packed.size
        growing[0, 3:][~np.array(self._metres(rates=False), bool)] = 0.0  # a turn is no less exact after many
        return absolute, growing

    def to_world(self, q: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Return v (T, 3 + 6 n), whose rotations are in the world already."""
        del q
        return np.ascontiguousarray(v)

    def _metres(self, rates: bool) -> list[bool]:
        """Return True for each coordinate or rate that is a length."""
        out: list[bool] = []
        for link in self.links:
            turning = {arrays.FREE: 3 if rates else 4, arrays.SPHERICAL: 3 if rates else 4, arrays.WELD: 0}
            turning |= {arrays.PRISMATIC: 0, arrays.REVOLUTE: 1, arrays.CYLINDRICAL: 1, arrays.UNIVERSAL: 2}
            count = (arrays.RATES if rates else arrays.COORDINATES)[link.kind]
            own = [False] * turning[link.kind]
            lengths = [True] * (count - len(own))
            out += lengths + own if link.kind == arrays.FREE else own + lengths
        return out

    def _coordinate(self, term: Term) -> tuple[int, int] | None:
        """Return coordinate and rate that a term is, if it is one."""
        link = self._between_markers.get((id(term.i), id(term.j)))
        if link is None:
            return None
        at, rate = self._first[link.body]
        if term.kind == "turn" and link.kind in (arrays.REVOLUTE, arrays.CYLINDRICAL):
            return at, rate
        if term.kind == "along" and term.first == "z" and link.kind in (arrays.PRISMATIC, arrays.CYLINDRICAL):
            last = arrays.RATES[link.kind] - 1
            return at + last, rate + last
        return None

    def _whole_rows(self, joint: Joint) -> list[Row]:
        """Return the rows of a joint that the tree does not hold."""
        if id(joint) not in self._held:
            return joint.rows
        return joint.rows[len(joint.rows) - joint.kind.coupling :]

    def _rows_of(self, joint: Joint) -> list[Row]:
        """Return them without the terms that are coordinates."""
        return [
            Row(tuple(t for t in row.terms if self._coordinate(t) is None), row.unit, row.value)
            for row in self._whole_rows(joint)
        ]

    def _sources_of_turns(self) -> list[tuple[int, bool]]:
        """Return for each turn of the whole system a coordinate and False, or its number among cut turns and True."""
        out, cut = [], 0
        rows = [(row, True) for joint in self.packed.joints for row in joint.rows]
        rows += [(push.row, False) for force in self.packed.forces for push in force.pushes]
        for row, holds in rows:
            for term in row.terms:
                if term.kind == "turn":
                    known = self._coordinate(term) if holds else None
                    out.append((cut, True) if known is None else (known[0], False))
                    cut += known is None
        return out

    def _tree(self, q: np.ndarray) -> Tree:
        count = len(self.packed.bodies)
        index, number = np.zeros((count, 6), np.int64), np.zeros((count, 28))
        parent = {link.body: link.parent for link in self.links}
        for link in self.links:
            root = link.body
            while parent[root]:
                root = parent[root]
            index[link.body] = (link.kind, link.parent, *self._first[link.body], arrays.RATES[link.kind], root)
            if link.joint is not None:
                self._fill(number[link.body], link, q)
        order = [link.body for link in self.links]
        place = {body: n for n, body in enumerate(order)}
        linear, factor, bodies = self._linear_terms()
        paths = [_path(ends, parent, place) for ends in bodies]
        return Tree(
            order=np.array(order, np.int64),
            index=index,
            number=number,
            path=np.array([b for path in paths for b in path], np.int64),
            begin=np.concatenate([[0], np.cumsum([len(path) for path in paths])]).astype(np.int64),
            linear=np.array(linear, np.int64).reshape(-1, 3),
            factor=np.array(factor, float),
            turns=np.array(self._turn_sources, np.int64).reshape(-1, 2),
        )

    def _linear_terms(self) -> tuple[list[tuple[int, int, int]], list[float], list[set[int]]]:
        """Return linear terms with their factors, and the bodies of the tree on which each row acts."""
        body_of = {
            self._first[link.body][1] + k: link.body for link in self.links for k in range(arrays.RATES[link.kind])
        }
        linear, factor = [], []
        bodies = [{int(b) for b in sides if b > 0} for sides in self.cut.system.row_body]
        row = 0
        for joint in self.packed.joints:
            for whole in self._whole_rows(joint):
                for term in whole.terms:
                    known = self._coordinate(term)
                    if known is not None:
                        linear.append((row, known[1], known[0]))
                        factor.append(term.weight)
                        bodies[row].add(body_of[known[1]])
                row += whole.count
        return linear, factor, bodies

    def _own(self, marker: Marker) -> tuple[np.ndarray, np.ndarray]:
        """Return place and axes of a marker in the principal axes of its body."""
        principal = marker.body.principal[1].T
        return principal @ (np.array(marker.place) - np.array(marker.body.com)), principal @ marker.axes

    def _between(self, link: Link, q: np.ndarray) -> np.ndarray:
        """Return the axes (3, 3) of marker j in those of marker i at q (3 + 7 n,)."""
        assert link.joint is not None
        i, j = (self._own(marker)[1] for marker in (link.joint.i, link.joint.j))
        return (self._rotation(link.joint.i, q) @ i).T @ (self._rotation(link.joint.j, q) @ j)

    def _rotation(self, marker: Marker, q: np.ndarray) -> np.ndarray:
        b = self.packed.body_names.index(marker.body.name)
        return rotation_matrix(q[7 * b - 1 : 7 * b + 3]) if b else marker.body.principal[1]

    def _fill(self, number: np.ndarray, link: Link, q: np.ndarray) -> None:
        """Fill the numbers of a link's joint; axes that point against each other at q stay so."""
        joint = link.joint
        assert joint is not None
        forward = self.packed.body_names.index(joint.j.body.name) == link.body
        here, there = (joint.i, joint.j) if forward else (joint.j, joint.i)
        (arm, base), (own_arm, own) = self._own(here), self._own(there)
        number[arrays.ARM : arrays.ARM + 3], number[arrays.OWN_ARM : arrays.OWN_ARM + 3] = arm, own_arm
        first, second = euler_parameters(base), euler_parameters(own) * CONJUGATE
        if link.kind == arrays.UNIVERSAL:
            cross = euler_parameters(CROSS)
            parts = [first, product(first, ABOUT_Z), product(cross, second)]
            parts.append(product(product(cross, ABOUT_Z), second))
            number[arrays.TURN : arrays.TURN + 16] = np.concatenate(parts)
            number[arrays.AXIS : arrays.AXIS + 3] = base[:, 2]
            number[arrays.OWN_AXIS : arrays.OWN_AXIS + 3] = own[:, 2]
            return
        flip = _nearest_axes(self._between(link, q), link.kind)
        turned = euler_parameters(flip)
        if forward:
            parts = [product(product(first, turned), second)]
            parts.append(product(product(product(first, ABOUT_Z), turned), second))
            axis = base[:, 2]
        else:
            turned = turned * CONJUGATE
            parts = [product(product(first, turned), second)]
            parts.append(-product(product(product(first, turned), ABOUT_Z), second))
            axis = -(base @ flip.T)[:, 2]
        number[arrays.TURN : arrays.TURN + 8] = np.concatenate(parts)
        number[arrays.AXIS : arrays.AXIS + 3] = axis

    def _set_coordinates(self, q: np.ndarray, turns: np.ndarray) -> None:
        """Fill the coordinates of a closed pose q (3 + 7 n,) with counted turns."""
        counted = {source: turns[n] for n, (source, is_cut) in enumerate(self._turn_sources) if not is_cut}
        for link in self.links:
            at, c = self._first[link.body][0], 7 * link.body - 4
            own = self.y[0, at : at + arrays.COORDINATES[link.kind]]
            if link.kind == arrays.FREE:
                own[:] = q[c : c + 7]
            elif link.kind == arrays.SPHERICAL:
                p = 7 * link.parent - 1
                base = q[p : p + 4] if link.parent else np.array([1.0, 0.0, 0.0, 0.0])
                own[:] = product(base * CONJUGATE, q[c + 3 : c + 7])
            elif link.kind != arrays.WELD:
                self._set_joint(own, link, q)
                if at in counted and link.kind != arrays.PRISMATIC:
                    own[0] += 2.0 * math.pi * round((counted[at] - own[0]) / (2.0 * math.pi))

    def _set_joint(self, own: np.ndarray, link: Link, q: np.ndarray) -> None:
        """Fill turns and slide of a joint at a pose q (3 + 7 n,)."""
        joint = link.joint
        assert joint is not None
        between = self._between(link, q)
        if link.kind == arrays.UNIVERSAL:
            forward = self.packed.body_names.index(joint.j.body.name) == link.body
            between = between if forward else between.T
            own[0] = math.atan2(between[1, 2], between[0, 2])
            c, s = math.cos(own[0]), math.sin(own[0])
            rest = CROSS.T @ np.array([[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]]) @ between
            own[1] = math.atan2(rest[1, 0], rest[0, 0])
            return
        if link.kind in (arrays.REVOLUTE, arrays.CYLINDRICAL):
            own[0] = math.atan2(between[1, 0], between[0, 0])
        if link.kind in (arrays.PRISMATIC, arrays.CYLINDRICAL):
            places = [self._place(marker, q) for marker in (joint.i, joint.j)]
            axis = self._rotation(joint.i, q) @ self._own(joint.i)[1][:, 2]
            own[-1] = axis @ (places[1] - places[0])

    def _place(self, marker: Marker, q: np.ndarray) -> np.ndarray:
        b = self.packed.body_names.index(marker.body.name)
        arm = self._rotation(marker, q) @ self._own(marker)[0]
        return arm + (q[7 * b - 4 : 7 * b - 1] if b else np.array(marker.body.com))

    def _set_rates(self) -> None:
        """Fill the rates of the start's velocities; columns stand at its pose."""
        motion = np.zeros((len(self.packed.bodies), 6))
        for link in self.links:
            d = 6 * link.body - 3
            w, reach = self._v[d + 3 : d + 6], self.work.body[link.body, arrays.REACH : arrays.REACH + 3]
            motion[link.body] = np.concatenate([w, self._v[d : d + 3] - np.cross(w, reach)])
            rate, count = self._first[link.body][1], arrays.RATES[link.kind]
            columns = self.work.column[rate - 3 : rate - 3 + count, :6].T
            if count:
                change = motion[link.body] - motion[link.parent]
                self.y[1, rate : rate + count] = np.linalg.lstsq(columns, change, rcond=None)[0]


def _path(ends: set[int], parent: dict[int, int], place: dict[int, int]) -> list[int]:
    """Return these bodies and those between them and ground, children first; ``place`` is where each stands."""
    on: set[int] = set()
    for end in ends:
        body = end
        while body and body not in on:
            on.add(body)
            body = parent[body]
    return sorted(on, key=place.__getitem__, reverse=True)


def _nearest_axes(between: np.ndarray, kind: int) -> np.ndarray:
    """Return what is left of the axes of marker j in those of i without a turn about z: each along or against."""
    if kind in (arrays.REVOLUTE, arrays.CYLINDRICAL):
        return np.eye(3) if between[2, 2] > 0.0 else np.diag([1.0, -1.0, -1.0])
    return np.diag(np.sign(np.diag(between))) if kind != arrays.SPHERICAL else np.eye(3)
