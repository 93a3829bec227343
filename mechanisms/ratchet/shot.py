"""How the ratchet is filmed: from a little to the left, where plate and stand are in the picture whole."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=-12.0))
