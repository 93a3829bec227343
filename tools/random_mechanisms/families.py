"""Every kind of mechanism that is hunted."""

from __future__ import annotations

import importlib
import pkgutil

from tools import random_mechanisms
from tools.random_mechanisms.subject import FAMILIES, Family


def all_families() -> dict[str, Family]:
    """By name, with all files of tools/random_mechanisms loaded."""
    for module in sorted(info.name for info in pkgutil.iter_modules(random_mechanisms.__path__)):
        importlib.import_module(f"{random_mechanisms.__name__}.{module}")
    return FAMILIES
