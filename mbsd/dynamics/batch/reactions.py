"""Reactions of many simulations: multipliers and Jacobians at outputs, found together by the compiled loop."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from mbsd.arrays.reactions import rows_of_joints
from mbsd.dynamics.batch.outputs import Outputs, Reacting, until
from mbsd.dynamics.batch.patches import Patches
from mbsd.dynamics.batch.rows import NEARLY_SINGULAR, Numbers, tabulate_reactions
from mbsd.dynamics.batch.single_run import Base, SingleRun
from mbsd.dynamics.change_points import CLOSE, are_suspect, can_pass, determinants, usual_output
from mbsd.dynamics.reference.multipliers import least_norm
from mbsd.dynamics.state import REACHED


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
        self.least = run.ready.shares_loads
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
        if not self.least:
            return Reacting(packed, out.y, jacobians, out.lam, until(times, out.over), self.joints, self.rows)
        first, own = packed[0], rows_of_joints(packed[0], self.joints)
        whole = np.zeros((count, len(times), len(first.ws.phi), 6))
        whole[:, :, : len(self.rows)] = jacobians
        each = zip(whole, out.lam, self._held(out, times), strict=True)
        lam = np.array([least_norm(first, *parts) for parts in each])
        return Reacting(packed, out.y, jacobians[:, :, own], lam, until(times, out.over), self.joints, own)

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

    def _held(self, out: Outputs, times: np.ndarray) -> np.ndarray:
        """Return (R, T, m) True for rows of J that no event has released."""
        packed, events = self.run.ready.packed, self.run.events
        names = [joint.name for joint in packed.joints]
        held = np.ones(out.lam.shape, bool)
        for when, event in zip(out.released.T[..., None], events, strict=True):
            since = (times > when) | (out.over[:, None] <= times) & (when <= out.over[:, None])
            for joint in map(names.index, event.releases):
                held[..., packed.first_row[joint] : packed.first_row[joint + 1]] &= ~since[..., None]
        return held
