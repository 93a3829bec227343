"""Tables of terms: places and axes that rows use, each once, and one table for each kind of term."""

from __future__ import annotations

from typing import Any

import numpy as np

from mbsd.spatial.model.body import Body, Marker
from mbsd.spatial.model.rows import AXES, TERMS, Row, Term


class Tables:
    """Places, axes and terms as they are collected."""

    def __init__(self, bodies: list[Body]) -> None:
        self._number = {body.name: b for b, body in enumerate(bodies)}
        self._places: dict[tuple[Any, ...], int] = {}
        self._axes: dict[tuple[Any, ...], int] = {}
        self._terms: dict[str, list[tuple[int, ...]]] = {kind: [] for kind in TERMS}
        self._weights: dict[str, list[float]] = {kind: [] for kind in TERMS}
        self._rounds: list[tuple[float, float]] = []
        self._row_bodies: list[list[int]] = []

    def add(self, row: Row, first: int) -> list[int]:
        """Add a row, whose first row of J is ``first``; returns the numbers of its bodies by side."""
        sides = list(dict.fromkeys(self._number[marker.body.name] for t in row.terms for marker in (t.i, t.j)))
        for t in row.terms:
            columns = tuple(6 * sides.index(self._number[marker.body.name]) for marker in (t.i, t.j))
            self._terms[t.kind].append((first, *self._measured(t), *columns))
            self._weights[t.kind].append(t.weight)
            self._rounds += [t.round] * (t.kind == "roll")
        self._row_bodies += [sides] * row.count
        return sides

    def _measured(self, t: Term) -> tuple[int, ...]:
        """Return the numbers of the axes and places that a term measures."""
        if t.kind == "dot":
            return self._axis(t.i, t.first), self._axis(t.j, t.second)
        if t.kind == "turn":
            return self._axis(t.i, "x"), self._axis(t.i, "y"), self._axis(t.j, "x")
        ends = self.place(t.i), self.place(t.j)
        if t.kind == "roll":
            return (*(self._axis(marker, axis) for marker in (t.i, t.j) for axis in AXES), *ends)
        return (self._axis(t.i, t.first), *ends) if t.kind == "along" else ends

    def place(self, marker: Marker) -> int:
        """Return the number of a marker's place."""
        body = marker.body
        arm = body.principal[1].T @ (np.array(marker.place) - np.array(body.com))
        return self._places.setdefault((self._number[body.name], *arm.tolist()), len(self._places))

    def _axis(self, marker: Marker, axis: str) -> int:
        own = marker.body.principal[1].T @ marker.axes[:, AXES.index(axis)]
        return self._axes.setdefault((self._number[marker.body.name], *own.tolist()), len(self._axes))

    def arrays(self, rows: int) -> dict[str, np.ndarray]:
        """Return the fields of a System that these tables hold, for ``rows`` of J."""
        width = {"point": 5, "dot": 5, "along": 6, "distance": 5, "turn": 6, "roll": 11}
        sides = max((len(bodies) for bodies in self._row_bodies), default=2)
        row_body = np.full((rows, sides), -1, np.int64)
        for r, bodies in enumerate(self._row_bodies):
            row_body[r, : len(bodies)] = bodies
        places, axes = np.array(list(self._places), float), np.array(list(self._axes), float)
        out = {
            "arm_body": places.reshape(-1, 4)[:, 0].astype(np.int64),
            "arm": np.ascontiguousarray(places.reshape(-1, 4)[:, 1:]),
            "axis_body": axes.reshape(-1, 4)[:, 0].astype(np.int64),
            "axis": np.ascontiguousarray(axes.reshape(-1, 4)[:, 1:]),
            "row_body": row_body,
            "roll_number": np.array(self._rounds, float).reshape(-1, 2),
        }
        for kind, columns in width.items():
            out[kind] = np.array(self._terms[kind], np.int64).reshape(-1, columns)
            if kind not in ("point", "roll"):
                out[f"{kind}_weight"] = np.array(self._weights[kind], float)
        return out
