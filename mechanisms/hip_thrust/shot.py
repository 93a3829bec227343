"""How the lift is filmed: from the side."""

from shared.shot import Camera, Shot, Trail

shot = Shot(
    camera=Camera(azimuth=0.0, elevation=83.0, margin=0.06),
    trails=(Trail(point="bar"),),
    turns=2,
    seconds_per_turn=3.5,
    poster=0.12,
)
