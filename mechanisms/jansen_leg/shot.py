"""How the leg is filmed: from high up, so that leg and step read."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=-10.0, elevation=62.0), poster=0.55)
