"""Arrays of the embedding: what the compiled loops read (Embedding) and what each evaluation overwrites.

z has f coordinates. C = f columns, one more (of the time) where drivers are; each column of ``rate`` is the rate of all
bodies for one of them, and a last one holds the convective acceleration c. Columns that closed forms use are named in
mbsd/kinematics/groups/groups.py and carrying/columns.py, entries of the arrays of blocks in block.py.
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
    """Integers of blocks; mbsd/dynamics/independent/block.py."""
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
    """True if forces read the angles of bodies."""


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
    """Scratch of blocks; mbsd/dynamics/independent/block.py."""
    force: Any
    """(3 nb,) forces beside the weight, zero where there are none."""
    watch: Any
    """(2,) the largest rate of a body for one unit of a coordinate, and where another choice is looked for."""
    before: Any
    """(3, 3 nb) q, v, a of a pose before an unclear one."""
    joined_body: Any
    """(3, nb, 4) of poses beside an unclear one: place and turn, their errors, and those of the pose itself."""
    joined_rate: Any
    """(3, nb, 3 (C + 1)) the same of ``rate``; the last part keeps rows of ``base`` and ``rate``."""
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
