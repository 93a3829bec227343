"""The V8 with a cross crank: two rods on a pin and 90 degrees between the banks.
Nothing is left that turns against the shaft, so counterweights balance it; at other angles a couple is left that they
cannot take, and the flat crank shakes twice a turn: `mbsd compare v8` shows all of them beside each other.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.engine import engine

VARIANTS = {
    "bank_60": {"angle": 60.0, "rod": 0.165},
    "bank_72": {"angle": 72.0},
    "bank_120": {"angle": 120.0},
    "flat_plane": {"throws": (0, 180, 180, 0)},
}
SPECTRA = ("shaking force", "shaking couple", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), directions (degrees), speed (rad/s: 1500 turns a minute)."""

    bore: float = 0.080
    stroke: float = 0.080
    rod: float = 0.150
    spacing: float = 0.100
    bank_offset: float = 0.023  # of the two rods on a pin
    angle: float = 90.0
    throws: tuple[float, ...] = (0, 90, 270, 180)
    compression: float = 10.0
    heat: float = 1.2e6  # of a charge, by the displaced volume (J/m^3)
    speed: float = 50 * pi


def build(p: Params) -> Mechanism:
    """Masses are those of the parts; their counterweights are webs."""
    return engine(
        "V8", name="v8",
        bore=p.bore, stroke=p.stroke, rod=p.rod, spacing=p.spacing, bank_offset=p.bank_offset,
        angle=p.angle, throws=p.throws, gas=four_stroke(p.compression, heat_density=p.heat), speed=p.speed,
    )  # fmt: skip
