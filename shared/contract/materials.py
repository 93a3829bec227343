"""Materials by name: density for physics, appearance for the film. parts.py names one for each piece.

Densities are handbook values (kg/m^3); colours are linear RGB. Inks of anodised aluminium are those of the solver's
drawings (mbsd/drawing/look.py).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """Material of a piece. ``finish`` picks the film's shader; the numbers tune it."""

    density: float
    """kg/m^3."""
    colour: tuple[float, float, float]
    finish: str
    """One of: anodised, brushed, polished, satin, plastic, printed, rubber, cast, wood, glass."""
    roughness: float = 0.3
    ink: str = "#66717b"
    """Ink of drawn things of this material on light paper, dark enough for text (sRGB)."""


MATERIALS: dict[str, Material] = {
    "aluminium": Material(2700.0, (0.80, 0.81, 0.83), "brushed", 0.32, ink="#66717b"),
    "aluminium_orange": Material(2700.0, (0.85, 0.17, 0.02), "anodised", 0.30, ink="#c4500a"),
    "aluminium_blue": Material(2700.0, (0.02, 0.16, 0.52), "anodised", 0.30, ink="#0b62a8"),
    "aluminium_red": Material(2700.0, (0.55, 0.02, 0.03), "anodised", 0.30, ink="#a3172c"),
    "aluminium_green": Material(2700.0, (0.03, 0.30, 0.12), "anodised", 0.30, ink="#1b7a48"),
    "aluminium_violet": Material(2700.0, (0.20, 0.05, 0.45), "anodised", 0.30, ink="#6f45b8"),
    "aluminium_gold": Material(2700.0, (0.80, 0.50, 0.10), "anodised", 0.30, ink="#8a6d00"),
    "aluminium_black": Material(2700.0, (0.018, 0.018, 0.020), "satin", 0.42, ink="#33383f"),
    "steel": Material(7850.0, (0.56, 0.57, 0.58), "brushed", 0.28, ink="#545d66"),
    "brass": Material(8500.0, (0.83, 0.58, 0.22), "polished", 0.22, ink="#80640f"),
    "bronze": Material(8800.0, (0.52, 0.30, 0.14), "polished", 0.30, ink="#7a4b22"),
    "pla_white": Material(1240.0, (0.75, 0.75, 0.73), "printed", 0.45, ink="#6d7276"),
    "pla_black": Material(1240.0, (0.02, 0.02, 0.02), "printed", 0.45, ink="#33383f"),
    "pla_orange": Material(1240.0, (0.80, 0.20, 0.03), "printed", 0.45, ink="#c4500a"),
    "beech": Material(720.0, (0.42, 0.21, 0.085), "wood", 0.46, ink="#84552a"),
    "leather": Material(950.0, (0.13, 0.045, 0.018), "satin", 0.55, ink="#5f3a26"),
    "cast_iron": Material(7200.0, (0.085, 0.088, 0.092), "cast", 0.50, ink="#4a4e54"),
    "concrete": Material(2400.0, (0.42, 0.41, 0.39), "plastic", 0.85, ink="#75716a"),
    "asphalt": Material(2300.0, (0.055, 0.055, 0.057), "cast", 0.80, ink="#43464b"),
    "glass": Material(2500.0, (0.86, 0.92, 0.90), "glass", 0.06, ink="#4f7f7a"),
    "acrylic": Material(1190.0, (0.86, 0.90, 0.92), "glass", 0.06, ink="#66717b"),
    "acrylic_orange": Material(1190.0, (0.98, 0.46, 0.16), "glass", 0.06, ink="#c4500a"),
    "acrylic_blue": Material(1190.0, (0.28, 0.52, 0.92), "glass", 0.06, ink="#0b62a8"),
    "acrylic_red": Material(1190.0, (0.88, 0.22, 0.24), "glass", 0.06, ink="#a3172c"),
    "acrylic_green": Material(1190.0, (0.26, 0.74, 0.42), "glass", 0.06, ink="#1b7a48"),
    "acrylic_violet": Material(1190.0, (0.58, 0.40, 0.86), "glass", 0.06, ink="#6f45b8"),
    "acrylic_gold": Material(1190.0, (0.95, 0.76, 0.30), "glass", 0.06, ink="#8a6d00"),
    "petg_grey": Material(1270.0, (0.20, 0.21, 0.22), "printed", 0.32, ink="#50565d"),
    "plywood": Material(700.0, (0.58, 0.40, 0.22), "wood", 0.50, ink="#8f6632"),
    "paper": Material(800.0, (0.82, 0.80, 0.74), "plastic", 0.9, ink="#747062"),
    "sand": Material(1600.0, (0.52, 0.38, 0.22), "cast", 0.95, ink="#886a44"),
    "rubber": Material(1150.0, (0.02, 0.02, 0.02), "rubber", 0.8, ink="#3a3d42"),
}
