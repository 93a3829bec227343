"""Arrays of the embedding: what the compiled loops read (Embedding) and what each evaluation overwrites.

z has f coordinates. C = f columns, one more (of the time) where drivers are; each column of ``rate`` is the rate of all
bodies for one of them, and a last one holds the convective acceleration c.
"""

from __future__ import annotations

from typing import Any, NamedTuple

X, Y, COS, SIN, OMEGA, MASS, INERTIA = range(7)
"""Columns of EmbeddingScratch.body: place of the centre of mass, turn, rate of turning; kg, kg m^2."""
KIND, FIRST, SECOND, K1, K2, LAW, COORDINATE = range(7)
"""Columns of Embedding.group: kind, bodies A and B, known bodies, law of a driver, coordinate; -1 or law 0 for none."""
NUMBERS = 20
SIGN, NEAR, SINE, AVOID = 16, 17, 18, 19
"""Columns of Embedding.number that change: branch, whether it may change within a step, squared sine of its angle;
and the squared sine below which the pose is unclear, a number of the run."""
THETA, BEND, TURNS = 0, 1, 2
"""Columns of EmbeddingScratch.base: angle, convective acceleration, then the rates of turning."""
VALUE, SPEED, BASE = 0, 1, 2
"""Columns of EmbeddingScratch.coordinate."""
SENSITIVITY, LIMIT = 0, 1
"""Of EmbeddingScratch.watch."""


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
    """(g, 7) in the order of their solution; columns above."""
    number: Any
    """(g, 20); mbsd/dynamics/embedding/numbers.py."""
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
    """(nb, 7) columns above."""
    rate: Any
    """(nb, 3 (C + 1))"""
    base: Any
    """(nb, C + 2) at the last accepted pose; columns above."""
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
