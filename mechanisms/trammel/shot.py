"""How the trammel is filmed: from high up, so that grooves and ellipse read.

The rod is coloured, as what is turned.
"""

from shared.shot import Camera, Shot

shot = Shot(
    look="blueprint", camera=Camera(azimuth=-12.0, elevation=58.0), materials={"rod": "aluminium_orange"}, poster=0.09
)
