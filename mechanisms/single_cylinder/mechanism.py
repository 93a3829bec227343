"""A four-stroke single cylinder: it pushes once in two turns, a flywheel carries it through the rest.
A counterweight that takes half of the piston leaves a force of constant size that turns against the shaft.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, four_stroke
from mbsd.machines.engines.engine import engine
from mbsd.machines.engines.valve_train import ValveTrain

VARIANTS = {"overhead_camshaft": {"valves": True}}
SPECTRA = ("shaking force", "motor")


@dataclass(frozen=True)
class Params:
    """Lengths (m), speed (rad/s: 1500 turns a minute)."""

    bore: float = 0.080
    stroke: float = 0.080
    rod: float = 0.145
    compression: float = 10.0
    heat: float = 1.2e6  # of a charge, by the displaced volume (J/m^3)
    speed: float = 50 * pi
    valves: bool = False  # with a camshaft over the head, which a belt turns at half speed


def build(p: Params) -> Mechanism:
    """Masses are those of the parts; their counterweights are webs."""
    return engine(
        "I1", name="single_cylinder",
        bore=p.bore, stroke=p.stroke, rod=p.rod,
        gas=four_stroke(p.compression, heat_density=p.heat), speed=p.speed,
        valves=ValveTrain() if p.valves else None,
    )  # fmt: skip
