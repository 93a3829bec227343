"""How the cam is filmed: from high up, so that one sees the valve over its seat."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(elevation=62.0))
