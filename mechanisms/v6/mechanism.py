"""A 60 degree V6 with a pin for each rod: pins of a throw are 60 degrees apart, it fires every 120.
No force of the first or second order is left, but a couple that rocks the block.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.engine import engine

SPECTRA = ("shaking force", "shaking couple", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), directions (degrees), speed (rad/s: 1500 turns a minute)."""

    bore: float = 0.080
    stroke: float = 0.080
    rod: float = 0.155
    spacing: float = 0.110
    bank_offset: float = 0.032  # of the two rods of a throw, with a web between their pins
    angle: float = 60.0
    throws: tuple[float, ...] = (0, 120, 240)
    compression: float = 10.0
    heat: float = 1.2e6  # of a charge, by the displaced volume (J/m^3)
    speed: float = 50 * pi


def build(p: Params) -> Mechanism:
    """Masses are those of the parts; their counterweights are webs."""
    return engine(
        "V6", name="v6",
        bore=p.bore, stroke=p.stroke, rod=p.rod, spacing=p.spacing, bank_offset=p.bank_offset,
        angle=p.angle, throws=p.throws, gas=four_stroke(p.compression, heat_density=p.heat), speed=p.speed,
    )  # fmt: skip
