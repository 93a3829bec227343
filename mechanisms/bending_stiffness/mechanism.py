"""A clamped beam of links with torsion springs between them swings under a weight on its tip.
Its bending stiffness is that of a steel strip; finer links (a variant) bend ever more like the strip itself.
"""

from dataclasses import dataclass

from mbsd import Mechanism

DURATION = 3.0

VARIANTS = {
    "fine": {"links": 9},
    "soft": {"stiffness": 0.3, "force": 0.5},
}


@dataclass(frozen=True)
class Params:
    """Length (m), mass (kg) and bending stiffness E I (N m^2) of the beam, its damping, its tip force (N).

    ``damping`` is that of each torsion spring, as a part of its stiffness (s).
    """

    links: int = 6
    length: float = 0.360
    mass: float = 0.60
    stiffness: float = 0.60
    damping: float = 0.004
    force: float = 2.0
    gravity: float = 0.0


def build(p: Params) -> Mechanism:
    """Uniform rods end to end.

    Between two of them a spring of E I / h, twice that at the clamp (Hencky's chain).
    """
    m = Mechanism("bending_stiffness", gravity=(0.0, -p.gravity))
    part = p.length / p.links
    before, place = m.ground, m.ground.origin
    for k in range(1, p.links + 1):
        link = m.bar(f"link{k}", part, p.mass / p.links)
        m.revolute(f"pin{k}", place, link.start)
        stiffness = (2.0 if k == 1 else 1.0) * p.stiffness / part
        m.torsion_spring(f"spring{k}", before, link, stiffness, damping=p.damping * stiffness)
        m.start_near(**{link.name: 0.0})
        before, place = link, link.end
    m.force("load", place, p.force, (0.0, -1.0))
    m.trace("tip", place)
    return m
