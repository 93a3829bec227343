"""Materials by name: density for the physics, appearance for the film. parts.py names one for each piece.

Densities are handbook values (kg/m^3); colours are linear RGB.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """What a piece is made of. ``finish`` picks the film's shader; the numbers tune it."""

    density: float
    """kg/m^3."""
    colour: tuple[float, float, float]
    finish: str
    """One of: anodised, brushed, polished, satin, plastic, rubber."""
    roughness: float = 0.3


MATERIALS: dict[str, Material] = {
    "aluminium": Material(2700.0, (0.80, 0.81, 0.83), "brushed", 0.32),
    "aluminium_orange": Material(2700.0, (0.85, 0.17, 0.02), "anodised", 0.30),
    "aluminium_blue": Material(2700.0, (0.02, 0.16, 0.52), "anodised", 0.30),
    "aluminium_red": Material(2700.0, (0.55, 0.02, 0.03), "anodised", 0.30),
    "aluminium_green": Material(2700.0, (0.03, 0.30, 0.12), "anodised", 0.30),
    "aluminium_violet": Material(2700.0, (0.20, 0.05, 0.45), "anodised", 0.30),
    "aluminium_gold": Material(2700.0, (0.80, 0.50, 0.10), "anodised", 0.30),
    "aluminium_black": Material(2700.0, (0.018, 0.018, 0.020), "satin", 0.42),
    "steel": Material(7850.0, (0.56, 0.57, 0.58), "brushed", 0.28),
    "brass": Material(8500.0, (0.83, 0.58, 0.22), "polished", 0.22),
    "bronze": Material(8800.0, (0.52, 0.30, 0.14), "polished", 0.30),
    "pla_white": Material(1240.0, (0.75, 0.75, 0.73), "plastic", 0.45),
    "pla_black": Material(1240.0, (0.02, 0.02, 0.02), "plastic", 0.45),
    "pla_orange": Material(1240.0, (0.80, 0.20, 0.03), "plastic", 0.45),
    "beech": Material(720.0, (0.42, 0.21, 0.085), "satin", 0.50),
    "leather": Material(950.0, (0.13, 0.045, 0.018), "satin", 0.55),
    "rubber": Material(1150.0, (0.02, 0.02, 0.02), "rubber", 0.8),
}
