"""A force of a mechanism: its kind, its markers, its numbers and its laws."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from mbsd.model.body import Marker
from mbsd.model.forces.kind import ForceKind
from mbsd.model.laws import Motion
from mbsd.model.laws.curve import Curve


@dataclass(frozen=True, eq=False)
class Force:
    """A force between marker i (first body, or ground) and marker j (second body)."""

    kind: ForceKind
    name: str
    i: Marker
    j: Marker
    params: Mapping[str, Any] = field(default_factory=dict)
    """Numbers of this force by the names of its method's arguments, plain data (SI)."""
    laws: Mapping[str, Motion | Curve] = field(default_factory=dict)
    """Laws of time and characteristic curves by the names of its method's arguments."""

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the first and second body."""
        return self.i.body.name, self.j.body.name
