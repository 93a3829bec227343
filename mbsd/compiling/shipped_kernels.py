"""Compiled code that came in the wheel: where it is, and what it is for."""

from __future__ import annotations

import json
import logging
import platform
from functools import cache
from pathlib import Path

import numba

LOG = logging.getLogger("mbsd")
SHIPPED = Path(__file__).parent.parent / "kernels"
"""Folders as in mbsd/compiling/kernel_cache.py; there is none in a clone, nor in a wheel without kernels."""
MADE_FOR = SHIPPED / "made_for.json"
"""What it was compiled for, as :func:`here` says it."""


def here() -> dict[str, str]:
    """Return what compiled code depends on beside its sources."""
    return {
        "Python": platform.python_version().rpartition(".")[0],
        "numba": numba.__version__,
        "system": platform.system(),
        "processor": platform.machine(),
    }


@cache
def tell_of_other_kernels() -> None:
    """Log, once, why the wheel's kernels do not serve here, if they do not."""
    try:
        made_for = json.loads(MADE_FOR.read_text())
    except (OSError, ValueError):
        made_for = {}
    others = [f"{what} {made_for.get(what)} (here {it})" for what, it in here().items() if made_for.get(what) != it]
    if others:
        LOG.warning("mbsd: the kernels of its wheel are for %s, so they are compiled anew", ", ".join(others))
