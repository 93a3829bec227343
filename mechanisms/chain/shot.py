"""How the chain is filmed: from higher up, with a short and thin trail, so that the links are seen and not buried."""

from shared.shot import Camera, Shot, Trail

shot = Shot(
    camera=Camera(azimuth=-10.0, elevation=52.0),
    trails=(Trail(point="tip", tail=0.22, radius=0.003),),
    poster=0.16,
)
