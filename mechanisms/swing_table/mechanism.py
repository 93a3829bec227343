"""A table on two equal swings: they are a parallelogram, so it stays level however far it swings.
Table and swings move as one pendulum of the swings' length.
"""

from dataclasses import dataclass

from mbsd import Mechanism

DURATION = 4.0

VARIANTS = {"undamped": {"damping": 0.0, "start": 30.0}}


@dataclass(frozen=True)
class Params:
    """Lengths of swings and table (m), mass at each end of the table (kg), drag there (N s/m), start."""

    swing: float = 0.16
    table: float = 0.24
    mass: float = 0.20
    damping: float = 0.04
    start: float = 60.0  # degrees from where it hangs
    gravity: float = 9.81


def build(p: Params) -> Mechanism:
    """A mass is at the lower end of each swing and at the right end of the table.

    The swings hang at -90 degrees.
    """
    m = Mechanism("swing_table", gravity=(0.0, -p.gravity))
    left, right, table = (
        m.bar(name, length, p.mass, com=(length, 0), inertia=0.0)
        for name, length in (("left", p.swing), ("right", p.swing), ("table", p.table))
    )
    m.revolute("A", m.ground.origin, left.start)
    m.revolute("B", m.ground.at(p.table, 0), right.start)
    m.revolute("C", left.end, table.start)
    m.revolute("D", right.end, table.end)
    for body in (left, right, table) if p.damping else ():
        m.bushing(f"air_{body.name}", m.ground.origin, body.end, (0, 0, 0), damping=(p.damping, p.damping, 0))
    m.start_near(left=p.start - 90, right=p.start - 90, table=0)
    m.trace("middle", table.at(p.table / 2, 0))
    return m
