"""How the four-bar is filmed."""

from shared.shot import Camera, Shot, Trail

shot = Shot(
    camera=Camera(azimuth=-18.0, elevation=35.0, lens=55.0),
    turns=3,
    seconds_per_turn=4.0,
    fps=30,
    trails=(Trail(point="P"),),
    poster=0.3,
)
