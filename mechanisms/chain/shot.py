"""How the chain is filmed: with a short and thin trail, so that the links are seen and not buried."""

from shared.shot import Shot, Trail

shot = Shot(trails=(Trail(point="tip", tail=0.22, radius=0.003),), poster=0.16)
