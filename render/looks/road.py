"""Road: asphalt with its marks under an open sky, haze at the horizon, a low sun from the side."""

from __future__ import annotations

from render.looks.look import Ground, Light, Look, Screen, Sky, Softbox, Sun

SKY = Softbox(
    name="sky", place=(0.0, 2.8, 3.2), size=(4.0, 2.0), power=40.0, colour=(0.88, 0.94, 1.0), aim=(0.0, 0.2, 0.0)
)
SUN = Sun(place=(-2.0, -1.4, 1.9), power=4.6, colour=(1.0, 0.90, 0.76), angle=0.9)

ROAD = Look(
    name="road",
    dark=False,
    ground=Ground(
        texture="asphalt",
        colour=(0.125, 0.122, 0.118),
        other=(0.060, 0.058, 0.057),
        roughness=0.72,
        lines=(0.75, 0.75, 0.75),
    ),
    sky=Sky(zenith=(0.22, 0.34, 0.55), horizon=(0.66, 0.72, 0.80), below=(0.12, 0.12, 0.12)),
    lying=Light(softboxes=(SKY,), sun=SUN),
    standing=Light(softboxes=(SKY,), sun=SUN),
    exposure=0.25,
    contrast="AgX - Medium High Contrast",
    screen=Screen(edge=(0.66, 0.72, 0.80), lamp=4.4, ambient=0.3, exposure=1.6),
)
