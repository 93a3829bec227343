"""How the inverted slider-crank is filmed: as a drawing."""

from shared.shot import Shot

shot = Shot(look="blueprint")
