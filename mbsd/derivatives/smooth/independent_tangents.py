"""How a smooth motion changes with numbers, in its independent coordinates: their equation z'' = f(t, z, z'; p) itself.

    A = df/d(z, z'),   B = df/dp        by central differences; then s'' = A (s, s') + B, as free_tangents.py has it

A node costs a fifth of what it costs in reference coordinates, which are used at outputs alone, where more is asked for
than how bodies move. It is for mechanisms whose bodies closed forms place, by angles. Source: Wehage, Haug 1982
(partitioning).
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from mbsd.derivatives.free.free_tangents import REACH, at_rows, slight_changes
from mbsd.derivatives.free.linear_motion import Carried, carried
from mbsd.derivatives.free.stretch import Stretch, Tangents
from mbsd.derivatives.numbers.terms import Along, Terms
from mbsd.derivatives.numbers.variants import Variants
from mbsd.derivatives.smooth.between_looks import between_looks
from mbsd.derivatives.smooth.forces_beside import slopes_of_forces
from mbsd.derivatives.smooth.rates_beside import FIRST, Held, motions_beside, rates_beside
from mbsd.derivatives.smooth.sides import Sides, forces_beside
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


class IndependentTangents:
    """Tangents of one smooth motion by numbers, whose sides ``every`` holds."""

    def __init__(self, ready: PreparedDynamics, made: Embedded, arrays: Embedding, every: list[Sides]) -> None:
        self.ready, self.made, self.arrays, self.every = ready, made, arrays, every
        self.f = len(made.coordinates)
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
        system = self.ready.packed.system
        scratch = self.scratch
        shapes = scratch.rate.shape, scratch.cos_sin.shape, scratch.q.shape, scratch.v.shape
        held = Held(*(np.zeros((count, *shape)) for shape in shapes))
        rates = self._rates(self.arrays, system.mass, system.inertia, t, states, held)
        if np.abs(rates[:, 0] - bend).max(initial=0.0) > CLOSE * np.abs(bend).max(initial=0.0):
            raise NotSmooth
        pairs = rates[:, 1:].reshape(count, 2 * f, 2, f)
        matrix = (pairs[:, :, 0] - pairs[:, :, 1]) / (2 * np.concatenate([far, fast]))[:, None]
        right = np.zeros((count, f, len(self.every)))
        light = [p for p, sides in enumerate(self.every) if sides.near is not None]
        if light:
            right[:, :, light] = self._slopes_of_forces(light, t, held, rates).transpose(1, 2, 0)
        none, itself = Held(*(part[:0] for part in held)), np.ascontiguousarray(states[:, :1])
        for p, sides in enumerate(self.every):
            for k, weight in enumerate(sides.weights.tolist() if sides.near is None else ()):
                if sides.away[k]:
                    own = self._rates(sides.arrays[k], sides.mass[k], sides.moment[k], t, itself, none)
                    right[:, :, p] += weight * own[:, 0]
                else:
                    right[:, :, p] += weight * rates[:, 0]
        y = np.concatenate([self.basis @ np.array([sides.begun[part] for sides in self.every]).T for part in range(2)])
        fastest = float(np.abs(speed).max(initial=0.0)) or 1.0
        sizes = np.array([sides.size for sides in self.every])
        return carried(t, matrix.transpose(0, 2, 1).copy(), right, y, slight_changes(f, fastest, sizes))

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
        of = [p for p, sides in enumerate(self.every) for _ in sides.away]
        away = np.concatenate([sides.away for sides in self.every])
        weights = np.zeros((len(self.every), len(of)))
        weights[of, np.arange(len(of))] = np.concatenate([sides.weights for sides in self.every])
        mass, moment, com = (
            np.concatenate([getattr(sides, name) for sides in self.every]) for name in ("mass", "moment", "com")
        )
        z = np.zeros((count, FIRST + self.f))
        z[:, FIRST:] = along.q @ self.basis.T
        states = np.zeros((len(of), count, 2, FIRST + self.f))
        moved = away[:, None, None, None] * y[:, :, of].transpose(2, 0, 1).reshape(len(of), count, 2, self.f)
        states[:, :, 0, FIRST:] = z[:, FIRST:] + moved[:, :, 0]
        states[:, :, 1, FIRST:] = along.v @ self.basis.T + moved[:, :, 1]
        poses, a = np.zeros((len(of), count, 2, width)), np.zeros((len(of), count, width))
        own = [accelerations or self.every[p].near is None for p in of]
        light = np.flatnonzero(~np.array(own))
        if len(light):
            many = (np.concatenate([part] * len(light)) for part in (along.t, along.q, z))
            there, rest = poses[light].reshape(-1, 2, width), a[light].reshape(-1, width)
            self._begin(self.arrays, packed.system.mass, packed.system.inertia, states[0, 0], float(along.t[0]))
            given = states[light].reshape(-1, 2, FIRST + self.f)
            if motions_beside(self.arrays, self.scratch, *many, given, False, there, rest) < len(given):
                raise NotSmooth
            poses[light] = there.reshape(len(light), count, 2, width)
        for s in np.flatnonzero(own).tolist():
            sides = self.every[of[s]]
            arrays = sides.arrays[s - of.index(of[s])]
            self._begin(arrays, mass[s], moment[s], states[s, 0], float(along.t[0]))
            here = along.t, along.q, z, states[s], accelerations
            if motions_beside(arrays, self.scratch, *here, poses[s], a[s]) < count:
                raise NotSmooth
        self.ready.packed.specials.check()
        q, v, a = (part.reshape(len(of), count, -1, 3) for part in (poses[:, :, 0], poses[:, :, 1], a))
        work = np.zeros(q.shape[:2])
        return Motions(packed.body_names, q, v, a, work, com, mass, moment, self._places(traces), along.t), weights

    def reaches_alone(self, t: np.ndarray, q: np.ndarray, v: np.ndarray) -> list[float]:
        """Return how far (sizes, rad) bodies go with each number alone at t (R,), q, v (R, 3 nb), coordinates held."""
        scale, out = self.ready.packed.column_scale(), list[float]()
        z, states = np.zeros((len(t), FIRST + self.f)), np.zeros((len(t), 2, FIRST + self.f))
        z[:, FIRST:] = states[:, 0, FIRST:] = q @ self.basis.T
        states[:, 1, FIRST:] = v @ self.basis.T
        poses, a = np.zeros((len(t), 2, q.shape[1])), np.zeros_like(q)
        for sides in self.every:
            if sides.near is not None:
                out.append(0.0)
                continue
            self._begin(sides.arrays[-1], sides.mass[-1], sides.moment[-1], states[0], float(t[0]))
            if motions_beside(sides.arrays[-1], self.scratch, t, q, z, states, False, poses, a) < len(t):
                raise NotSmooth
            out.append(float(np.abs((poses[:, 0, 3:] - q[:, 3:]) / scale).max(initial=0.0)))
        return out

    def reaches(self, motions: Motions) -> list[float]:
        """Return how far (sizes, rad) bodies go from one side of each number to the other, at most, halved."""
        scale, first, out = self.ready.packed.column_scale(), 0, list[float]()
        for sides in self.every:
            last = first + len(sides.away)
            own = motions.q[first:last, :, 1:].reshape(len(sides.away), -1, len(scale))
            out.append(0.5 * float((np.ptp(own, axis=0) / scale).max(initial=0.0)))
            first = last
        return out

    def _places(self, traces: Mapping[str, Marker]) -> dict[str, tuple[int, np.ndarray, np.ndarray]]:
        """Body, places (K, 2) on all sides, and angle (1,) of each traced point."""
        out: dict[str, tuple[int, np.ndarray, np.ndarray]] = {}
        for name, marker in traces.items():
            moved = [sides.traces.get(name, np.zeros((len(sides.away), 2))) for sides in self.every]
            place = np.array([marker.x, marker.y]) + np.concatenate(moved)
            out[name] = self.ready.packed.body_names.index(marker.body.name), place, np.array([marker.angle])
        return out

    def at(
        self, terms: Terms, along: Along, compact: np.ndarray, rows: np.ndarray, line: Carried, variants: list[Variants]
    ) -> Tangents:
        """Tangents in reference coordinates at outputs (R,), whose compact J is (R, m, 6)."""
        everywhere = np.ones(len(along.t), bool)
        stretch = Stretch(along, compact, rows, [], everywhere, everywhere)
        return at_rows(terms, stretch, variants, self.basis[:, 3:], line.at(along.t))

    def _rates(
        self, arrays: Embedding, mass: np.ndarray, moment: np.ndarray, t: np.ndarray, states: np.ndarray, held: Held
    ) -> np.ndarray:
        self._begin(arrays, mass, moment, states[0, 0], float(t[0]))
        out, sensitivity = np.zeros((*states.shape[:2], self.f)), np.zeros(1)
        clear = rates_beside(arrays, self.scratch, t, states, held, sensitivity, out)
        self.ready.packed.specials.check()
        if clear < len(t) or sensitivity[0] > FASTEST:
            raise NotSmooth
        return out

    def _slopes_of_forces(self, light: list[int], t: np.ndarray, held: Held, rates: np.ndarray) -> np.ndarray:
        """(L, T, f) how z'' changes with the numbers ``light`` at a held motion."""
        system, arrays = self.ready.packed.system, self.arrays
        near = [own for own in (self.every[p].near for p in light) if own is not None]
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
