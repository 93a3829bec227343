"""Workshop bench: boards of beech, a vice, a wall of pegboard with tools, the light of a lamp over the bench."""

from __future__ import annotations

from render.looks.look import Ground, Light, Look, Screen, Sky, Softbox, Wall

LAMP = Softbox(
    name="lamp", place=(-1.3, 0.5, 3.2), size=(0.9, 0.5), power=120.0, colour=(1.0, 0.90, 0.76), aim=(0.0, 0.2, -0.2)
)
WINDOW = Softbox(name="window", place=(-4.2, 0.4, 1.7), size=(1.6, 2.6), power=150.0, colour=(0.74, 0.86, 1.0))
FRONT = Softbox(
    name="front", place=(-2.0, -2.2, 3.0), size=(0.9, 0.9), power=130.0, colour=(1.0, 0.92, 0.80), spread=80.0
)
WASH = Softbox(
    name="wash", place=(0.5, 0.3, 3.2), size=(2.2, 0.3), power=26.0, colour=(1.0, 0.86, 0.68), aim=(0.3, 1.6, 0.4)
)
SIDE = Softbox(name="side", place=(2.9, -2.5, 0.9), size=(1.3, 2.4), power=60.0, colour=(0.80, 0.90, 1.0))
FILL = Softbox(name="fill", place=(2.4, -3.2, 2.0), size=(2.4, 1.6), power=40.0, colour=(1.0, 0.93, 0.84))

BENCH = Look(
    name="bench",
    dark=True,
    ground=Ground(texture="wood", colour=(0.36, 0.19, 0.085), other=(0.16, 0.070, 0.027), roughness=0.42),
    sky=Sky(zenith=(0.06, 0.06, 0.062), horizon=(0.05, 0.048, 0.046), below=(0.03, 0.028, 0.026)),
    lying=Light(softboxes=(LAMP, WINDOW, FILL), shadow=LAMP.place, bounce=0.7),
    standing=Light(softboxes=(FRONT, WASH, SIDE, FILL), shadow=FRONT.place, bounce=0.55),
    wall=Wall(kind="pegboard", colour=(0.085, 0.115, 0.118), away=1.1),
    vice=True,
    exposure=0.2,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.05, 0.028, 0.013), lamp=3.6, ambient=0.5, reflected=1.0, exposure=1.6),
)
