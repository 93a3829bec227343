"""A chain that hangs on one pin is flung up: all links start at one rate, then each turns its own way.
The variants have three, ten and a hundred links; the hundred are released from nearly level and swing like a rope.
"""

from dataclasses import dataclass

from mbsd import Mechanism

DURATION = 4.0

VARIANTS = {
    "three": {"links": 3},
    "ten": {"links": 10, "rate": 6.0},
    "hundred": {"links": 100, "length": 0.03, "mass": 0.02, "rate": 0.0, "lean": 75.0, "damping": 0.002},
}


@dataclass(frozen=True)
class Params:
    """Number, length (m) and mass (kg) of the links, drag (N s/m) at each lower end, start and its rate.

    The chain starts straight, ``lean`` degrees from where it hangs, all links turning at ``rate`` (rad/s).
    """

    links: int = 6
    length: float = 0.10
    mass: float = 0.10
    damping: float = 0.12
    lean: float = 0.0
    rate: float = 12.5
    gravity: float = 9.81


def build(p: Params) -> Mechanism:
    """The mass of a link is at its lower end, where the next one hangs; hanging it is at -90 degrees."""
    m = Mechanism("chain", gravity=(0.0, -p.gravity))
    above = m.ground.origin
    for k in range(1, p.links + 1):
        link = m.bar(f"link{k}", p.length, p.mass, com=(p.length, 0), inertia=0.0)
        m.revolute(f"pin{k}", above, link.start)
        if p.damping:
            m.bushing(f"air{k}", m.ground.origin, link.end, (0, 0, 0), damping=(p.damping, p.damping, 0))
        m.start_near(**{link.name: p.lean - 90.0})
        m.start_moving(**{link.name: p.rate})
        above = link.end
    m.trace("tip", above)
    return m
