"""Every kind of mechanism that is hunted."""

from __future__ import annotations

import importlib
import pkgutil

from tools.hunt import mechanisms
from tools.hunt.subject import FAMILIES, Family


def all_families() -> dict[str, Family]:
    """By name, with all files of tools/hunt/mechanisms loaded."""
    for module in sorted(info.name for info in pkgutil.iter_modules(mechanisms.__path__)):
        importlib.import_module(f"{mechanisms.__name__}.{module}")
    return FAMILIES
