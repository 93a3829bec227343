"""Dark studio: a slate sweep without a horizon, one large softbox above and behind, a cool and a warm rim light."""

from __future__ import annotations

from render.looks.look import Ground, Light, Look, Screen, Sky, Softbox, Wall

OVERHEAD = Softbox(
    name="overhead",
    place=(-0.3, 3.4, 2.5),
    size=(5.0, 2.0),
    power=68.0,
    colour=(1.0, 0.985, 0.96),
    aim=(0.0, 0.3, 0.0),
    fades=True,
)
POOL = Softbox(
    name="pool",
    place=(1.3, -0.3, 4.2),
    size=(0.6, 0.6),
    power=70.0,
    colour=(1.0, 0.97, 0.94),
    aim=(0.15, 0.4, -0.3),
    spread=48.0,
)
COOL = Softbox(name="rim cool", place=(-3.2, 1.4, 0.9), size=(0.6, 2.8), power=105.0, colour=(0.42, 0.68, 1.0))
WARM = Softbox(name="rim warm", place=(3.2, 0.9, 0.8), size=(0.6, 2.8), power=90.0, colour=(1.0, 0.58, 0.28))
FILL = Softbox(name="fill", place=(-1.2, -3.8, 1.6), size=(3.4, 1.6), power=42.0, colour=(0.84, 0.91, 1.0))
KEY = Softbox(name="key", place=(-2.3, -2.6, 2.9), size=(1.5, 1.5), power=300.0, colour=(1.0, 0.97, 0.93), spread=110.0)
FACE = Softbox(
    name="face", place=(2.7, -2.7, 0.5), size=(1.2, 2.2), power=42.0, colour=(1.0, 0.985, 0.96), aim=(0.0, 0.0, 0.1)
)
"""Where plates that face the camera mirror it, from a camera that stands to the left of them."""
GLOW = Softbox(
    name="glow",
    place=(0.5, 2.6, 2.6),
    size=(1.0, 0.6),
    power=760.0,
    colour=(0.72, 0.84, 1.0),
    aim=(0.3, 6.6, 0.2),
    spread=120.0,
)

STUDIO = Look(
    name="studio",
    dark=True,
    ground=Ground(texture="paint", colour=(0.016, 0.019, 0.026), roughness=0.34),
    sky=Sky(zenith=(0.016, 0.018, 0.024), horizon=(0.016, 0.018, 0.024), below=(0.016, 0.018, 0.024)),
    lying=Light(softboxes=(OVERHEAD, POOL, COOL, WARM, FILL)),
    standing=Light(softboxes=(KEY, FACE, GLOW, COOL, WARM), shadow=(-1.6, -1.6, 3.4)),
    wall=Wall(kind="sweep", colour=(0.016, 0.019, 0.026), away=5.0),
    exposure=0.1,
    contrast="AgX - High Contrast",
    screen=Screen(edge=(0.0035, 0.0045, 0.007), lamp=3.0, reflected=0.7, exposure=1.15),
    other="cyclorama",
)
