"""Names of prims: identifiers, each once below the same prim."""

from __future__ import annotations

from pxr import Tf


class Names:
    """The names below one prim."""

    def __init__(self, parent: str) -> None:
        """``parent`` is its path; ``/`` is above all."""
        self._parent = parent.rstrip("/")
        self._taken: set[str] = set()

    def path(self, name: str) -> str:
        """The path of a new prim for something that is called so: ``rod 1`` becomes ``rod_1``."""
        wish = valid = Tf.MakeValidIdentifier(name)
        number = 1
        while valid in self._taken:
            number += 1
            valid = f"{wish}_{number}"
        self._taken.add(valid)
        return f"{self._parent}/{valid}"
