"""How a smooth motion changes with numbers, in its independent coordinates: their equation z'' = f(t, z, z'; p) itself.

    A = df/d(z, z'),   B = df/dp        by central differences; then s'' = A (s, s') + B, as free_tangents.py has it

A node costs about a third of what it costs in reference coordinates, which are used at outputs alone. It is for
mechanisms whose bodies closed forms place, by angles. Source: Wehage, Haug 1982 (partitioning).
"""

from __future__ import annotations

import numpy as np

from mbsd.arrays.laws import compiled_laws
from mbsd.derivatives.free_tangents import REACH, at_rows, slight_changes
from mbsd.derivatives.linear_motion import Carried, carried
from mbsd.derivatives.rates_beside import FIRST, rates_beside
from mbsd.derivatives.smooth_motion import CLOSE, NotSmooth
from mbsd.derivatives.stretch import Stretch, Tangents
from mbsd.derivatives.terms import Along, Terms
from mbsd.derivatives.variants import Variant, Variants
from mbsd.dynamics.embedding.arrays import Embedding
from mbsd.dynamics.embedding.coordinates import choices
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.runs.embed import POOR, Embedded, begin_at, embedded_at_start, embedding_scratch
from mbsd.kinematics.groups.blocks import BLOCK
from mbsd.kinematics.groups.carrying.columns import AVOID, INERTIA, MASS, THETA
from mbsd.kinematics.groups.groups import KIND


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
    """Tangents of one smooth motion by numbers."""

    def __init__(self, ready: PreparedDynamics, made: Embedded, tolerance: float, every: list[Variants]) -> None:
        self.ready, self.made, self.every = ready, made, every
        self.f = len(made.coordinates)
        self.arrays = made.copied(tolerance)
        self.scratch = embedding_scratch(ready, made, 1, ready.initial.q)
        width = len(ready.initial.q)
        self.basis = np.zeros((self.f, width))
        """(f, 3 nb) what makes z of q."""
        for row, coordinate in zip(self.basis, made.coordinates, strict=True):
            row[3 * coordinate.body + 2] = 1.0
            row[3 * coordinate.other + 2] -= 1.0 if coordinate.other else 0.0

    def carry(self, along: Along, begun: tuple[np.ndarray, np.ndarray]) -> Carried:
        """z' at nodes (T,) of a motion from q', v' (P, 3 nb) ``begun``. Raises NotSmooth."""
        z, speed = along.q @ self.basis.T, along.v @ self.basis.T
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
        rates = self._rates(self.arrays, None, along.t, states)
        bend = along.a @ self.basis.T
        if np.abs(rates[:, 0] - bend).max(initial=0.0) > CLOSE * np.abs(bend).max(initial=0.0):
            raise NotSmooth
        pairs = rates[:, 1:].reshape(count, 2 * f, 2, f)
        matrix = (pairs[:, :, 0] - pairs[:, :, 1]) / (2 * np.concatenate([far, fast]))[:, None]
        itself, right = np.ascontiguousarray(states[:, :1]), np.zeros((count, f, len(self.every)))
        for p, variants in enumerate(self.every):
            for weight, variant in zip(variants.weights / variants.step, variants.variants, strict=True):
                if variant.offset:
                    right[:, :, p] += (
                        weight * self._rates(self._arrays_of(variant), variant.terms, along.t, itself)[:, 0]
                    )
                else:
                    right[:, :, p] += weight * rates[:, 0]
        y = np.concatenate([self.basis @ part.T for part in begun])
        fastest = float(np.abs(speed).max(initial=0.0)) or 1.0
        return carried(along.t, matrix.transpose(0, 2, 1).copy(), right, y, slight_changes(f, fastest, self.every))

    def at(self, terms: Terms, along: Along, compact: np.ndarray, rows: np.ndarray, line: Carried) -> Tangents:
        """Tangents in reference coordinates at outputs (R,), whose compact J is (R, m, 6)."""
        everywhere = np.ones(len(along.t), bool)
        stretch = Stretch(along, compact, rows, [], everywhere, everywhere)
        return at_rows(terms, stretch, self.every, self.basis[:, 3:], line.at(along.t))

    def _rates(self, arrays: Embedding, terms: Terms | None, t: np.ndarray, states: np.ndarray) -> np.ndarray:
        scratch, ready = self.scratch, self.ready
        system = ready.packed.system if terms is None else terms.packed.system
        scratch.body[:, MASS], scratch.body[:, INERTIA] = system.mass, system.inertia
        scratch.base[:, THETA] = ready.initial.q[2::3]
        begin_at(arrays, scratch, states[0, 0], float(t[0]), np.inf)
        out, sensitivity = np.zeros((*states.shape[:2], self.f)), np.zeros(1)
        clear = rates_beside(arrays, scratch, t, states, sensitivity, out)
        ready.packed.specials.check()
        if clear < len(t) or sensitivity[0] > POOR:
            raise NotSmooth
        return out

    def _arrays_of(self, variant: Variant) -> Embedding:
        """Those of a mechanism with another number."""
        terms, arrays = variant.terms, self.arrays
        system = terms.packed.system
        own = {"inertia": terms.inertia, "weight": terms.weight, "numbers": system.numbers, "gravity": system.gravity}
        if terms.loads is not None and terms.laws is not None:
            own |= {"loads": terms.loads, "laws": terms.laws}
        elif any(a is not b for a, b in zip(terms.packed.motions, self.ready.packed.motions, strict=True)):
            own["laws"] = compiled_laws(terms.packed, self.ready.start, self.ready.end)  # of drivers alone
        if not variant.same_places:
            choice = next(choices(terms.packed, self.ready.initial.q, self.f), None)
            groups = None if choice is None else choice.plan.groups()
            if groups is None or groups.group.tobytes() != arrays.group.tobytes():
                raise NotSmooth
            own["number"] = groups.row
            own["number"][:, AVOID] = arrays.number[:, AVOID]
        return arrays._replace(**own)
