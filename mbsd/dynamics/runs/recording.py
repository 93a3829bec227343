"""What a run recorded: its outputs, the rows of J that held at each, its events, and points to go on from."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from mbsd.dynamics.prepare.approaches import Approaches
from mbsd.dynamics.state import Output
from mbsd.model.event import Happening


@dataclass
class Snapshot:
    """A state with all that events had changed, from which a run can go on."""

    y: np.ndarray
    """(2, 3 nb)"""
    time: float
    work: float
    held: tuple[np.ndarray, ...] = ()
    """Arrays that events change."""
    released: frozenset[int] = frozenset()
    """Rows of joints that are released for good."""


@dataclass
class Recording:
    """The outputs of a run and what belongs to them."""

    out: Output
    held: np.ndarray
    """(T, m) which rows held at each output."""
    steps: int
    happenings: list[Happening] = field(default_factory=list)
    snapshots: list[Snapshot] = field(default_factory=list)
    approaches: Approaches | None = None
    """How fast contacts approached; None where none asks."""
    independent: bool = False
    """Integrated in independent coordinates; multipliers and margins are still to be found."""

    def only(self, outputs: np.ndarray) -> Recording:
        """The same with some of its outputs alone, by a mask (T,): those from which a run may go on."""
        return replace(self, out=Output(*(part[outputs] for part in self.out)), held=self.held[outputs])
