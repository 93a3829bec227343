"""A flat four, the boxer: opposite pistons move out and in together, each on a pin of its own.
All forces cancel; as opposite cylinders are not in one plane, a couple of the second order is left. It fires 1-3-2-4.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.engine import engine

SPECTRA = ("shaking force", "shaking couple", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), directions of the throws (degrees), speed (rad/s: 1500 turns a minute)."""

    bore: float = 0.090
    stroke: float = 0.075
    rod: float = 0.140
    spacing: float = 0.062
    throws: tuple[float, ...] = (0, 180, 180, 0)
    order: tuple[int, ...] = (1, 3, 2, 4)
    compression: float = 10.0
    heat: float = 1.2e6  # of a charge, by the displaced volume (J/m^3)
    speed: float = 50 * pi


def build(p: Params) -> Mechanism:
    """Masses are those of the parts; their counterweights are webs."""
    return engine(
        "flat-4", name="flat_four",
        bore=p.bore, stroke=p.stroke, rod=p.rod, spacing=p.spacing, throws=p.throws,
        gas=four_stroke(p.compression, heat_density=p.heat), order=p.order, speed=p.speed,
    )  # fmt: skip
