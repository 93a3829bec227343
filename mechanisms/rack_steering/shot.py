"""How the steering is filmed: from behind and above, as the driver of a model car sees it."""

from shared.shot import Camera, Shot, Sound

shot = Shot(look="road", camera=Camera(azimuth=-14.0, elevation=48.0), poster=0.2, sound=Sound(silent=("wheel",)))
