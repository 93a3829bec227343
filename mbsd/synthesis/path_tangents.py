"""How the path of a design changes with its numbers: the closure differentiated, without another sweep.

J q' = -dPhi/dp;   the point and the angles follow from q'
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from mbsd.arrays.packing import Packed
from mbsd.derivatives.driven.tangents import Inverse
from mbsd.derivatives.numbers.terms import Along, terms_of
from mbsd.derivatives.numbers.variants import SECOND, TINY, Variation
from mbsd.kinematics.pose.close import assemble
from mbsd.kinematics.prepared import Prepared
from mbsd.model.body import Marker
from mbsd.model.mechanism import Model
from mbsd.numbers.names import Number, numbers_named

if TYPE_CHECKING:
    from mbsd.synthesis.varied import Value, Varied


class Family(Protocol):
    """Designs by their numbers, as far as tangents need them."""

    m: Model
    varied: Varied
    build: Any
    trace: str
    turned: list[str]

    def model(self, x: np.ndarray) -> Model:
        """The mechanism of one design x (k,)."""
        ...

    def solved(self, x: np.ndarray, grid: np.ndarray) -> tuple[Model, Prepared, np.ndarray]:
        """It, made ready, and its poses (T, nb, 3)."""
        ...


def path_of(packed: Packed, marker: Marker, q: np.ndarray) -> np.ndarray:
    """(T, 2) of a point at poses q (T, nb, 3)."""
    body = packed.body_names.index(marker.body.name)
    x0, y0 = np.array([marker.x, marker.y]) - packed.com[body]
    c, s = np.cos(q[:, body, 2]), np.sin(q[:, body, 2])
    return q[:, body, :2] + np.column_stack([c * x0 - s * y0, s * x0 + c * y0])


def tangents_of_path(family: Family, x: np.ndarray, grid: np.ndarray) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """(k, T, 2) and, by body, (k, T): how the point and the angles of a design x (k,) change with its numbers."""
    m, ready, q = family.solved(x, grid)
    packed, span = ready.packed, (float(grid[0]), float(grid[-1]))
    terms = terms_of(packed, span, loads=False)
    flat = np.ascontiguousarray(q.reshape(len(grid), -1))
    still = np.zeros_like(flat)
    along = Along(grid, flat, still, still, np.zeros((len(grid), len(packed.ws.phi))))
    inverse = Inverse(terms, along, bool(ready.mobility.redundant_rows))
    variation = Variation(m, terms, span, lambda m, packed: assemble(m, packed, span[0]), loads=False)
    paths = np.zeros((len(x), len(grid), 2))
    angles = {body: np.zeros((len(x), len(grid))) for body in family.turned}
    for k, number in enumerate(_numbers(family, m, x)):
        variants = variation.of(number, SECOND, TINY)
        slope = inverse.solved(-variants.slope(lambda variant: variant.terms.rows(along)[0]), number.name, 1e-6)
        for weight, variant in zip(variants.weights, variants.variants, strict=True):
            moved = (flat + variant.offset * variants.step * slope).reshape(q.shape)
            paths[k] += weight / variants.step * path_of(variant.terms.packed, variant.traces[family.trace], moved)
        for body, rows in angles.items():
            rows[k] = slope[:, 3 * packed.body_names.index(body) + 2]
    return paths, angles


def _numbers(family: Family, m: Model, x: np.ndarray) -> list[Number]:
    """The numbers of a design as those of its mechanism, or of the author's function."""
    if family.build is None:
        names = []
        for name, _, single in family.varied.columns():
            names += [name] if single else [f"{name}.x", f"{name}.y"]
        return numbers_named(m, names)

    def put(m: Model, value: float) -> None:
        raise AssertionError("it is built")

    def built(k: int, value: float) -> Model:
        return family.model(np.where(np.arange(len(x)) == k, value, x))

    names = [f"{name} {k}" for k, name in enumerate(_columns(family.varied))]
    reach = (family.varied.high - family.varied.low).tolist()
    return [Number(name, float(x[k]), put, partial(built, k), reach=reach[k]) for k, name in enumerate(names)]


def _columns(varied: Varied) -> list[str]:
    values: dict[str, Value] = varied.values(np.zeros(varied.count))
    return [name for name, value in values.items() for _ in range(len(value) if isinstance(value, tuple) else 1)]
