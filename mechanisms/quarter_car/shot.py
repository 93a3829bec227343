"""How the quarter car is filmed: its poster is on the bump."""

from shared.shot import Shot

shot = Shot(poster=0.33)
