"""How the Geneva drive is filmed: its poster has the pin in a slot."""

from shared.shot import Shot

shot = Shot(poster=0.11)
"""A turn is a quarter of the period: half of it leads the pin from the far side into the middle of a slot."""
