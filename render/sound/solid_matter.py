"""How materials ring: Young's modulus, density and loss factor by the names of shared/contract/materials.py.

Handbook values; the loss factor is that of a part in a machine, whose joints take more than the material does. Sources:
Cremer, Heckl, Petersson, Structure-Borne Sound, 2005; Ashby, Materials Selection in Mechanical Design, 2011.
"""

from __future__ import annotations

from dataclasses import dataclass

from shared.contract.materials import MATERIALS


@dataclass(frozen=True)
class Matter:
    """What a part rings by."""

    modulus: float
    """Young's modulus (Pa)."""
    density: float
    """kg/m^3"""
    loss: float
    """Loss factor: the part of the energy that goes in a radian."""


_FAMILIES = {
    "aluminium": (70e9, 0.008),
    "steel": (205e9, 0.006),
    "brass": (100e9, 0.006),
    "bronze": (105e9, 0.007),
    "cast_iron": (110e9, 0.012),
    "pla": (3.3e9, 0.03),
    "petg": (2.0e9, 0.04),
    "beech": (12e9, 0.025),
    "plywood": (8e9, 0.03),
    "leather": (0.2e9, 0.2),
    "concrete": (28e9, 0.02),
    "asphalt": (5e9, 0.2),
    "glass": (65e9, 0.004),
    "paper": (3e9, 0.1),
    "sand": (0.1e9, 0.4),
    "rubber": (0.02e9, 0.25),
}
"""Modulus and loss factor of a family; its materials begin with the word."""
OTHER = (70e9, 0.01)


def matter(material: str) -> Matter:
    """How a material rings; one that is in no family rings as aluminium does, with its own density where it has one."""
    modulus, loss = next((numbers for word, numbers in _FAMILIES.items() if material.startswith(word)), OTHER)
    known = MATERIALS.get(material)
    return Matter(modulus, known.density if known else 2700.0, loss)
