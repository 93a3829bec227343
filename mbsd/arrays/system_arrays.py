"""Arrays of a mechanism from its numbers and tables; those of a small one are kept for the next solve."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from mbsd.arrays.relative import Specials
from mbsd.base.kept import Kept
from mbsd.equations.system import System, Workspace, constant_system, workspace

MOST_KEPT = 60
"""Coordinates of mechanisms whose arrays and start are kept for the next solution."""
SMALLEST_SIZE = 1e-12
"""Below this (m) all joints sit at the centres of mass, and 1 m serves as size."""


class Arrays(NamedTuple):
    """The arrays of a mechanism; see mbsd.arrays.packing.Packed."""

    system: System
    ws: Workspace
    com: np.ndarray
    first_row: np.ndarray
    markers: np.ndarray
    force_markers: np.ndarray
    size: float
    constant: tuple[bytes, ...] | None


@dataclass(frozen=True)
class Parts:
    """The parts of a model that the arrays are made of."""

    numbers: list[float]
    """Gravity; mass, inertia and com of each body; x, y and angle of each marker; offsets, lengths, extents."""
    bodies: int
    marker_body: tuple[int, ...]
    offsets: int
    lengths: int
    first_row: tuple[int, ...]
    tables: tuple[tuple[str, tuple[tuple[int, int, int, int], ...]], ...]
    """Constraints of each kind: markers i and j, row, motion."""


_ARRAYS: Kept[Arrays] = Kept()


def arrays_of(parts: Parts, specials: Specials, forces: int) -> Arrays:
    """Arrays whose scratch is the caller's own; the others are shared."""
    numbers = np.array(parts.numbers, float)
    if specials.names or 3 * (parts.bodies - 1) > MOST_KEPT:
        return _made(parts, numbers, specials, forces)
    own = parts.bodies, parts.marker_body, parts.offsets, parts.lengths, parts.first_row, parts.tables, forces
    kept = _ARRAYS.get((numbers.tobytes(), *own), lambda: _made(parts, numbers, specials, forces))
    return kept._replace(ws=Workspace(*[part.copy() for part in kept.ws]))


def _made(parts: Parts, numbers: np.ndarray, specials: Specials, forces: int) -> Arrays:
    body_end = 2 + 4 * parts.bodies
    marker_end = body_end + 3 * len(parts.marker_body)
    body = numbers[2:body_end].reshape(-1, 4)
    marker = numbers[body_end:marker_end].reshape(-1, 3)
    offsets, lengths, extents = np.split(numbers[marker_end:], np.cumsum([parts.offsets, parts.lengths]))
    com = body[:, 2:].copy()
    marker_body, first_row = np.array(parts.marker_body, np.int64), np.array(parts.first_row, np.int64)
    joints = len(first_row) - 1
    markers = np.arange(2 * joints).reshape(-1, 2)
    force_markers = 2 * joints + np.arange(2 * forces).reshape(-1, 2)
    as_table = {name: np.array(rows, np.int64).reshape(-1, 4) for name, rows in parts.tables}
    marker_arm = marker[:, :2] - com[marker_body]
    size = _size(marker_arm, marker_body, [*lengths, *extents])
    special, addresses, special_numbers = specials.arrays(marker_body, size)
    system = System(
        mass=body[:, 0].copy(),
        inertia=body[:, 1].copy(),
        gravity=numbers[:2].copy(),
        marker_body=marker_body,
        marker_arm=marker_arm,
        marker_axis=np.stack([np.cos(marker[:, 2]), np.sin(marker[:, 2])], axis=1),
        moving=np.flatnonzero(marker_body),
        directed=_directed(
            marker_body, as_table["slot"][:, 0], as_table["along"][:, 0], special[:, 0], force_markers[:, 0]
        ),
        special=special,
        address=addresses,
        numbers=special_numbers,
        row_body=marker_body[np.repeat(markers, np.diff(first_row), axis=0)],
        driven=_driven(*as_table.values(), special),
        angle_offset=offsets.copy(),
        distance_length=lengths.copy(),
        **as_table,
    )
    system = constant_system(*system)
    own = None
    if not len(special) and 3 * (parts.bodies - 1) <= MOST_KEPT:
        fixed = [part.tobytes() for name, part in system._asdict().items() if name != "angle_offset"]
        own = (*fixed, com.tobytes(), np.float64(size).tobytes())
    ws = workspace(system, parts.first_row[-1])
    return Arrays(system, ws, com, first_row, markers, force_markers, size, own)


def _driven(*tables: np.ndarray) -> np.ndarray:
    """(drivers, 2) row and motion of the driven rows."""
    rows = np.concatenate([table[:, 2:4] for table in tables])
    return rows[rows[:, 1] > 0]


def _directed(marker_body: np.ndarray, *first_markers: np.ndarray) -> np.ndarray:
    """Return first markers of slots, coordinates, relative poses and forces that are on moving bodies."""
    first = np.concatenate(first_markers)
    return np.unique(first[marker_body[first] > 0])


def _size(marker_arm: np.ndarray, marker_body: np.ndarray, lengths: list[float]) -> float:
    extents = [*lengths, *np.hypot(*marker_arm[marker_body > 0].T)]  # how far away the world's origin is says nothing
    for body in np.unique(marker_body):
        extents.append(float(np.linalg.norm(np.ptp(marker_arm[marker_body == body], axis=0))))
    largest = float(max(extents, default=0.0))
    return largest if largest > SMALLEST_SIZE else 1.0
