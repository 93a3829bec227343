"""The film: the shaft stands upright, the liners are cut open towards the camera."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=40, elevation=28))
