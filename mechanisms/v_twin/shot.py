"""The film: the engine stands upright, its shaft level, and one looks into its liners."""

from shared.shot import Camera, Shot

shot = Shot(look="studio", mount="stand", camera=Camera(azimuth=35, elevation=12))
