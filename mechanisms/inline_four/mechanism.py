"""An inline four, the engine of most cars: the outer pistons rise while the inner ones fall.
The first order cancels, force and couple; the second adds up, because the rods lean four times a turn, and shakes the
car twice a turn. The cross-plane crank has no second order and pays with a rocking couple. It fires 1-3-4-2.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.engine import engine

VARIANTS = {"cross_plane": {"throws": (0, 90, 270, 180), "order": (1, 3, 2, 4)}}
SPECTRA = ("shaking force", "shaking couple", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), directions of the throws (degrees), speed (rad/s: 1500 turns a minute)."""

    bore: float = 0.080
    stroke: float = 0.080
    rod: float = 0.145
    spacing: float = 0.100
    throws: tuple[float, ...] = (0, 180, 180, 0)
    order: tuple[int, ...] = (1, 3, 4, 2)
    compression: float = 10.0
    heat: float = 1.2e6  # of a charge, by the displaced volume (J/m^3)
    speed: float = 50 * pi


def build(p: Params) -> Mechanism:
    """Masses are those of the parts; their counterweights are webs."""
    return engine(
        "I4", name="inline_four",
        bore=p.bore, stroke=p.stroke, rod=p.rod, spacing=p.spacing, throws=p.throws,
        gas=four_stroke(p.compression, heat_density=p.heat), order=p.order, speed=p.speed,
    )  # fmt: skip
