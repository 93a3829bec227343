"""How the double pendulum is filmed: a shorter trail, so that the path does not bury the rods."""

from shared.shot import Shot, Trail

shot = Shot(look="studio", trails=(Trail(point="P", tail=0.3),))
