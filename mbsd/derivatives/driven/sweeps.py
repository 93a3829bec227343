"""A sweep and how it changes with numbers of its mechanism, at the same times."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from mbsd.arrays.reactions import wrenches
from mbsd.base.errors import ModelError
from mbsd.derivatives.driven.tangents import Inverse, Tangent, has_kinks, tangent
from mbsd.derivatives.numbers.terms import Along, Terms, along_of, terms_of
from mbsd.derivatives.numbers.variants import KINKED, STEP, Variant, Variants, Variation, models_of
from mbsd.derivatives.refused_motions import refuse_parted
from mbsd.kinematics.march import march_along
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.prepared import prepare
from mbsd.kinematics.states_along import Motion, refine_times, states_along
from mbsd.kinematics.sweep import sweep
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number
from mbsd.results.solution import Solution

FAR = 1e-3
"""A variant's motion is no farther than this from the motion itself, in sizes and rad."""


OF_STATES = 1e-3
"""Part of a number by which it changes where states of forces are followed: they are less exact than poses."""


class SweepTangents:
    """A sweep, and its tangents by numbers."""

    def __init__(self, m: Model, sol: Solution, numbers: Sequence[Number]) -> None:
        self.m, self.sol, self.t, self.along = m, sol, sol.t, along_of(sol)
        span = float(sol.t[0]), float(sol.t[-1])
        self.terms: Terms = terms_of(sol.packed, span)
        variation = Variation(m, self.terms, span, lambda m, packed: assemble(m, packed, span[0]))
        rows, unknowns = len(sol.packed.ws.phi), sol.packed.coordinates
        if rows < unknowns:
            raise ModelError(f"{m.name}: derivatives of a sweep need a driver for every freedom")
        inverse = self.inverse = Inverse(self.terms, self.along, bool(sol.mobility.redundant_rows))
        usual = STEP * (KINKED if has_kinks(self.terms) else 1.0)
        self.values: dict[str, np.ndarray] = {}
        self.slopes: dict[str, np.ndarray] = {}
        self.variants: list[Variants] = []
        self.tangents: list[Tangent] = []
        for number in numbers:
            variants = variation.of(number, step=usual)
            tangent_of = tangent(self.terms, self.along, inverse, variants)
            refuse_parted(self.terms, self.along, variants, tangent_of.q)
            far = extent(self.terms, tangent_of.q) * variants.step
            if far > FAR:  # near a toggle a small change of a length is a large one of the pose
                variants = variation.of(number, step=usual * FAR / far)
            if sol.states is not None:
                wide = variation.of(number, step=usual * max(1.0, min(OF_STATES / usual, FAR / max(far, 1e-300))))
                tangent_of.states = self._states(wide, tangent_of)
                tangent_of.lam += inverse.multipliers(self._loads(tangent_of.states, variants.step), None)
            self.variants.append(variants)
            self.tangents.append(tangent_of)

    def solve(self) -> Solution:
        """The sweep itself."""
        return self.sol

    def moved(self, k: int, reactions: bool = True) -> list[Solution]:
        """The sweep at other values of number k, along its tangent: one for each variant."""
        step = self.variants[k].step
        return [
            displaced(self.sol, self.along, self.tangents[k], variant, variant.offset * step, reactions)
            for variant in self.variants[k].variants
        ]

    def weights(self, k: int) -> np.ndarray:
        """(v,) of what is found of :meth:`moved`, for a derivative by number k."""
        return self.variants[k].weights / self.variants[k].step

    def models(self, k: int, number: Number) -> list[Callable[[], Model]]:
        """Return the function that makes the mechanisms of :meth:`moved`."""
        return models_of(self.m, number, self.variants[k])

    def _states(self, variants: Variants, tangent_of: Tangent) -> np.ndarray:
        """(T, s) how states of forces change: they are followed along the motion of each variant."""
        along, inverse = self._close
        if along is not self.along:
            tangent_of = tangent(self.terms, along, inverse, variants)
        rows = np.searchsorted(along.t, self.t)

        def states(variant: Variant) -> np.ndarray:
            h = variant.offset * variants.step
            motion = zip(along.parts(), (tangent_of.q, tangent_of.v, tangent_of.a), strict=True)
            moved = [part + h * slope for part, slope in motion]
            out = states_along(variant.terms.packed, along.t, *moved)
            assert out is not None
            return out[rows]

        return variants.slope(states)

    def _loads(self, change: np.ndarray, step: float) -> np.ndarray:
        """Return how loads (T, 3 nb) change with a number as states do, by ``change`` (T, s)."""
        assert self.along.states is not None
        there, here = (
            self.terms.applied(replace(self.along, states=self.along.states + side * step * change)) for side in (1, -1)
        )
        return (there - here) / (2.0 * step)

    @cached_property
    def _close(self) -> tuple[Along, Inverse]:
        """The motion at times between which quintics miss no pose, and its inverse Jacobians."""
        ready = prepare(self.m, float(self.t[0]), float(self.t[-1]))

        def solve(times: np.ndarray) -> Motion:
            march = march_along(ready, times)
            return march.q, march.v, march.a

        times = refine_times(self.sol.packed, self.t, solve)
        if len(times) == len(self.t):
            return self.along, self.inverse
        along = along_of(sweep(self.m, None, 1, times))
        return along, Inverse(self.terms, along, self.inverse.redundant)


def displaced(
    sol: Solution, along: Along, tangent_of: Tangent, variant: Variant, h: float, reactions: bool, **more: Any
) -> Solution:
    """Return the motion as its tangent has it at another value of a number, h away.

    Without ``reactions`` those are NaN.
    """
    packed, shape = variant.terms.packed, (len(sol.t), -1, 3)
    q, v, a = along.q + h * tangent_of.q, along.v + h * tangent_of.v, along.a + h * tangent_of.a
    lam = along.lam + h * tangent_of.lam
    states = None if along.states is None or tangent_of.states is None else along.states + h * tangent_of.states
    moved, drives = Along(along.t, q, v, a, lam), packed.drives(along.t)
    if along.approached is not None:
        more["approached"] = variant.terms.approaches(moved)
    wrench = np.broadcast_to(np.nan, sol.wrench.shape)
    return replace(
        sol,
        packed=packed,
        q=q.reshape(shape),
        v=v.reshape(shape),
        a=a.reshape(shape),
        lam=lam,
        wrench=wrenches(packed, variant.terms.rows(moved, drives)[2], q, lam) if reactions else wrench,
        drives=drives,
        traces=variant.traces,
        states=states,
        span=sol.span or (float(sol.t[0]), float(sol.t[-1])),
        between=None,
        **more,
    )


def extent(terms: Terms, q: np.ndarray) -> float:
    """Return the largest part of q (..., 3 nb), in sizes and rad."""
    return float(np.abs(q[..., 3:] / terms.packed.column_scale()).max(initial=0.0))
