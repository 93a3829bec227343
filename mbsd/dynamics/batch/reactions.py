"""Multipliers of least norm of joints that repeat others, of many simulations; see dynamics/simulate.py."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import rows_of_joints
from mbsd.dynamics.batch.outputs import Outputs, Reacting, until
from mbsd.dynamics.batch.patches import Patches
from mbsd.dynamics.batch.rows import NEARLY_SINGULAR, Numbers, tabulate_reactions
from mbsd.dynamics.batch.single_run import Base, SingleRun
from mbsd.dynamics.change_points import CLOSE, are_suspect, can_pass, determinants, usual_output
from mbsd.dynamics.prepare.large import MANY_COORDINATES
from mbsd.dynamics.prepare.prepared import PreparedDynamics
from mbsd.dynamics.state import REACHED

NEGLIGIBLE = 1e-9
"""Singular values of J below this part of the largest are zero."""


def shares(ready: PreparedDynamics) -> bool:
    """Return True if joints share loads in many ways, of which those of least norm are meant.

    Friction came from those of the rows that held.
    """
    if len(ready.dynamics.loads.friction) or ready.packed.coordinates > MANY_COORDINATES:
        return False
    return bool(ready.mobility.redundant_rows)


def shared(
    packed: list[Packed],
    y: np.ndarray,
    jacobians: np.ndarray,
    lam: np.ndarray,
    times: np.ndarray,
    joints: np.ndarray,
    gone: np.ndarray | None = None,
) -> Reacting:
    """Reactions in ``joints`` (k,); jacobians (R, T, rows of all joints and drivers, 6) are compact, lam (R, T, m).

    ``gone`` (R, T, rows): which rows hold no more.
    """  # fmt: skip
    first, rows = packed[0], jacobians.shape[2]
    if gone is not None:
        jacobians[gone] = 0.0
    out = lam.copy()
    for mine, compact, multipliers in zip(out, jacobians, lam, strict=True):
        j = _spread(first, compact)
        forces = np.einsum("trc,tr->tc", j, multipliers[:, :rows])
        mine[:, :rows] = np.einsum("trc,tc->tr", np.linalg.pinv(j.transpose(0, 2, 1), rcond=NEGLIGIBLE), forces)
    own = rows_of_joints(first, joints)
    return Reacting(packed, y, jacobians[:, :, own], out, times, joints, own)


def _spread(packed: Packed, compact: np.ndarray) -> np.ndarray:
    """(T, rows, n) of the first rows of J, compact (T, rows, 6)."""
    whole = np.zeros((len(compact), len(packed.ws.phi), 6))
    whole[:, : compact.shape[1]] = compact
    return packed.spread(whole)[:, : compact.shape[1]]


class _Evaluated(NamedTuple):
    """Arrays that an evaluation in reference coordinates reads and overwrites."""

    dyn: Any
    scratch: Any


def _evaluated(run: SingleRun) -> _Evaluated:
    return _Evaluated(run.ready.dynamics, run.run.scratch)


class Reactions:
    """Reactions in some joints (k,) of rows that are like one run, in one thread."""

    def __init__(self, run: SingleRun, patches: Patches | None, joints: np.ndarray) -> None:
        self.run, self.joints = run, joints
        packed = run.ready.packed
        self.least = shares(run.ready)
        self.rows = np.arange(packed.contact_rows) if self.least else rows_of_joints(packed, joints)
        self.room = np.zeros((0, 0, 0, 6))
        self.base = Base(run, _evaluated)
        self.patches = None if patches is None else Patches(patches.designs, self.base, starts=False)

    def of_rows(self, rows: range, out: Outputs, times: np.ndarray) -> Reacting:
        """Return reactions of rows that differ by numbers alone; see ``_filled`` for rows that are left out."""
        assert self.patches is not None
        return self._filled(self.base.with_values(self.patches.place, self.patches(rows)[0]), [self.run], out, times)

    def of_runs(self, runs: Sequence[SingleRun], out: Outputs, times: np.ndarray) -> Reacting:
        """Return reactions of runs that were prepared; see ``_filled`` for rows that are left out."""
        return self._filled(self.base.alike(runs), runs, out, times)

    def _filled(self, numbers: Numbers, runs: Sequence[SingleRun], out: Outputs, times: np.ndarray) -> Reacting:
        """Reactions at all outputs; rows that come near a change point get the status NEARLY_SINGULAR.

        There ``simulate`` takes reactions from poses beside (dynamics/change_points.py).
        """
        count, known = len(out.lam), self.run.independent is None
        if len(self.room) < count:
            self.room = np.zeros((*out.lam.shape[:2], len(self.rows), 6))
        jacobians, out = self.room[:count], out._replace(t=times)
        if len(self.rows) or not known:
            tabulate_reactions(*self.base.parts, numbers, out, self.rows, jacobians, known)
        suspect = are_suspect(np.sqrt(np.maximum(out.margin, 0.0)), out.lam)
        for row in np.flatnonzero((out.status == REACHED) & suspect.any(axis=1) & ~suspect.all(axis=1)).tolist():
            if self._comes_near(row, np.flatnonzero(suspect[row]), runs[min(row, len(runs) - 1)], numbers, out):
                out.status[row] = NEARLY_SINGULAR
        packed = [run.ready.packed for run in runs]
        if self.least:
            gone = self._gone(out, times)
            return shared(packed, out.y, jacobians, out.lam, until(times, out.over), self.joints, gone)
        return Reacting(packed, out.y, jacobians, out.lam, until(times, out.over), self.joints, self.rows)

    def _comes_near(self, row: int, suspects: np.ndarray, run: SingleRun, numbers: Numbers, out: Outputs) -> bool:
        """Return True if some of the outputs ``suspects`` of a row are near a change point, as ``simulate`` sees it."""
        packed = run.ready.packed
        if not can_pass(packed):
            return False
        looked = np.append(suspects, usual_output(out.margin[row], suspects))
        own = Outputs(out.t[looked], *(array[row : row + 1] for array in out[1:]))
        own = own._replace(y=own.y[:, looked], lam=own.lam[:, looked], margin=own.margin[:, looked])
        fresh, value = numbers.fresh, numbers.value
        joints = np.arange(packed.contact_rows)
        compact = np.zeros((1, len(looked), len(joints), 6))
        alone = numbers._replace(
            fresh=fresh[min(row, len(fresh) - 1)][None], value=value[min(row, len(value) - 1)][None]
        )
        tabulate_reactions(*self.base.parts, alone, own, joints, compact, True)
        whole = np.zeros((len(looked), len(packed.ws.phi), 6))
        whole[:, : len(joints)] = compact[0]
        held = np.arange(whole.shape[1]) < len(joints)
        closeness = determinants(run.ready, packed.spread(whole), held)
        return bool((closeness[:-1] < CLOSE * closeness[-1]).any())

    def _gone(self, out: Outputs, times: np.ndarray) -> np.ndarray | None:
        """(R, T, rows) which rows of joints and drivers events have released; None where they release none."""
        packed, events = self.run.ready.packed, self.run.events
        if not any(event.releases for event in events):
            return None
        names = [joint.name for joint in packed.joints]
        gone = np.zeros((len(out.lam), len(times), len(self.rows)), bool)
        for when, event in zip(out.released.T[..., None], events, strict=True):
            since = (times > when) | (out.over[:, None] <= times) & (when <= out.over[:, None])
            for joint in map(names.index, event.releases):
                gone[..., packed.first_row[joint] : packed.first_row[joint + 1]] |= since[..., None]
        return gone
