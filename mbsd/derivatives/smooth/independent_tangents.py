"""How a smooth motion changes with numbers, in its independent coordinates: their equation z'' = f(t, z, z'; p) itself.

    A = df/d(z, z'),   B = df/dp        by central differences; then s'' = A (s, s') + B, as free_tangents.py has it

A node costs a fifth of what it costs in reference coordinates, which are used at outputs alone, where more is asked for
than how bodies move. It is for mechanisms whose bodies closed forms place, by angles. Source: Wehage, Haug 1982
(partitioning).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from mbsd.derivatives.free.explicit_time import find_toggles, stencil_at
from mbsd.derivatives.free.free_tangents import REACH, Stretch, Tangents, at_rows, slight_changes
from mbsd.derivatives.free.linear_motion import ByTime, Carried, carried
from mbsd.derivatives.numbers.terms import Along, Terms
from mbsd.derivatives.numbers.variants import ALLOWED, FAR, TINY, Variants, step_of
from mbsd.derivatives.smooth.between_looks import between_looks
from mbsd.derivatives.smooth.held_motion import (
    FIRST,
    Held,
    bends_beside,
    motions_beside,
    rates_beside,
    slopes_of_forces,
)
from mbsd.derivatives.smooth.sides import BothSides, Sides, forces_beside
from mbsd.derivatives.smooth.smooth_motion import CLOSE, NotSmooth
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.measures.quantities import Motions
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.repeated import Course, Outputs
from mbsd.dynamics.runs.embedding import Embedded, begin_at, embedded_at_start, embedding_scratch
from mbsd.kinematics.groups.blocks import BLOCK
from mbsd.kinematics.groups.carried import INERTIA, MASS, THETA
from mbsd.kinematics.groups.groups import KIND
from mbsd.model.body import Marker

FASTEST = 5.0
"""Rate of a body for one unit of a coordinate beyond which differences go too far: near a dead centre."""


def suits(ready: PreparedDynamics | None) -> Embedded | None:
    """The independent coordinates of a smooth motion, where closed forms place all bodies by angles."""
    if ready is None or ready.packed.states or ready.packed.specials.phased:  # phases of wheels follow from the start
        return None
    made = embedded_at_start(ready)
    if (
        made is None
        or (made.arrays.group[:, KIND] >= BLOCK).any()
        or any(own.slide is not None for own in made.coordinates)
    ):
        return None
    return made


States = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]
"""t (T,) (s), poses (T, 3 nb) and coordinates (T, 3 + f) of a motion, and states (T, 2, 3 + f) near it."""


class IndependentTangents:
    """Tangents of one smooth motion by numbers; their sides come nearer where they take bodies too far.

    ``autonomous`` says that time itself changes nothing.
    """

    def __init__(self, ready: PreparedDynamics, made: Embedded, both: BothSides, autonomous: bool) -> None:
        self.autonomous = autonomous
        self.ready, self.made, self.both, self.every, self.arrays = ready, made, both, both.every, both.arrays
        self.alone = np.zeros(len(both.near))
        """How far (sizes, rad) bodies go with a side of each number alone, coordinates held."""
        self.share = 0.0
        """How far bodies go at most (sizes, rad), for a change of a coordinate by its size."""
        self.f = len(made.coordinates)
        self.scale = np.concatenate([np.ones(3), ready.packed.column_scale()])
        """(3 nb,) sizes of coordinates."""
        self.scratch = embedding_scratch(ready, made, 1, ready.initial.q)
        width = len(ready.initial.q)
        self.basis = np.zeros((self.f, width))
        """(f, 3 nb) what makes z of q."""
        for row, coordinate in zip(self.basis, made.coordinates, strict=True):
            row[3 * coordinate.body + 2] = 1.0
            row[3 * coordinate.other + 2] -= 1.0 if coordinate.other else 0.0

    def carry(self, course: Course, t: np.ndarray) -> Carried:
        """z' at nodes t (T,) (s) of a smooth course. Raises NotSmooth."""
        assert course.q is not None
        q, v, a = (part @ self.basis.T for part in (course.q, course.v, course.a))
        z, speed, bend = between_looks(course.t, q, v, a, t)
        count, f = z.shape
        far = REACH * self.made.arrays.size
        fast = far * max(float(np.abs(speed / self.made.arrays.size).max(initial=0.0)), 1e-300)
        if not speed.any():
            fast = far
        states = np.zeros((count, 4 * f + 1, 2, FIRST + f))
        states[:, :, 0, FIRST:], states[:, :, 1, FIRST:] = z[:, None], speed[:, None]
        for part, step in enumerate((far, fast)):
            for i in range(f):
                at = 1 + 2 * (part * f + i)
                states[:, at, part, FIRST + i] += step[i]
                states[:, at + 1, part, FIRST + i] -= step[i]
        shapes = self.scratch.rate.shape, self.scratch.cos_sin.shape, (2, len(self.scratch.q))
        held = Held(*(np.zeros((count, *shape)) for shape in shapes))
        rates = self._rates(t, states, held)
        if np.abs(rates[:, 0] - bend).max(initial=0.0) > CLOSE * np.abs(bend).max(initial=0.0):
            raise NotSmooth
        pairs = rates[:, 1:].reshape(count, 2 * f, 2, f)
        matrix = (pairs[:, :, 0] - pairs[:, :, 1]) / (2 * np.concatenate([far, fast]))[:, None]
        right, light = np.zeros((count, f, len(self.alone))), self.both.light
        if light:
            right[:, :, light] = self._slopes_of_forces(t, held, rates).transpose(1, 2, 0)
        here = t, np.ascontiguousarray(held.pose[:, 0]), states[:, 0, 0].copy(), states[:, 0].copy()
        for p in self.every.keys() - {*light}:
            right[:, :, p] = self._slope(p, here, rates[:, 0])
        y = np.concatenate([self.basis @ self.both.begun(part).T for part in range(2)])
        fastest = float(np.abs(speed).max(initial=0.0)) or 1.0
        slight = slight_changes(f, fastest, np.array(self.both.sizes))
        flow, by_time, passing = None, None, find_toggles(t, rates[:, 0])
        if self.autonomous or passing.any():
            flow = np.concatenate([speed, rates[:, 0]], axis=1)
        if passing.any() and not self.autonomous:
            by_time = ByTime(self._by_time(t, states[:, :1].copy(), passing), passing)
        return carried(t, matrix.transpose(0, 2, 1).copy(), right, y, slight, flow=flow, by_time=by_time)

    def motion(self, along: Outputs, traces: Mapping[str, Marker]) -> Motions:
        """The motion itself."""
        packed, system = self.ready.packed, self.ready.packed.system
        q, v, a = (part.reshape(1, len(along.t), -1, 3) for part in (along.q, along.v, along.a))
        places = {
            name: (
                packed.body_names.index(marker.body.name),
                np.array([[marker.x, marker.y]]),
                np.array([marker.angle]),
            )
            for name, marker in traces.items()
        }
        own = packed.com[None], system.mass[None], system.inertia[None], places
        return Motions(packed.body_names, q, v, a, np.zeros(q.shape[:2]), *own, along.t)

    def motions(
        self, along: Outputs, traces: Mapping[str, Marker], y: np.ndarray, accelerations: bool
    ) -> tuple[Motions, np.ndarray]:
        """Return the motion along tangents y (R, 2 f, P) at R times, on K sides of all numbers, and weights (P, K).

        With ``traces``, and with ``accelerations`` if these are asked for. Raises NotSmooth.
        """
        packed = self.ready.packed
        count, width = along.q.shape
        self._set_steps(y)
        every = [self.every[p] for p in range(len(self.every))]
        of = [p for p, sides in enumerate(every) for _ in sides.away]
        away = np.concatenate([sides.away for sides in every])
        weights = np.zeros((len(every), len(of)))
        weights[of, np.arange(len(of))] = np.concatenate([sides.weights for sides in every])
        mass, moment, com = (
            np.concatenate([getattr(sides, name) for sides in every]) for name in ("mass", "moment", "com")
        )
        z = np.zeros((count, FIRST + self.f))
        z[:, FIRST:] = along.q @ self.basis.T
        states = np.zeros((len(of), count, 2, FIRST + self.f))
        moved = away[:, None, None, None] * y[:, :, of].transpose(2, 0, 1).reshape(len(of), count, 2, self.f)
        states[:, :, 0, FIRST:] = z[:, FIRST:] + moved[:, :, 0]
        states[:, :, 1, FIRST:] = along.v @ self.basis.T + moved[:, :, 1]
        poses, a = np.zeros((len(of), count, 2, width)), np.zeros((len(of), count, width))
        own = np.array([accelerations or p not in self.both.light for p in of])
        light = np.flatnonzero(~own)
        if len(light):
            t, q, base = (np.concatenate([part] * len(light)) for part in (along.t, along.q, z))
            system, given = packed.system, states[light].reshape(-1, *states.shape[2:])
            there, rest = poses[light].reshape(-1, 2, width), a[light].reshape(-1, width)
            self._move(self.arrays, system.mass, system.inertia, (t, q, base, given), False, there, rest)
            poses[light] = there.reshape(len(light), *poses.shape[1:])
        for s in np.flatnonzero(own).tolist():
            arrays, here = every[of[s]].arrays[s - of.index(of[s])], (along.t, along.q, z, states[s])
            self._move(arrays, mass[s], moment[s], here, accelerations, poses[s], a[s])
        q, v, a = (part.reshape(len(of), count, -1, 3) for part in (poses[:, :, 0], poses[:, :, 1], a))
        work = np.zeros(q.shape[:2])
        return Motions(
            packed.body_names, q, v, a, work, com, mass, moment, self._places(traces, every), along.t
        ), weights

    def _set_steps(self, y: np.ndarray) -> None:
        """Take sides at which bodies do not go too far along tangents y (R, 2 f, P)."""
        most = np.abs(y[:, : self.f]).max(axis=0, initial=0.0)
        changed = self.share / self.made.arrays.size @ most
        """(P,) how far coordinates take bodies at most (sizes, rad), by a change of each number."""
        steps: dict[int, float] = {}
        for p, size in enumerate(self.both.sizes):
            far = float(self.alone[p] + changed[p] * step_of(TINY, size))
            if far > ALLOWED * FAR or p in self.both.light:
                steps[p] = TINY * (FAR / far if far > ALLOWED * FAR else 1.0)
        self.both.set_steps(steps)

    def _places(
        self, traces: Mapping[str, Marker], every: Sequence[Sides]
    ) -> dict[str, tuple[int, np.ndarray, np.ndarray]]:
        """Body, places (K, 2) on all sides, and angle (1,) of each traced point."""
        out: dict[str, tuple[int, np.ndarray, np.ndarray]] = {}
        for name, marker in traces.items():
            moved = [sides.traces.get(name, np.zeros((len(sides.away), 2))) for sides in every]
            place = np.array([marker.x, marker.y]) + np.concatenate(moved)
            out[name] = self.ready.packed.body_names.index(marker.body.name), place, np.array([marker.angle])
        return out

    def at(
        self, terms: Terms, along: Along, compact: np.ndarray, rows: np.ndarray, line: Carried, variants: list[Variants]
    ) -> Tangents:
        """Tangents in reference coordinates at outputs (R,), whose compact J is (R, m, 6)."""
        everywhere = np.ones(len(along.t), bool)
        stretch = Stretch(along, compact, rows, rows, [], everywhere, everywhere)
        return at_rows(terms, stretch, variants, self.basis[:, 3:], line.at(along.t))

    def _slope(self, p: int, here: States, rates: np.ndarray) -> np.ndarray:
        """(T, f) how z'' changes with number p at held states, where it is ``rates`` (T, f)."""
        last, self.alone[p] = self._held_side(p, -1, here)
        if self.alone[p] > ALLOWED * FAR:
            self.both.set_steps({p: TINY * FAR / float(self.alone[p])})
            last, self.alone[p] = self._held_side(p, -1, here)
        sides, out = self.every[p], last
        out *= sides.weights[-1]
        for k, weight in enumerate(sides.weights[:-1].tolist()):
            out += weight * (self._held_side(p, k, here)[0] if sides.away[k] else rates)
        return out

    def _held_side(self, p: int, k: int, here: States) -> tuple[np.ndarray, float]:
        """(T, f) z'' on side k of number p at held states, and how far bodies go there (sizes, rad)."""
        sides, (t, *_, states) = self.every[p], here
        arrays, out, far = sides.arrays[k], np.zeros((len(t), self.f)), np.zeros(1)
        self._begin(arrays, sides.mass[k], sides.moment[k], states[0], float(t[0]))
        clear = bends_beside(arrays, self.scratch, *here, self.scale, far, out)
        self.ready.packed.specials.check()
        if clear < len(t):
            raise NotSmooth
        return out, float(far[0])

    def _move(
        self, arrays: Embedding, mass: np.ndarray, moment: np.ndarray, here: States, forces: bool, poses: np.ndarray,
        a: np.ndarray,
    ) -> None:  # fmt: skip
        """Fill poses and velocities (T, 2, 3 nb), and with ``forces`` accelerations a (T, 3 nb). Raises NotSmooth."""
        t, *_, states = here
        self._begin(arrays, mass, moment, states[0], float(t[0]))
        clear = motions_beside(arrays, self.scratch, *here, forces, poses, a)
        self.ready.packed.specials.check()
        if clear < len(t):
            raise NotSmooth

    def _rates(self, t: np.ndarray, states: np.ndarray, held: Held) -> np.ndarray:
        """(T, S, f) z'' at states (T, S, 2, 3 + f). Raises NotSmooth."""
        system = self.ready.packed.system
        self._begin(self.arrays, system.mass, system.inertia, states[0, 0], float(t[0]))
        out, sensitivity = np.zeros((*states.shape[:2], self.f)), np.zeros(1)
        clear = rates_beside(self.arrays, self.scratch, t, states, held, sensitivity, out)
        self.ready.packed.specials.check()
        self.share = float(sensitivity[0])
        if clear < len(t) or self.share > FASTEST:
            raise NotSmooth
        return out

    def _by_time(self, t: np.ndarray, states: np.ndarray, passing: np.ndarray) -> np.ndarray:
        """Return (T, f) slopes of z'' by time alone at nodes t (T,) and states (T, 1, 2, 3 + f). Raises NotSmooth."""
        system, stencil = self.ready.packed.system, stencil_at(t, t, passing)
        slope = np.zeros((len(t), self.f))
        shapes = self.scratch.rate.shape, self.scratch.cos_sin.shape, (2, len(self.scratch.q))
        unused = Held(*(np.zeros((len(t), *shape)) for shape in shapes))
        for times, weights in zip(stencil.times, stencil.weights, strict=True):
            self._begin(self.arrays, system.mass, system.inertia, states[0, 0], float(times[0]))
            out = np.zeros((len(t), 1, self.f))
            clear = rates_beside(self.arrays, self.scratch, times, states, unused, np.zeros(1), out)
            self.ready.packed.specials.check()
            if clear < len(t):
                raise NotSmooth
            slope += weights[:, None] * out[:, 0]
        return slope

    def _slopes_of_forces(self, t: np.ndarray, held: Held, rates: np.ndarray) -> np.ndarray:
        """(L, T, f) how z'' changes with the light numbers at a held motion."""
        system, arrays, light = self.ready.packed.system, self.arrays, self.both.light
        near = [own for own in (self.both.near[p] for p in light) if own is not None]
        beside, width = forces_beside(arrays, system.gravity, system.mass, near), len(arrays.inertia)
        out, work = np.zeros((len(light), *rates[:, 0].shape)), (*np.zeros((3, width)), self.scratch.mass)
        if slopes_of_forces(arrays.loads, arrays.laws, arrays.inertia, beside, t, held, rates, *work, out) < len(t):
            raise NotSmooth
        return out

    def _begin(self, arrays: Embedding, mass: np.ndarray, moment: np.ndarray, state: np.ndarray, time: float) -> None:
        scratch = self.scratch
        scratch.body[:, MASS], scratch.body[:, INERTIA] = mass, moment
        scratch.base[:, THETA] = self.ready.initial.q[2::3]
        begin_at(arrays, scratch, state, time, np.inf)
