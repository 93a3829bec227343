"""Arrays of the embedding: what the compiled loops read (Embedding) and what each evaluation overwrites.

z has f coordinates. C = f columns, one more (of the time) where drivers are; each column of ``rate`` is the rate of all
bodies for one of them, and a last one holds the convective acceleration c. Columns that closed forms use are named in
mbsd/kinematics/groups/groups.py and groups/carried.py, entries of the arrays of blocks (block.py) below.
"""

from __future__ import annotations

from typing import Any, NamedTuple

SENSITIVITY, LIMIT = 0, 1
"""Places in EmbeddingScratch.watch."""


class Embedding(NamedTuple):
    """A mechanism in independent coordinates z (f,)."""

    laws: Any
    """mbsd.equations.laws.Laws"""
    loads: Any
    """mbsd.equations.loads.Loads"""
    inertia: Any
    """(3 nb,) diagonal of M."""
    weight: Any
    """(3 nb,) M g."""
    gravity: Any
    """(2,) m/s^2."""
    group: Any
    """(g, 8) Groups.group."""
    number: Any
    """(g, 21) Groups.row."""
    block: Any
    """Integers of blocks; mbsd/dynamics/runs/embedding.py."""
    block_number: Any
    """Their numbers."""
    numbers: Any
    """``System.numbers``, which their equations read."""
    size: Any
    """(f,) what one unit of a coordinate is against the mechanism's size: 1 for an angle."""
    per_size: Any
    """(3 nb,) 1 / size for x and y, 1 for theta."""
    loaded: Any
    """Bodies that forces act on or read."""
    angles: bool
    """Whether forces read the angles of bodies."""


class EmbeddingScratch(NamedTuple):
    """Scratch of one thread."""

    cos_sin: Any
    """(nb, 2) of the body angles, where there are forces."""
    body: Any
    """(nb, 7)"""
    rate: Any
    """(nb, 3 (C + 1))"""
    base: Any
    """(nb, C + 2) at the last accepted pose."""
    coordinate: Any
    """(C + 1, 3) value, speed, and value at the last accepted pose; the last row is the time since then."""
    q: Any
    """(3 nb,)"""
    v: Any
    """(3 nb,)"""
    mass: Any
    """(f, f) B^T M B, then its Cholesky factor."""
    sums: Any
    """(2,) with one coordinate: its inertia B^T M B, and B^T M (g - c)."""
    drive: Any
    """(drivers + 1, 3)"""
    block_work: Any
    """Scratch of blocks; mbsd/dynamics/runs/embedding.py."""
    force: Any
    """(3 nb,) forces beside the weight, zero where there are none."""
    watch: Any
    """(2,) the largest rate of a body for one unit of a coordinate, and where another choice is looked for."""
    before: Any
    """(3, 3 nb) q, v, a of a pose before an unclear one."""
    joined_body: Any
    """(2, nb, 4) of poses beside an unclear one: place and turn, and their errors."""
    joined_rate: Any
    """(2, nb, 3 (C + 1)) the same of ``rate``."""
    multipliers: Any
    """(0,)"""
    state: Any
    """(2, 3 + f) trial state of a stage; the first three entries mean nothing, as ground's in reference coordinates."""
    stages: Any
    """(stages, 2, 3 + f)"""
    power: Any
    """(stages,)"""
    dense: Any
    """(8, 2, 3 + f)"""
    dense_work: Any
    """(7,)"""
    report: Any
    """(4,)"""
    spare_0: Any
    spare_1: Any
    spare_2: Any
    """(1,) each, never read. This tuple is handed over by value; without them its copies lie 4 KB from what the loops
    write, loads wait for stores that are not theirs (4K aliasing), and a pendulum takes three times as long. Measure
    again (``python -m benchmarks calls``) where this tuple or Embedding gets longer or shorter.
    """


(
    HEADS,
    KEPT_SIZE,
    Q,
    KEPT_Q,
    UNKNOWN_AT,
    DETERMINANT_AT,
    SEEN_AT,
    V,
    A,
    TURN_AT,
    UNKNOWN_WORK,
    JAC,
    OUT,
    SOLUTION,
    POINT,
    SCRATCH,
    WORK,
) = range(17)
"""Entries of ``block``: where its heads begin, and places in the scratch. What the last accepted pose leaves is
``KEPT_SIZE`` numbers from ``KEPT_Q`` on, a copy of those from ``Q`` on: poses q (3 nb,), then for each unknown its
value, convective acceleration and columns of B, then the determinant of each block. From ``SEEN_AT`` on stand the
coordinates and the time at which each block was evaluated last."""
HEAD = 9
"""Length of a head."""
BODIES, EQUATIONS, NEAR_COUNT, TREE, ROWS, NEAR_AT, FRAME, ARMS, FIRST = range(9)
"""Entries of a head: bodies, equations, known bodies beside; where its lines begin in ``block`` and, of FRAME and ARMS,
in ``block_number``; its first unknown."""
TREE_WIDTH, ROWS_WIDTH, FRAME_WIDTH, ARMS_WIDTH = 5, 9, 7, 9


class Past(NamedTuple):
    """Memory of one block with n unknowns and C columns of B."""

    q: Any
    """(3 nb,) the last accepted pose."""
    here: Any
    """(n, C + 2) unknowns, convective accelerations and columns: of the evaluation before, then of the present one."""
    kept: Any
    """The same at the last accepted pose."""
    seen: Any
    """(C + 1,) coordinates and time at which ``here`` was evaluated."""
    determinant: Any
    """The determinant of G at the last accepted pose; 0 at the first."""
