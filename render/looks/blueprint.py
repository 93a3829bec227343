"""Blueprint: the machine drawn in pale lines on blue paper."""

from __future__ import annotations

from render.looks.look import Drawing, Ground, Look, Screen, Sky

PAPER = (0.012, 0.075, 0.24)

BLUEPRINT = Look(
    name="blueprint",
    dark=True,
    ground=Ground(texture="paint", colour=PAPER, roughness=1.0),
    sky=Sky(zenith=(0.5, 0.5, 0.5), horizon=(0.5, 0.5, 0.5), below=(0.5, 0.5, 0.5)),
    drawing=Drawing(paper=(0.075, 0.245, 0.50), grid=(0.20, 0.38, 0.63), line=(0.90, 0.95, 1.0), tone=0.16),
    screen=Screen(edge=PAPER),
)
