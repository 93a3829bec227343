"""A simulation and how it changes with numbers of its mechanism: tangents along it, with jumps at events.

The motion is looked at, and then simulated at the nodes of the tangents, the outputs and places between them, in
stretches from event to event.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.base.errors import SimulationError
from mbsd.derivatives.driven.sweeps import displaced, extent
from mbsd.derivatives.driven.tangents import Tangent, by_numbers, has_kinks
from mbsd.derivatives.free.explicit_time import find_toggles
from mbsd.derivatives.free.free_tangents import AT_ONCE, FreeTangents, Stretch, Tangents, joined
from mbsd.derivatives.free.guards import End, contacts_of, refuse_contact_at_start, share_least, unshared, ways_of
from mbsd.derivatives.free.indexing import held_between, solve_ends, unwatched
from mbsd.derivatives.free.jumps import Jump, jumps_of
from mbsd.derivatives.free.linear_motion import LATEST, NODES
from mbsd.derivatives.free.mesh import ROUNDING, apart, first_edges, looked_at, nodes_of
from mbsd.derivatives.free.step_errors import Finish, refined_to_error
from mbsd.derivatives.numbers.near_numbers import variants_beside
from mbsd.derivatives.numbers.terms import Along, Left, along_of, rows_of
from mbsd.derivatives.numbers.variants import ALLOWED, FAR, KINKED, SECOND, TINY, Variants, Variation, models_of
from mbsd.derivatives.refused_motions import refuse, refuse_opened, refuse_parted
from mbsd.derivatives.requests import OfBodies
from mbsd.derivatives.smooth.independent_tangents import IndependentTangents, suits
from mbsd.derivatives.smooth.sides import BothSides
from mbsd.derivatives.smooth.smooth_motion import (
    CLOSE,
    Motion,
    NotSmooth,
    between,
    looked_at_closely,
    motion_of,
    terms_along,
)
from mbsd.dynamics.prepare.prepare import prepare_dynamics, started
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.repeated import Course, Outputs, Repeated
from mbsd.kinematics.pose.held_values import independent_rows
from mbsd.kinematics.pose.initial import Initial
from mbsd.kinematics.pose.phases import take_decided
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number
from mbsd.results.solution import Solution


class SimulationTangents:
    """A simulation at output times ``grid`` (T,), and its tangents by numbers at rows that ``needed`` gives.

    ``of_bodies`` is what is asked for, where that is how bodies move.
    """

    def __init__(
        self, m: Model, runs: Repeated, grid: np.ndarray, numbers: Sequence[Number],
        needed: Callable[[np.ndarray], np.ndarray], of_bodies: OfBodies | None,
    ) -> None:  # fmt: skip
        self.m, self._runs, self._grid, self._needed, self._of_bodies = m, runs, grid, needed, of_bodies
        self._numbers = numbers
        self.values: dict[str, np.ndarray] = {}
        self.slopes: dict[str, np.ndarray] = {}
        self._ready: PreparedDynamics | None = None
        self.ends = None
        first = runs.course(looked_at(grid))
        refuse(first)
        self.repeated: set[int] = {*first.dropped}
        """Rows of joints that repeat others."""
        self.closed = {*range(len(first.packed.ws.phi))}
        """Rows that hold all along."""
        span = float(grid[0]), float(grid[-1])
        self.span = span
        self.terms = terms_along(runs, first)
        packed = first.packed
        contacts = packed.joints[len(packed.joints) - packed.contacts :] if packed.contacts else []
        self.variation = Variation(m, self.terms, span, self._closed, contacts, starts=True)
        reached = grid[grid <= first.t[-1]]
        self._variants: list[Variants] | None = None
        self._both: BothSides | None = None
        self._autonomous: bool | None = None
        self._met = np.append(
            first.t[:-1][np.diff(first.t) <= 0.0], first.t[len(first.t) - 1 :][first.t[-1] > reached[-1]]
        )
        self._first, longest = looked_at_closely(runs, first)
        edges = first_edges((span[0], float(reached[-1])), self._met, self._first.t, longest)
        for way in (self._in_independent_coordinates, self._between_looks, self._at_nodes):
            try:
                made, error = refined_to_error(way, edges, has_kinks(self.terms), m.name)
                break
            except NotSmooth:
                continue
        self.error = error
        """Estimate of the largest error of the tangents, as part of the largest."""
        self.tangents = [] if made is None else [Tangent(*parts) for parts in zip(*made.parts(), strict=True)]
        """By number; none where ``slopes`` say all that was asked for."""
        if self.tangents:
            for own, tangent in zip(self.variants, self.tangents, strict=True):
                refuse_parted(self.terms, self.along, own, tangent.q)
                if self.repeated:
                    refuse_opened(self.along, own, tangent.q, sorted(self.closed | self.repeated))
            self._variants = [
                self._nearer(own, tangent.q) for own, tangent in zip(self.variants, self.tangents, strict=True)
            ]

    @property
    def variants(self) -> list[Variants]:
        """The mechanism with other values of each number."""
        if self._variants is None:
            made = [self.variation.of(number, SECOND, self._step) for number in self._numbers]
            still = np.zeros_like(self.terms.inertia)
            self._variants = [self._nearer(own, own.begun(still)[0]) for own in made]
        return self._variants

    @property
    def _step(self) -> float:
        """Step of a number, as part of its size."""
        return TINY * (KINKED if has_kinks(self.terms) else 1.0)

    def _nearer(self, variants: Variants, q: np.ndarray) -> Variants:
        """Return variants that are not too far, where places change by q (..., 3 nb) with their number."""
        far = extent(self.terms, q) * abs(variants.step)
        return variants if far <= ALLOWED * FAR else self.variation.of(variants.number, SECOND, self._step * FAR / far)

    # -- ways to the tangents --------------------------------------------------------------------------------------

    def _in_independent_coordinates(self, edges: np.ndarray) -> tuple[np.ndarray, Finish]:
        """Errors of steps between edges, and what evaluates the tangents at outputs. Raises NotSmooth."""
        ready = self._runs.ready
        coordinates = suits(ready)
        if self._first.q is None or ready is None or coordinates is None or has_kinks(self.terms):
            raise NotSmooth
        asked = self._of_bodies
        if self._both is None:
            arrays = coordinates.copied(self._runs.tolerance)
            self._both = BothSides(self.m, ready, coordinates, arrays, self.variation, self._numbers, asked is None)
        both = self._both
        independent = IndependentTangents(ready, coordinates, both, self._is_autonomous(_along(self._first)))
        line, needed = independent.carry(self._first, nodes_of(edges, self._met)), self._needed(self._grid)

        def finish() -> Tangents | None:
            out = self._recorded()
            if asked is None:
                self._keep_simulation(out.solve(), needed)
                along = replace(self.along, held=np.ones(self.along.lam.shape, bool))
                rows, compact = self.stretch_rows(along, 0), self.terms.rows(along)[2]
                self._variants = variants_beside(self.variation, self._numbers, both.near)
                return independent.at(self.terms, along, compact, rows, line, self._variants)
            self.t, self.solve = out.t, out.solve
            there = out if len(needed) == len(out.t) else out.take(needed)
            motions, weights = independent.motions(there, self.m.traces, line.at(there.t), asked.accelerations)
            itself = independent.motion(out, self.m.traces)
            for label, of in asked.by_label.items():
                self.values[label] = of(itself)[0]
                self.slopes[label] = np.moveaxis(np.tensordot(weights, of(motions), axes=1), 0, -1)
            return None

        return line.errors_of(self._grid[needed]), finish

    def _between_looks(self, edges: np.ndarray) -> tuple[np.ndarray, Finish]:
        """The same of a smooth motion in reference coordinates. Raises NotSmooth."""
        if self._first.q is None:
            raise NotSmooth
        nodes = nodes_of(edges, self._met)
        whole = between(self._first, np.union1d(nodes, self._grid))
        rows = self._outputs(whole, self._grid)
        needed = self._needed(self._grid)
        made, errors = self._tangents_at(whole, rows[needed], nodes)
        if self._off > CLOSE:
            raise NotSmooth

        def finish() -> Tangents:
            self._keep_simulation(self._recorded().solve(), needed)
            return made

        return errors, finish

    def _at_nodes(self, edges: np.ndarray) -> tuple[np.ndarray, Finish]:
        """The same of any motion, simulated at the nodes."""
        nodes, grid = nodes_of(edges, self._met), self._grid
        whole = motion_of(self._runs(np.union1d(nodes, apart(grid, self._met, self.span[1] - self.span[0]))))
        rows = self._outputs(whole, grid)
        needed = self._needed(whole.t[rows])
        made, errors = self._tangents_at(whole, rows[needed], nodes)

        def finish() -> Tangents:
            assert whole.solution is not None
            self._keep_simulation(rows_of(unwatched(whole.solution, self.m), rows), needed)
            if self.repeated:
                made.lam[:] = np.nan  # joints that repeat others share their loads in many ways
            if needed[-1] < len(rows) - 1:
                self.ends = None
            if self.ends is not None:  # the last output is the event that ended it, wherever that is
                made.q[:, -1] += self.along.v[-1] * self.ends[:, None]
                made.v[:, -1] += self.along.a[-1] * self.ends[:, None]
            return made

        return errors, finish

    def _is_autonomous(self, along: Along) -> bool:
        """Return True if time itself changes nothing along the motion; found once."""
        if self._autonomous is None:
            self._autonomous = self.terms.is_autonomous(along)
        return self._autonomous

    def _recorded(self) -> Outputs:
        """The motion that was looked at, at all outputs."""
        return self._runs.recorded(np.searchsorted(self._first.t, self._grid))

    def _keep_simulation(self, sol: Solution, needed: np.ndarray) -> None:
        """Keep the simulation at all outputs, and at those of which tangents are asked."""
        self.t, self.solve = sol.t, lambda: sol
        self.known = sol if len(needed) == len(sol.t) else rows_of(sol, needed)
        """The outputs of which tangents are known."""
        self.along = along_of(self.known)

    # -- what is asked for -----------------------------------------------------------------------------------------

    def moved(self, k: int, reactions: bool = True) -> list[Solution]:
        """The simulation at other values of number k, along its tangent where that is known: one for each variant."""
        out = []
        for variant in self.variants[k].variants:
            h, t = variant.offset * self.variants[k].step, self.known.t
            if self.ends is not None:
                t = np.append(t[:-1], t[-1] + h * self.ends[k])
            out.append(displaced(self.known, self.along, self.tangents[k], variant, h, reactions, t=t, work=None))
        return out

    def weights(self, k: int) -> np.ndarray:
        """(v,) of what is found of :meth:`moved`, for a derivative by number k."""
        return self.variants[k].weights / self.variants[k].step

    def models(self, k: int, number: Number) -> list[Callable[[], Model]]:
        """Return the function that makes the mechanisms of :meth:`moved`."""
        return models_of(self.m, number, self.variants[k])

    # -- nodes -----------------------------------------------------------------------------------------------------

    def _tangents_at(self, whole: Motion, rows: np.ndarray, nodes: np.ndarray) -> tuple[Tangents, np.ndarray]:
        """Tangents at some rows of the simulation, and the errors of each step between nodes."""
        asked, known = np.zeros(len(whole.t), bool), np.isin(whole.t, nodes)
        asked[rows] = True
        begins = np.append(True, np.diff(whole.t) <= 0.0)
        known |= begins | np.append(begins[1:], True)
        kept = np.flatnonzero(asked | known)
        whole, asked, known, begins = whole.take(kept), asked[kept], known[kept], begins[kept]
        along = whole.along
        edges = [*np.flatnonzero(begins).tolist(), len(kept)]
        q, v = self._begun()
        parts: list[Tangents] = []
        errors: list[np.ndarray] = []
        self.ends, self._off = None, 0.0
        compact = self.terms.rows(along)[2]
        shared = self._unshare(along, compact, edges)
        autonomous, passing = self._is_autonomous(along), find_toggles(along.t, along.a)
        held = [held_between(self.terms, self.variants, along.take(slice(a, b))) for a, b in pairwise(edges)]
        for (a, b), (terms, _) in zip(pairwise(edges), held, strict=True):
            if terms is not self.terms:
                solve_ends(terms, along, self.stretch_rows(along, a), a, b)
        jumps: list[Jump] = [] if whole.solution is None else jumps_of(self, whole.solution, along, edges)
        changes = None if whole.solution is None else self._changes(along, compact, edges)
        for k, (a, b) in enumerate(pairwise(edges)):
            at, ends = slice(a, b), None
            stretch = self._stretch(along.take(at), compact[at], asked[at], known[at])
            stretch.solved, stretch.autonomous, stretch.passing = whole.solution is not None, autonomous, passing[at]
            if changes is not None and whole.solution is not None:
                own, ends = next(changes)
                stretch.own = own if held[k][0] is self.terms else None
                if k == 0:
                    refuse_contact_at_start(self.terms, self.variants, along, q, v, ends, whole.solution.events)
            if known[at].sum() % NODES != 1:
                raise SimulationError(
                    f"{self.m.name}: derivatives: events from t = {whole.t[a]:.9g} s on come at other times when they "
                    "are simulated again; take a smaller tolerance"
                )
            made = FreeTangents(held[k][0], stretch, held[k][1]).carry(q, v)
            errors.append(made.errors)
            self._off = max(self._off, made.off)
            parts.append(made.asked)
            parts[-1].lam[..., shared[k]] = np.nan  # how contacts at rest share their friction changes, too
            q, v = made.q, made.v
            if k < len(jumps) and ends is not None:
                last = np.flatnonzero(known[at])[-NODES - 1 :] + a
                pace = LATEST @ along.lam[last] / (along.t[last[-1]] - along.t[last[0]])
                q, v, times_moved = jumps[k].across(End(q, v, made.lam, pace, ends))
                if jumps[k].ends:
                    self.ends = times_moved
        again = np.unique(rows, return_inverse=True)[1]  # two outputs may be nearer to an event than rounding
        tangents = Tangents(*(part[:, again] for part in joined(parts).parts()))
        return tangents, np.concatenate(errors)

    def _changes(self, along: Along, compact: np.ndarray, edges: list[int]) -> Iterator[tuple[Left | None, Left]]:
        """By stretch, how the equations change with the numbers at the held motion, and at its first and last node.

        Short stretches are evaluated together; the first is None of a long one.
        """
        first = 0
        for k, edge in enumerate(edges[1:], 1):
            if k < len(edges) - 1 and edges[k + 1] - edges[first] <= AT_ONCE:
                continue
            start, whole = edges[first], None
            if edge - start <= AT_ONCE:
                at = slice(start, edge)
                whole = by_numbers(self.terms, along.take(at), self.variants, compact[at])
            for a, b in pairwise(edges[first : k + 1]):
                if whole is None:
                    at = np.array([a, b - 1])
                    yield None, by_numbers(self.terms, along.take(at), self.variants, compact[at])
                else:
                    own = whole.each(lambda part, here=slice(a - start, b - start): part[:, here])
                    yield own, own.each(lambda part: part[:, [0, -1]])
            first = k

    def _unshare(self, along: Along, compact: np.ndarray, edges: list[int]) -> list[list[int]]:
        """Let rows that hold carry all friction at rest; returns the rows that share it, of each stretch.

        Rows that repeat each other share their loads in the least way.
        """
        out: list[list[int]] = []
        for a, b in pairwise(edges):
            part = along.take(slice(a, b))
            dependent, ways = ways_of(self.terms.packed, part)
            if ways:
                along.lam[a:b] = unshared(self.terms, part, compact[a:b], ways)
                first = self.terms.packed.first_row
                others = [int(first[k]) + 1 for k, _ in contacts_of(self.terms.packed) if first[k + 1] > first[k] + 1]
                ways = [row for row in others if part.held is not None and (part.held[0, row] or row in ways)]
            elif along.held is not None and len(part.lam[0]) and not dependent:
                rank = len(self.stretch_rows(part, 0))
                if rank < along.held[a].sum():
                    along.a[a:b], along.lam[a:b] = share_least(self.terms, part, compact[a:b], rank)
            out.append(ways)
        return out

    def _stretch(self, along: Along, compact: np.ndarray, asked: np.ndarray, nodes: np.ndarray) -> Stretch:
        sliding, _ = ways_of(self.terms.packed, along)
        assert along.held is not None
        rows, holding = self.stretch_rows(along, 0), np.flatnonzero(along.held[0])
        return Stretch(along, compact, rows, holding, sliding, asked, nodes)

    def stretch_rows(self, along: Along, k: int) -> np.ndarray:
        """Independent rows among those that hold at node k."""
        packed = self.terms.packed
        assert along.held is not None
        rows = np.flatnonzero(along.held[k])
        if not len(rows):
            return rows
        jac = packed.spread(self.terms.rows(along.take(slice(k, k + 1)))[2])[0]
        scaled = jac * packed.row_scale()[:, None] * packed.column_scale()
        independent = rows[np.sort(np.array(independent_rows(scaled[rows]), np.int64))]
        self.repeated |= {*rows.tolist()} - {*independent.tolist()}
        self.closed &= {*rows.tolist()}
        return independent

    def ready(self) -> PreparedDynamics:
        """The mechanism itself as a simulation begins with it: for the laws of impacts."""
        if self._ready is None:
            self._ready = prepare_dynamics(self.m, *self.span, contacts=True)
            system = self._ready.packed.system
            self._ready.packed.system = system.changed(angle_offset=self.terms.packed.system.angle_offset)
        return self._ready

    # -- ends ------------------------------------------------------------------------------------------------------

    def _closed(self, m: Model, packed: Packed) -> tuple[np.ndarray, np.ndarray]:
        """The start of a variant, whose phases its packing takes."""
        if not packed.contacts:
            return _state_of(started(m, *self.span, packed)[1])
        decided, initial = started(m, *self.span)
        take_decided(packed, decided)
        packed.specials.callbacks += decided.specials.callbacks  # some of these numbers are their addresses
        return _state_of(initial)

    def _begun(self) -> tuple[np.ndarray, np.ndarray]:
        """(P, 3 nb) q' and v' at the start."""
        count, width = len(self.variants), len(self.terms.inertia)
        q, v = np.zeros((2, count, width))
        for k, variants in enumerate(self.variants):
            q[k], v[k] = variants.begun(q[k])
        return q, v

    @staticmethod
    def _outputs(whole: Motion, grid: np.ndarray) -> np.ndarray:
        """Rows of the outputs; at an event what comes after it, and its end if one ended it."""
        near = ROUNDING * (grid[-1] - grid[0])
        rows = np.searchsorted(whole.t, grid[grid <= whole.t[-1]] + near, side="right") - 1
        events = () if whole.solution is None else whole.solution.events
        ended = bool(events) and events[-1].what == "end"
        return np.append(rows, len(whole.t) - 1) if ended and rows[-1] < len(whole.t) - 1 else rows


def _along(course: Course) -> Along:
    """Return a smooth course as a motion whose multipliers are unknown."""
    assert course.q is not None
    return Along(course.t, course.q, course.v, course.a, np.zeros((len(course.t), 0)))


def _state_of(initial: Initial) -> tuple[np.ndarray, np.ndarray]:
    return initial.q, initial.v
