"""How the leg is filmed: from its side; its poster shows the crank going down."""

from shared.shot import Camera, Shot, Sound, Surface, Trail

shot = Shot(
    camera=Camera(azimuth=-8.0),
    trails=(Trail(point="calf"),),
    materials={"ground/base_plate": Surface(colour=(0.62, 0.64, 0.64), finish="satin")},
    sound=Sound(silent=("rider", "knee", "hip")),  # muscles are no motors
    poster=0.25,
)
