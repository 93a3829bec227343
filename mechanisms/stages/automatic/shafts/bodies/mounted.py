"""What sits on a shaft in one plane, as its plan sees it (mm)."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Mounted:
    """A wheel or a cam from ``low`` to ``high`` along a shaft."""

    what: str
    """In messages."""
    z: float
    thickness: float
    radius: float
    """Radius of what it sweeps."""
    inner: float
    """The largest radius of a shaft through it."""
    is_wheel: bool
    """Whether it may sit beyond the last bearing."""

    @property
    def low(self) -> float:
        """Its lower face."""
        return self.z - self.thickness / 2

    @property
    def high(self) -> float:
        """Its upper face."""
        return self.z + self.thickness / 2
