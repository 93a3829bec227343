"""A joint or driver of a mechanism: its kind, its two markers, its numbers."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from mbsd.model.body import Marker
from mbsd.model.joints.kind import JointKind
from mbsd.model.laws import Motion


@dataclass(frozen=True, eq=False)
class Joint:
    """A joint or driver between marker i (first body) and marker j (second body)."""

    kind: JointKind
    name: str
    i: Marker
    j: Marker
    params: Mapping[str, Any] = field(default_factory=dict)
    """Numbers of this joint by the names of its method's arguments, plain data (SI)."""
    motion: Motion | None = None

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the first and second body."""
        return self.i.body.name, self.j.body.name
