"""A double pendulum: two rods, one hung on the other, moved by their weight alone.
Its path never repeats, and a start that differs by a tenth of a degree (a variant) leads elsewhere within seconds,
though each keeps its energy.
"""

from dataclasses import dataclass

from mbsd import Mechanism

DURATION = 6.0

VARIANTS = {
    "beside": {"start": (30.1, 60.0)},
    "small": {"start": (-85.0, -85.0)},
}


@dataclass(frozen=True)
class Params:
    """Lengths (m) and masses (kg) of uniform rods, start (degrees; -90 hangs), weight (m/s^2)."""

    lengths: tuple[float, float] = (0.160, 0.130)
    masses: tuple[float, float] = (0.60, 0.40)
    start: tuple[float, float] = (30.0, 60.0)
    gravity: float = 9.81


def build(p: Params) -> Mechanism:
    """The upper rod hangs on ground, the lower one on its end."""
    m = Mechanism("double_pendulum", gravity=(0.0, -p.gravity))
    upper = m.bar("upper", p.lengths[0], mass=p.masses[0])
    lower = m.bar("lower", p.lengths[1], mass=p.masses[1])
    m.revolute("A", m.ground.at(0, 0), upper.start)
    m.revolute("B", upper.end, lower.start)
    m.trace("P", lower.end)
    m.start_near(upper=p.start[0], lower=p.start[1])
    return m
