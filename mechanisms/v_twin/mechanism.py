"""A V-twin with both rods on one pin: at 90 degrees its counterweights take all of the first order.
At 45 degrees they cannot, and it fires after 405 and 315 degrees, which is how it sounds.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.engine import engine

VARIANTS = {"bank_45": {"angle": 45.0, "rod": 0.190}}
SPECTRA = ("shaking force", "shaking couple", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), angle between the banks (degrees), speed (rad/s: 1500 turns a minute)."""

    bore: float = 0.080
    stroke: float = 0.080
    rod: float = 0.150
    bank_offset: float = 0.023  # of the two rods on the pin
    angle: float = 90.0
    compression: float = 10.0
    heat: float = 1.2e6  # of a charge, by the displaced volume (J/m^3)
    speed: float = 50 * pi


def build(p: Params) -> Mechanism:
    """Masses are those of the parts; their counterweights are webs."""
    return engine(
        "V2", name="v_twin",
        bore=p.bore, stroke=p.stroke, rod=p.rod, bank_offset=p.bank_offset, angle=p.angle,
        gas=four_stroke(p.compression, heat_density=p.heat), speed=p.speed,
    )  # fmt: skip
