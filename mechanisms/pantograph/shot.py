"""How the pantograph is filmed: the copy is drawn on the paper in ink; its poster shows most of it."""

from shared.shot import Shot, Trail

shot = Shot(look="bench", trails=(Trail(point="copy", z=0.0014, ink=True),), poster=0.28)
