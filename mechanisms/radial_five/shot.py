"""The film: the engine stands upright, its shaft towards the camera, and one looks into its liners."""

from shared.shot import Camera, Shot

shot = Shot(look="studio", mount="stand", camera=Camera(azimuth=32, elevation=16, margin=0.05))
