"""How the leg is filmed: from above, so that it is seen from its side."""

from shared.shot import Camera, Shot, Trail

shot = Shot(
    camera=Camera(azimuth=-8.0, elevation=62.0),
    trails=(Trail(point="calf"),),
    poster=0.25,
)
