"""How Peaucellier's linkage is filmed: from high up, so that the rhombus reads."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=-12.0, elevation=62.0), poster=0.06)
