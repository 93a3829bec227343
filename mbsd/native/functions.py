"""Functions that kernels call by addresses in their arrays, and where these addresses stand."""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from typing import Any

import numpy as np

from mbsd.arrays.directory import directory
from mbsd.arrays.packing import Packed
from mbsd.equations.interactions import call
from mbsd.equations.loads import Loads
from mbsd.model.joint import SPECIALS

FORCE, APPLY = 4, 5
"""Columns of Loads.interaction with addresses."""


def functions_at(packed: Packed, loads: Loads) -> Iterator[tuple[np.ndarray, tuple[int, ...], str, Any]]:
    """Array, entry, name and function (numba's CFunc) of each address that is not a user's."""
    for k, name in enumerate(packed.specials.names):
        equation = SPECIALS[name].equation
        made = importlib.import_module(f"mbsd.equations.relative.{equation}").residual
        yield packed.system.address, (k,), f"relative_{equation}", made
    for rows in directory(packed).values():
        for interaction, row in zip(rows.interactions, rows.interaction, strict=True):
            made = importlib.import_module(f"mbsd.equations.interactions.{interaction.function}").force
            yield loads.interaction, (row, FORCE), f"interaction_{interaction.function}", made
            yield loads.interaction, (row, APPLY), "apply_interactions", call._apply()  # pyright: ignore[reportPrivateUsage]
