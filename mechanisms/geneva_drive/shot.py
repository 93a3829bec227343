"""How the Geneva drive is filmed: from high up, so that slots and roller read; its poster has the pin in a slot."""

from shared.shot import Camera, Shot

shot = Shot(camera=Camera(azimuth=-14.0, elevation=50.0), poster=0.11)
"""A turn is a quarter of the period: half of it leads the pin from the far side into the middle of a slot."""
