"""Results of a mechanism with any numbers of its Params, as vectors that can be added."""

from __future__ import annotations

import math
import time
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from mbsd.base.errors import MechanismError
from shared.stage.errors import UserError
from studio.live.child.author import Author

# Numbers of a payload as one vector, so that payloads of several designs can be added.


ROWS = 91
"""Times of a motion that a stored design keeps, at most."""
DENSE = 32
"""Points of a curve of the skeleton that has more."""
LEFT_OUT = ("marks", "clearance", "solid", "trails", "gravity", "mechanism", "title", "frame", "couple")
"""Fields that do not change with a design, or are not shown between the stored ones."""

Path = tuple[str | int, ...]


class Unlike(Exception):
    """Error for two designs whose payloads have different forms, so that nothing lies between them."""


def thinned(payload: dict[str, Any]) -> dict[str, Any]:
    """Return a payload at no more than ROWS of its times, evenly, without fields that are left out."""
    count = len(payload["time"])
    rows = np.unique(np.linspace(0, count - 1, min(count, ROWS)).round().astype(int))

    def plain(value: Any) -> Any:
        if isinstance(value, np.ndarray):
            if len(value) == count:
                return value[rows]
            return value[rows] if value.ndim > 1 and value.shape[0] == count else value
        if isinstance(value, dict):
            return {key: plain(part) for key, part in value.items()}
        return [plain(part) for part in value] if isinstance(value, list | tuple) else value

    out = {key: plain(value) for key, value in payload.items() if key not in LEFT_OUT}
    for stroke in out["skeleton"]["strokes"]:
        if stroke["shapes"] is None and len(stroke["points"]) > 2 * DENSE:
            stroke["points"] = _even(stroke["points"])
    return out


def _even(points: np.ndarray) -> np.ndarray:
    """Return DENSE points along a curve, (2 DENSE,), at even distances.

    The number of points of the curve depends on its size.
    """
    places = np.asarray(points, float).reshape(-1, 2)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(places, axis=0).T))])
    even = np.linspace(0.0, along[-1], DENSE)
    return np.column_stack([np.interp(even, along, places[:, axis]) for axis in (0, 1)]).ravel().astype(np.float32)


def leaves(payload: Any, path: Path = ()) -> Iterator[tuple[Path, np.ndarray]]:
    """Yield every array and number with its path, in a fixed order.

    Whole numbers, words and None do not vary with a design.
    """
    if isinstance(payload, np.ndarray):
        yield path, np.asarray(payload, float).ravel()
    elif isinstance(payload, float):
        yield path, np.array([payload])
    elif isinstance(payload, dict):
        for key in payload:
            yield from leaves(payload[key], (*path, key))
    elif isinstance(payload, list | tuple):
        for k, part in enumerate(payload):
            yield from leaves(part, (*path, k))


def form(payload: Any) -> Any:
    """Return a payload with {"#": length} for each array and {"#": None} for each number.

    A vector fills it.

    Arrays of doubles say so.
    """
    if isinstance(payload, np.ndarray):
        return {"#": payload.size} | ({"double": True} if payload.dtype == np.float64 else {})
    if isinstance(payload, float):
        return {"#": None}
    if isinstance(payload, dict):
        return {key: form(part) for key, part in payload.items()}
    return [form(part) for part in payload] if isinstance(payload, list | tuple) else payload


def vector(payload: dict[str, Any], base: list[tuple[Path, np.ndarray]] | None = None) -> np.ndarray:
    """Return all numbers of a payload; angles within half a turn of those of ``base``. Raises Unlike."""
    ours = list(leaves(payload))
    if base is None:
        return np.concatenate([values for _, values in ours])
    if [(path, len(values)) for path, values in ours] != [(path, len(values)) for path, values in base]:
        raise Unlike
    out = []
    for (path, values), (_, usual) in zip(ours, base, strict=True):
        turns = math.tau * round((usual[0] - values[0]) / math.tau) if path[-1] == "theta" and len(values) else 0.0
        out.append(values + turns)
    joined = np.concatenate(out)
    if not np.isfinite(joined).all():
        raise Unlike
    return joined


def where(base: list[tuple[Path, np.ndarray]], *names: str) -> np.ndarray:
    """Return True for numbers of the vector in arrays of one of these names, (N,)."""
    return np.concatenate([np.full(len(values), path[-1] in names) for path, values in base])


# Mechanism solved with any numbers of its Params, as vectors that can be added.


PLACES = ("x", "y")
EFFORTS = ("effort", "fx", "fy", "torque")


class Solved:
    """Designs of one mechanism; ``patience`` (s) bounds the time of all of them together."""

    def __init__(self, author: Author, patience: float) -> None:
        self.author = author
        self.ends = time.monotonic() + patience
        author.payload({})  # a whole one, whose symbols the quick ones keep
        self.payload = thinned(author.payload({}, quick=True))
        self.base = list(leaves(self.payload))
        self.usual = vector(self.payload)
        self.places, self.efforts = where(self.base, *PLACES), where(self.base, *EFFORTS)
        low, high = (np.array(self.payload["skeleton"][end]) for end in ("low", "high"))
        self.size = float(np.max(high - low))
        """m, of all that the machine sweeps."""
        self._kept: dict[tuple[tuple[str, float], ...], np.ndarray | None] = {}

    @property
    def is_late(self) -> bool:
        """True if the time is up."""
        return time.monotonic() > self.ends

    def numbers_at(self, values: Mapping[str, float]) -> np.ndarray | None:
        """Return the numbers of a design, (N,); None if it is not solved to its end or differs in form."""
        key = tuple(sorted(values.items()))
        if key not in self._kept:
            self._kept[key] = None if self.is_late else self._solve(dict(values))
        return self._kept[key]

    def away(self, first: np.ndarray, second: np.ndarray) -> tuple[float, float]:
        """Return how far two designs differ, relative to the machine's size and to its largest effort."""
        gap = np.abs(first - second)
        largest = max(float(np.abs(self.usual[self.efforts]).max(initial=0.0)), 1e-12)
        places = float(gap[self.places].max(initial=0.0)) / self.size
        return places, float(gap[self.efforts].max(initial=0.0)) / largest

    def _solve(self, values: dict[str, float]) -> np.ndarray | None:
        try:
            payload: dict[str, Any] = self.author.payload(values, quick=True)
            return vector(thinned(payload), self.base)
        except (UserError, MechanismError, Unlike, ArithmeticError, ValueError):
            return None
