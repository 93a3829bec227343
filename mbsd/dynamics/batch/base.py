"""A run before its first step, laid out in a block of numbers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from mbsd.dynamics.batch.block import Layout, laid_out
from mbsd.dynamics.batch.single_run import SingleRun


@dataclass
class Base:
    """A run laid out in a block, which all others of its kind share."""

    run: SingleRun
    arguments: tuple[Any, ...]
    block: np.ndarray
    layout: Layout
    kind: tuple[Any, ...]
    fresh: np.ndarray
    """(1, N) the block before the first step."""


def based_on(run: SingleRun) -> Base:
    """Lay out a run that has not begun."""
    arguments, block, layout = laid_out(run.arguments)
    return Base(run, arguments, block, layout, run.kind, block[None].copy())
