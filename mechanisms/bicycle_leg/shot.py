"""How leg and muscles are filmed: from the side.

The poster shows the muscles that stretch the knee at work.
"""

from shared.shot import Camera, Shot, Sound, Surface, Trail

MUSCLES = ("hip_extensors", "hip_flexors", "knee_extensors", "knee_flexors")

shot = Shot(
    sound=Sound(silent=(*MUSCLES, "knee", "hip")),
    camera=Camera(azimuth=-8.0),
    trails=(Trail(point="calf"),),
    materials={"ground/base_plate": Surface(colour=(0.62, 0.64, 0.64), finish="satin")},
    poster=0.12,
)
