"""White cyclorama: a cove that runs out into white, a large key from the left, a shadow that holds the machine down."""

from __future__ import annotations

from render.looks.look import Ground, Light, Look, Screen, Sky, Softbox, Wall

KEY = Softbox(
    name="key", place=(-2.4, -0.9, 3.2), size=(1.3, 1.3), power=120.0, colour=(1.0, 0.975, 0.94), aim=(0.0, 0.0, -0.1)
)
FRONT = Softbox(
    name="front", place=(-2.5, -2.6, 2.8), size=(1.2, 1.2), power=150.0, colour=(1.0, 0.975, 0.94), aim=(0.0, 0.0, -0.1)
)
BACK = Softbox(
    name="back", place=(0.3, 3.0, 3.2), size=(5.0, 1.8), power=70.0, colour=(0.97, 0.985, 1.0), aim=(0.0, 0.6, 0.0)
)
RIM = Softbox(name="rim", place=(3.2, 1.2, 1.3), size=(0.6, 2.6), power=36.0, colour=(0.90, 0.95, 1.0))
COVE = Softbox(
    name="cove", place=(0.0, 1.6, 4.4), size=(9.0, 1.6), power=240.0, colour=(1.0, 1.0, 1.0), aim=(0.0, 7.0, 2.0)
)

CYCLORAMA = Look(
    name="cyclorama",
    dark=False,
    ground=Ground(texture="paint", colour=(0.70, 0.70, 0.70), roughness=0.6),
    sky=Sky(zenith=(0.34, 0.35, 0.36), horizon=(0.34, 0.35, 0.36), below=(0.34, 0.35, 0.36)),
    lying=Light(softboxes=(KEY, BACK, RIM), shadow=KEY.place),
    standing=Light(softboxes=(FRONT, COVE, RIM), shadow=FRONT.place),
    wall=Wall(kind="sweep", colour=(0.70, 0.70, 0.70), away=5.0),
    exposure=0.45,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.80, 0.80, 0.80), lamp=2.4, ambient=0.25, exposure=1.0),
    other="studio",
)
