"""A motion as the views of forces are made from it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from mbsd.arrays.packing import Packed


@dataclass(frozen=True)
class Moved:
    """The source of views: a motion of T times, and what was computed together with it."""

    packed: Packed
    t: np.ndarray
    q: np.ndarray
    """(T, 3 nb)"""
    v: np.ndarray
    lam: np.ndarray
    """(T, m)"""
    held: np.ndarray | None
    """(T, m) rows that held; None: all."""
    span: tuple[float, float]
    """Times (s) over which the run prepared its laws."""
    a: np.ndarray
    """(T, 3 nb)"""
    approached: np.ndarray | None = None
    """(T, n) how fast the contact of each interaction approached when it began (m/s), where one asks for it."""
    states: np.ndarray | None = None
    """(T, n) of all forces that carry states (SI); None: none does."""
