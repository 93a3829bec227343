"""Outputs of the compiled loop, the motions that they are, and their reactions.

Multipliers and Jacobians at outputs are found together by the compiled loop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import rows_of_joints, wrenches
from mbsd.dynamics.batch.patches import Patches
from mbsd.dynamics.batch.rows import NEARLY_SINGULAR, Numbers, tabulate_reactions
from mbsd.dynamics.batch.single_run import Base, SingleRun
from mbsd.dynamics.change_points import CLOSE, are_suspect, can_pass, determinants, usual_output
from mbsd.dynamics.measures.quantities import Motions, Reactive
from mbsd.dynamics.reference.multipliers import least_norm
from mbsd.dynamics.state import REACHED


class Outputs(NamedTuple):
    """Arrays that the compiled loop fills (rows.py), row by row as those of Output."""

    t: np.ndarray
    """(T,) s"""
    y: np.ndarray
    """(R, T, 2, 3 nb)"""
    a: np.ndarray
    lam: np.ndarray
    work: np.ndarray
    margin: np.ndarray
    status: np.ndarray
    """(R,) int"""
    steps: np.ndarray
    over: np.ndarray
    """(R,) when an event of the user ended a simulation (s); infinite where none did."""
    released: np.ndarray
    """(R, e) when each event of the user released its joints (s); infinite where it did not."""

    @property
    def shape(self) -> tuple[int, int, bool, int]:
        """Coordinates and rows of a simulation, whether the loop finds multipliers and accelerations, and events."""
        return self.y.shape[-1], self.lam.shape[-1], self.lam.shape[1] > 0, self.released.shape[-1]


def until(times: np.ndarray, over: np.ndarray) -> np.ndarray:
    """Times (T,) of outputs, or (R, T) where a simulation was ``over`` (R,) (s) before the last of them."""
    return np.minimum(times, over[:, None]) if np.isfinite(over).any() else times


def room_for(count: int, t: np.ndarray, coordinates: int, rows: int, forces: bool, events: int) -> Outputs:
    """Outputs of ``count`` simulations, used again and again: memory that is touched first costs more than a step.

    Without ``forces`` the loop finds neither multipliers nor accelerations.
    """
    times = len(t)
    return Outputs(
        t,
        np.zeros((count, times, 2, coordinates)),
        np.zeros((count, times, coordinates)),
        np.zeros((count, times if forces else 0, rows)),
        np.zeros((count, times)),
        np.zeros((count, times)),
        np.zeros(count, np.int64),
        np.zeros(count, np.int64),
        np.full(count, np.inf),
        np.full((count, events), np.inf),
    )


@dataclass
class Reacting:
    """The parts of reactions of R rows at T times."""

    packed: list[Packed]
    """One for each row, or one for all."""
    y: np.ndarray
    """(R, T, 2, 3 nb)"""
    jacobians: np.ndarray
    """(R, T, rows, 6) compact."""
    lam: np.ndarray
    """(R, T, m)"""
    times: np.ndarray
    """(T,) or (R, T)"""
    joints: np.ndarray
    """(k,) those that are wanted."""
    rows: np.ndarray
    """Their rows of J, one joint after the other."""

    def reactions_of(self, which: np.ndarray) -> Reactive:
        """Return the reactions of some rows."""
        packed, some = self.packed[0], slice(None) if len(which) == len(self.y) else which  # views, where all are meant
        jacobians, q, own = self.jacobians[some], self.y[some, :, 0], self.lam[some][..., self.rows]
        count, times = q.shape[:2]
        if len(self.packed) == 1:
            compact, poses, multipliers = (part.reshape(count * times, *part.shape[2:]) for part in (jacobians, q, own))
            made = wrenches(packed, compact, poses, multipliers, self.joints)
            wrench = made.reshape(count, times, *made.shape[1:])
        else:
            each = zip(which.tolist(), jacobians, q, own, strict=True)
            made = [wrenches(self.packed[k], *parts, joints=self.joints) for k, *parts in each]
            wrench = np.array(made)
        return Reactive(self.joints.tolist(), wrench, self.lam[some, :, packed.driver_rows :], self._drives(which))

    def _drives(self, which: np.ndarray) -> np.ndarray:
        """Laws of the drivers (T, drivers + 1, 3), or (R, T, drivers + 1, 3) of rows ``which`` that differ in them."""
        own_times = self.times if self.times.ndim == 1 else self.times[which]
        if len(self.packed) > 1:
            each = np.broadcast_to(own_times, (len(which), own_times.shape[-1]))
            return np.array([self.packed[k].drives(t) for k, t in zip(which.tolist(), each, strict=True)])
        drives = self.packed[0].drives(own_times.ravel())
        return drives.reshape(*own_times.shape, *drives.shape[1:])


class MotionsOf:
    """Motions of rows of outputs, whose runs are these, or all like the only one but for their masses (R, nb)."""

    def __init__(self, runs: Sequence[SingleRun], mass: np.ndarray | None, inertia: np.ndarray | None) -> None:
        packed = [run.ready.packed for run in runs]
        end = len(packed[0].body_names) - packed[0].states
        names = packed[0].body_names[:end]
        self.names = names
        self.com = np.array([part.com[:end] for part in packed])
        self.mass = np.array([part.system.mass[:end] for part in packed]) if mass is None else mass
        self.inertia = np.array([part.system.inertia[:end] for part in packed]) if inertia is None else inertia
        self.traces = {
            name: (
                names.index(marker.body.name),
                np.array([(run.traces[name].x, run.traces[name].y) for run in runs]),
                np.array([run.traces[name].angle for run in runs]),
            )
            for name, marker in runs[0].traces.items()
        }

    def __call__(self, out: Outputs, which: np.ndarray, reacting: Reacting | None = None) -> Motions:
        """Return the motions of the rows ``which``."""
        own = slice(None) if len(which) == len(out.status) else which  # views, where all are meant
        end, times = len(self.names), out.y.shape[1]
        q, v, a = (
            part[..., : 3 * end].reshape(-1, times, end, 3) for part in (out.y[own, :, 0], out.y[own, :, 1], out.a[own])
        )

        def some(part: np.ndarray) -> np.ndarray:
            return part[own] if len(part) > 1 else part

        traces = {name: (body, some(place), some(angle)) for name, (body, place, angle) in self.traces.items()}
        return Motions(
            self.names, q, v, a, out.work[own], some(self.com), some(self.mass), some(self.inertia), traces,
            until(out.t, out.over[own]), None if reacting is None else reacting.reactions_of(which),
        )  # fmt: skip


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
        held = np.ones(out.lam.shape, bool)
        for when, event in zip(out.released.T[..., None], events, strict=True):
            since = (times > when) | (out.over[:, None] <= times) & (when <= out.over[:, None])
            for joint in event.releases:
                held[..., packed.rows_of(joint)] &= ~since[..., None]
        return held
