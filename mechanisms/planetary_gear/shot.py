"""How the planetary gear is filmed: from high up, so that all teeth in mesh are seen."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=-14.0, elevation=58.0), poster=0.1)
