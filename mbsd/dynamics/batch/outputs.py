"""Outputs of the compiled loop, and the motions that they are."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.arrays.reactions import wrenches
from mbsd.dynamics.batch.single_run import SingleRun
from mbsd.dynamics.measures.quantities import Motions, Reactive


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
