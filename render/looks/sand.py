"""Sand: ripples of a beach under a low warm sun, haze at the horizon."""

from __future__ import annotations

from render.looks.look import Ground, Light, Look, Screen, Sky, Softbox, Sun

SKY = Softbox(
    name="sky", place=(0.4, 2.8, 3.0), size=(4.0, 2.0), power=34.0, colour=(0.74, 0.86, 1.0), aim=(0.0, 0.2, 0.0)
)
WARM = (1.0, 0.85, 0.64)

SAND = Look(
    name="sand",
    dark=False,
    ground=Ground(texture="sand", colour=(0.60, 0.43, 0.26), other=(0.40, 0.27, 0.15), roughness=0.9),
    sky=Sky(zenith=(0.22, 0.38, 0.66), horizon=(0.80, 0.76, 0.70), below=(0.30, 0.24, 0.17)),
    lying=Light(softboxes=(SKY,), sun=Sun(place=(-2.4, 0.5, 1.5), power=4.4, colour=WARM, angle=1.0)),
    standing=Light(softboxes=(SKY,), sun=Sun(place=(-2.2, -1.3, 1.5), power=4.4, colour=WARM, angle=1.0)),
    exposure=0.2,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.80, 0.76, 0.70), lamp=4.0, ambient=0.2, exposure=1.1),
)
