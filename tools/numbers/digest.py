"""A hash of the raw bytes of what the solver gives."""

from __future__ import annotations

import hashlib
from typing import Any

from tools.numbers.contents import contents


def digest(result: Any) -> str:
    """Hash of all numbers of a result, by name; texts count too."""
    whole = hashlib.sha256()
    for name, value in contents(result):
        whole.update(name.encode() + b"\0" + (value.encode() if isinstance(value, str) else value.tobytes()))
    return whole.hexdigest()[:16]
