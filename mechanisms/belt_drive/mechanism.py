"""A belt drive: the small pulley turns twice while the large one turns once.
The belt runs as fast as both rims; a crossed belt turns the second pulley the other way, and a chain does the same with
rollers between the teeth of sprockets.
"""

from dataclasses import dataclass
from math import pi

from mbsd import Mechanism, constant_rate

# Other belts on the same axes: make run-belt-drive-crossed, make compare-belt-drive.
VARIANTS = {
    "crossed": {"crossed": True},
    "chain": {"teeth": 16},
}


@dataclass(frozen=True)
class Params:
    """Pitch radius of the small pulley (m), ratio, distance of the axes (m), the driver's speed (rad/s).

    ``teeth`` of the small sprocket make it a chain. At this distance it is 56 pitches long.
    """

    radius: float = 0.020
    ratio: int = 2
    distance: float = 0.124048
    speed: float = 2 * pi
    crossed: bool = False
    teeth: int = 0


def build(p: Params) -> Mechanism:
    """The small pulley drives."""
    m = Mechanism("belt_drive")
    small, large = m.body("small"), m.body("large")
    m.revolute("A", m.ground.at(0, 0), small.origin)
    m.revolute("B", m.ground.at(p.distance, 0), large.origin)
    if p.teeth:
        pitch, teeth = 2 * pi * p.radius / p.teeth, (p.teeth, p.ratio * p.teeth)
        m.belt("belt", small.origin, large.origin, teeth=teeth, pitch=pitch, crossed=p.crossed)
    else:
        m.belt("belt", small.origin, large.origin, p.radius, p.ratio * p.radius, crossed=p.crossed)
    m.drive_angle("motor", small, constant_rate(p.speed))
    m.start_near(small=0, large=0)
    return m
