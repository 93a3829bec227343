"""The twelve lines of the loop: what is shown is what is run, with the number as it is at the moment."""

from __future__ import annotations

from typing import Any

LINES = """\
m = Mechanism("four_bar")
crank = m.bar("crank", {crank:.3f})
coupler = m.bar("coupler", 0.120)
rocker = m.bar("rocker", 0.090)
m.revolute("A", m.ground.at(0, 0), crank.start)
m.revolute("B", crank.end, coupler.start)
m.revolute("C", coupler.end, rocker.end)
m.revolute("D", m.ground.at(0.120, 0), rocker.start)
m.drive_angle("motor", crank, constant_rate(2 * pi))
m.trace("P", coupler.at(0.060, 0.030))
m.start_near(crank=0, coupler=45, rocker=100)
sol = m.sweep()"""
CHANGED = "{crank:.3f}"
"""Where the number stands that changes (m)."""
CRANK = 0.040
"""What it is in mechanisms/four_bar (m)."""


def run(crank: float) -> dict[str, Any]:
    """What the lines leave behind: the mechanism ``m`` and its motion ``sol``."""
    import mbsd

    variables: dict[str, Any] = {
        "Mechanism": mbsd.Mechanism,
        "constant_rate": mbsd.constant_rate,
        "pi": 3.141592653589793,
    }
    exec(LINES.format(crank=round(crank, 3)), variables)
    return variables
