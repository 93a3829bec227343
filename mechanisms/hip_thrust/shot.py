"""How the lift is filmed: from the side."""

from shared.shot import Camera, Shot, Sound, Trail

shot = Shot(
    look="daylight",
    mount="ground",
    camera=Camera(azimuth=-30.0, elevation=8.0, margin=0.06),
    trails=(Trail(point="bar"),),
    turns=2,
    seconds_per_turn=3.5,
    poster=0.12,
    sound=Sound(without=("motors", "friction", "knocks")),  # muscles are no motors, and bones do not rattle
)
