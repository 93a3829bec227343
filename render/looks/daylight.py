"""Daylight: a pale floor beside a window; the sun draws its bars and a firm shadow, the sky fills."""

from __future__ import annotations

from render.looks.look import Ground, Light, Look, Screen, Sky, Softbox, Sun, Wall

BOUNCE = Softbox(name="bounce", place=(3.4, 0.8, 1.4), size=(0.8, 2.6), power=26.0, colour=(1.0, 0.92, 0.82))
SKY = Softbox(
    name="sky", place=(-1.0, 3.0, 3.0), size=(3.6, 1.8), power=44.0, colour=(0.82, 0.91, 1.0), aim=(0.0, 0.3, 0.0)
)

DAYLIGHT = Look(
    name="daylight",
    dark=False,
    ground=Ground(texture="concrete", colour=(0.60, 0.585, 0.56), other=(0.53, 0.515, 0.495), roughness=0.6),
    sky=Sky(zenith=(0.26, 0.32, 0.42), horizon=(0.30, 0.33, 0.37), below=(0.28, 0.27, 0.25)),
    lying=Light(
        softboxes=(SKY, BOUNCE),
        sun=Sun(place=(-2.2, 0.55, 2.3), power=4.2, colour=(1.0, 0.91, 0.78), angle=1.6, window=True),
    ),
    standing=Light(
        softboxes=(SKY, BOUNCE),
        sun=Sun(place=(-1.9, -1.7, 1.9), power=4.2, colour=(1.0, 0.91, 0.78), angle=1.6, window=True),
    ),
    wall=Wall(kind="sweep", colour=(0.62, 0.60, 0.57), away=5.0),
    exposure=0.45,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.66, 0.65, 0.63), lamp=3.4, ambient=0.2, exposure=1.05),
    other="studio",
)
