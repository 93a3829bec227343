"""A radial engine of five cylinders, the engine of early aeroplanes: all pistons work on one throw.
One rod, the master rod, is on the crank pin and carries the others on knuckle pins round its big end. Pistons that do
not hang from the master rod's axis go a little further, and their dead centres lag or lead. It fires 1-3-5-2-4, every
other cylinder of the ring, which goes round evenly because their number is odd.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.master_rod import MasterRod

SPECTRA = ("shaking force", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), speed (rad/s: 1500 turns a minute)."""

    bore: float = 0.080
    stroke: float = 0.080
    rod: float = 0.165
    knuckles: float = 0.046  # from the crank pin
    compression: float = 6.5
    heat: float = 1.2e6  # of a charge, by the displaced volume (J/m^3)
    speed: float = 50 * pi


def build(p: Params) -> Mechanism:
    """Masses are those of the parts; their counterweights are webs."""
    return engine(
        "radial-5", name="radial_five",
        bore=p.bore, stroke=p.stroke, rod=p.rod, rods=MasterRod(p.knuckles),
        gas=four_stroke(p.compression, heat_density=p.heat), order=(1, 3, 5, 2, 4), speed=p.speed,
    )  # fmt: skip
