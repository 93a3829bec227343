"""How the quarter car is filmed: from high up, so that the road hides no tyre; its poster is on the bump."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=-10.0, elevation=60.0), poster=0.33)
