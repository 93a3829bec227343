"""Values that no argument takes, and values that some take: for tests that give wrong ones everywhere."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mbsd import Mechanism

NEVER: dict[str, Callable[[], Any]] = {
    "text": lambda: "0.5",
    "bytes": lambda: b"1",
    "nan": lambda: math.nan,
    "inf": lambda: -math.inf,
    "1e300": lambda: 1e300,
    "10**400": lambda: 10**400,
    "10**5000": lambda: 10**5000,
    "complex": lambda: 1 + 2j,
    "object": object,
    "type error": lambda: _Hostile(),
    "ragged": lambda: [[0.0, 1.0], [2.0]],
    "texts": lambda: ["0", "1"],
    "nans": lambda: [math.nan, 1.0, 1.0],
    "huge pair": lambda: (1e200, 1.0),
    "nested": lambda: _nested(3000),
    "own kind": lambda: Mechanism("other").bar("q", 1.0),
    "foreign marker": lambda: Mechanism("other").bar("q", 1.0).end,
    "array": lambda: np.zeros((2, 2, 2)),
}
"""Values that no argument takes, but for text where the signature says so."""
ODD: dict[str, Callable[[], Any]] = {
    "none": lambda: None,
    "true": lambda: True,
    "zero": lambda: 0,
    "minus": lambda: -1.0,
    "tiny": lambda: 1e-300,
    "large": lambda: 1e99,
    "empty": list,
    "pair": lambda: (0.0, 0.0),
    "three": lambda: [1.0, 2.0, 3.0],
    "empty text": lambda: "",
    "dict": dict,
    "lambda": lambda: lambda: 1.0,
    "numpy": lambda: np.float32(0.3),
    "numpy bool": lambda: np.True_,
}
"""Values that some arguments take: no traceback, and an accepted one can be solved or is refused then."""


class _Hostile:
    def __repr__(self) -> str:
        raise RuntimeError("no repr")

    def __len__(self) -> int:
        raise RuntimeError("no length")

    def __eq__(self, other: object) -> bool:
        raise RuntimeError("no equality")

    __hash__ = None  # pyright: ignore[reportAssignmentType]


def _nested(depth: int) -> list:
    out: list = []
    for _ in range(depth):
        out = [out]
    return out
