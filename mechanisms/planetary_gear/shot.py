"""How the planetary gear is filmed: from in front, so that all teeth in mesh are seen."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=-30.0, elevation=14.0), poster=0.1)
