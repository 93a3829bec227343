"""Rows that differ in numbers alone, through the planar compiled loop: nothing is prepared anew for a row.

All arrays of a run that was prepared stand in one block of numbers (mbsd/dynamics/batch/block.py). How the block
depends on each number x that varies is found from blocks of runs that differ in this number:

    entry = first + sum c (f(x) - f(x of the first)),    f(x) = x or 1 / x

So it is with masses, moments of inertia, stiffnesses, amounts, turns of open chains and velocities at the start. Other
rows are prepared in full, too, and all numbers compared; where any differs, all simulations are made one by one.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from mbsd.base.errors import MechanismError
from mbsd.dynamics.batch.block import content, kind_of, laid_out
from mbsd.dynamics.batch.outputs import Outputs, room_for
from mbsd.dynamics.batch.rows import WAITING, Course, Numbers, Target, run_rows
from mbsd.dynamics.events.loop import go_on
from mbsd.dynamics.genevas import no_genevas
from mbsd.dynamics.independent.arrays import Embedding
from mbsd.dynamics.integrators.advance import USUAL, advance
from mbsd.dynamics.repeated_rows import again, opens
from mbsd.spatial.batch.designs import Designs
from mbsd.spatial.dynamics.events import no_contacts, no_events
from mbsd.spatial.dynamics.formulation import SpaceDynamics
from mbsd.spatial.dynamics.simulate import Run
from mbsd.spatial.dynamics.tree.formulation import TreeDynamics

for operation in (go_on, again, opens, advance):  # none of what they look for is in space
    for formulation in (SpaceDynamics, TreeDynamics):
        operation.add(formulation, operation.kernel_of(Embedding))

COMPARED = 6
"""Rows that are prepared for comparison, beside those with the least and the largest of each number."""
ROUNDING = 1e-11
"""Part of the largest of a number by which it may differ from that of a row prepared in full."""
MOST_STEPS = 200_000
"""Steps after which a simulation is left to ``simulate``, which knows what to say of it."""
NONE = np.zeros(0)


class NotPatched(Exception):
    """Rows of a batch cannot share one block of numbers; the message says why."""


class Parts(NamedTuple):
    """Arrays that the loop reads and overwrites."""

    dyn: Any
    scratch: Any
    state: Any
    settings: Any
    contacts: Any
    genevas: Any

    def kind(self) -> tuple[Any, ...]:
        """Return all that runs which share a block have in common."""
        return type(self.dyn), *kind_of(self)

    def overwritten(self) -> list[np.ndarray]:
        """Return the arrays whose numbers at the start do not matter."""
        dyn, ws = self.dyn, self.scratch.ws
        parts = [*self.scratch[1:], *(part for name, part in ws._asdict().items() if name not in ("guess", "inputs"))]
        parts = [leaf for part in parts for leaf in (part if isinstance(part, tuple) else (part,))]
        if isinstance(dyn, TreeDynamics):
            parts += [*dyn.work, *([] if dyn.limit[0] > 0.0 else [dyn.chosen])]
        else:
            parts += [dyn.world]
        parts += [*dyn.factors, dyn.pushed, dyn.turns]
        return [part for part in parts if isinstance(part, np.ndarray) and part.dtype == float and part.size]

    def frames(self) -> list[tuple[int, int]]:
        """Return where the inputs of functions hold motions of frames, which are overwritten, too."""
        return [(int(first), int(first + 13 * count)) for _, _, count, first in self.dyn.system.call]


def parts_of(run: Run) -> Parts:
    """Return the arrays of a run before its first step. Raises NotPatched for what the loop does not know."""
    if run.m.events or run.packed.callbacks:
        raise NotPatched("events and forces of the user" if run.m.events else "forces of the user")
    if run.changes:
        raise NotPatched("the start was made consistent: " + "; ".join(run.changes))
    dyn = run.dynamics()
    state, _ = run.begun()
    contacts = no_contacts(state, no_events())
    return Parts(dyn, run.scratch(), state, run.settings(), contacts, no_genevas(state))


def frames_of(run: Run) -> np.ndarray:
    """Return all numbers by which motions of frames follow from those of centres of mass."""
    markers = [marker for joint in run.packed.joints for marker in (joint.i, joint.j)]
    markers += run.m.traces.values()
    parts = [np.ravel(part) for marker in markers for part in (marker.place, marker.axes)]
    return np.concatenate(
        [np.ravel(part) for body in run.packed.bodies for part in (body.com, body.principal[1])] + parts
    )


class Patches:
    """How the block of a run follows from the numbers of its row. Raises NotPatched where nothing says so."""

    def __init__(self, designs: Designs, prepare: Any) -> None:
        """``prepare``: numbers of a row (k,) to a Run."""
        self.prepare, self.numbers = prepare, designs.numbers
        self.run = prepare(self.numbers[0])
        self.parts, self._frames = parts_of(self.run), frames_of(self.run)
        parts, block, layout = laid_out(self.parts)
        self.first, self._kind = block.copy(), parts.kind()
        matters = np.ones(len(block), bool)
        for array in parts.overwritten():
            matters[layout.place(array) : layout.place(array) + array.size] = False
        for begin, end in parts.frames():
            place = layout.place(parts.scratch.ws.inputs)
            matters[place + begin : place + end] = False
        self._matters = matters
        self._linear, self._inverse = np.zeros((2, self.numbers.shape[1], len(block)))
        for k, column in enumerate(self.numbers.T):
            if np.ptp(column) > 0.0:
                self._differentiate(designs, k, column)
        self.place = np.flatnonzero((self._linear != 0.0).any(axis=0) | (self._inverse != 0.0).any(axis=0))
        self._linear, self._inverse = self._linear[:, self.place], self._inverse[:, self.place]
        self._compare()

    def values(self, rows: np.ndarray) -> np.ndarray:
        """Return (R, p) numbers at ``place`` of rows (R, k)."""
        used = (self._inverse != 0.0).any(axis=1)
        ones, first = np.zeros_like(rows), np.zeros_like(rows)
        ones[:, used], first[:, used] = 1.0 / rows[:, used], 1.0 / self.numbers[0, used]
        return self.first[self.place] + (rows - self.numbers[0]) @ self._linear + (ones - first) @ self._inverse

    def _content(self, numbers: np.ndarray) -> np.ndarray:
        """Return the block of a row that is prepared in full."""
        run = self.prepare(numbers)
        parts = parts_of(run)
        if parts.kind() != self._kind:
            raise NotPatched("more than numbers depends on what varies")
        if not np.array_equal(frames_of(run), self._frames):
            raise NotPatched("places on bodies depend on what varies")
        return np.where(self._matters, content(parts), self.first)

    def _differentiate(self, designs: Designs, k: int, column: np.ndarray) -> None:
        """Find how the block depends on number k."""
        here = self.numbers[0].copy()
        x = np.array([here[k], max(column.min(), column.max(), key=lambda value: abs(value - here[k])), 0.0])
        x[2] = 0.5 * (x[0] + x[1])
        blocks = [self.first]
        for value in x[1:]:
            here[k] = value
            blocks.append(self._content(here))
        moved = np.flatnonzero((blocks[0] != blocks[1]) | (blocks[0] != blocks[2]))
        first, far, middle = (block[moved] for block in blocks)
        rounding = ROUNDING * np.maximum(np.maximum(np.abs(first), np.abs(far)), 1e-300)
        linear = (far - first) / (x[1] - x[0])
        is_linear = np.abs(first + linear * (x[2] - x[0]) - middle) <= rounding
        self._linear[k, moved[is_linear]] = linear[is_linear]
        if is_linear.all():
            return
        if not x[0] * x[1] > 0.0:
            raise NotPatched(str(designs.owner(k)))
        slope = 1.0 / x[1] - 1.0 / x[0]
        inverse = (far - first) / slope
        is_inverse = np.abs(first + inverse * (1.0 / x[2] - 1.0 / x[0]) - middle) <= rounding
        if not (is_linear | is_inverse).all():
            raise NotPatched(str(designs.owner(k)))
        self._inverse[k, moved[~is_linear]] = inverse[~is_linear]

    def _compare(self) -> None:
        """Raise NotPatched if the blocks of some rows are not those that preparing them makes."""
        count = len(self.numbers)
        rows = {*np.linspace(0, count - 1, COMPARED, dtype=int).tolist()}
        rows |= {int(row) for row in (*self.numbers.argmin(axis=0), *self.numbers.argmax(axis=0))}
        for row in sorted(rows):
            try:
                other = self._content(self.numbers[row])
            except MechanismError:
                continue  # a row may fail
            mine = self.first.copy()
            mine[self.place] = self.values(self.numbers[row : row + 1])[0]
            size = np.maximum(np.maximum(np.abs(mine), np.abs(other)), np.abs(self.first))
            close = (np.abs(mine - other) <= 10.0 * ROUNDING * size) | (mine == other) | (np.abs(mine - other) < 1e-15)
            if not close.all():
                raise NotPatched("more than one number decides together")


class Block:
    """One thread's own block, which becomes one row after another."""

    def __init__(self, patches: Patches, times: np.ndarray) -> None:
        self.patches, self.times = patches, times
        self.parts, self._block, _ = laid_out(patches.parts)
        self._block[:] = patches.first

    def __call__(self, numbers: np.ndarray, stop: np.ndarray) -> Outputs:
        """Simulate rows (R, k); ``stop`` (1,) is not zero where all is to stop."""
        state, count = self.parts.state, len(numbers)
        entries = 7 * len(self.patches.run.packed.bodies) - 4
        out = room_for(count, self.times, entries, len(state.lam), True, 0)
        out.status[:] = WAITING
        rows = Numbers(self._block, self.patches.first[None], self.patches.place, self.patches.values(numbers))
        course = Course(USUAL, NONE, NONE, MOST_STEPS, MOST_STEPS, 0.0, stop)
        kept = np.zeros((0, len(self._block) + 1)), np.zeros((0, len(state.count)), np.int64)
        run_rows(*self.parts, rows, course, Target(len(self.times), np.zeros((0, 4)), 0, *kept), out)
        return out
