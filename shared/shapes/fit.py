"""Fits: the clearances between parts, in one place for all machines and printers."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Fit:
    """Clearances in mm. The defaults suit turned and milled parts; printed ones run well with running=0.3."""

    running: float = 0.2
    """Diametral, between a pin and what turns on it."""
    press: float = 0.02
    """Diametral, between a pin or bushing and the part that holds it."""
    axial: float = 0.4
    """Between faces that move past each other."""
    seat: float = 0.02
    """Between faces of one body that rest on each other; keeps them from sharing a face in a picture."""
